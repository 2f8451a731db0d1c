//! Cost of ray traversal: build times, and ray rates on the CPU (with `obvhs` for comparison) and on the GPU, from 2.6
//! thousand to 2.6 million triangles.
//!
//! `cargo research traversal`; optionally followed by triangle counts.
//!
//! Makes rows of the table "Path tracer" of `docs/performance.md`.

mod rays;

use afterimage_lab::clock::Stopwatch;
use afterimage_lab::device::Headless;
use afterimage_lab::rays::{Bvh, Geometry, Ray};
use afterimage_lab::scene::Triangles;
use afterimage_trace::gpu::ray_lists::{GpuRays, HitQuery};
use afterimage_trace::gpu::scene_buffer::{GpuSceneBuffer, Storage};
use afterimage_trace::scene_buffer::{SceneBuffer, SceneBufferBuilder};
use clap::Args;
use glam::{Vec3, vec3};
use obvhs::BvhBuildParams;
use rays::{Obvhs, bounce_rays, closest, cpu_ms, occluded, primary_rays};
use std::f32::consts::TAU;
use std::sync::Arc;

const SIZE: [u32; 2] = [640, 360];

/// A grid of `n` by `m` quadrilaterals over the surface `at`, whose parameters range from 0 to 1.
fn surface(triangles: &mut Triangles, n: usize, m: usize, at: impl Fn(f32, f32) -> Vec3) {
    let at = |i: usize, j: usize| at(i as f32 / n as f32, j as f32 / m as f32);
    for i in 0..n {
        for j in 0..m {
            triangles.push_quad([at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)], 0);
        }
    }
}

/// A paved yard of 20 m with rough stone walls and 24 columns.
fn courtyard(count: usize) -> Triangles {
    let mut triangles = Triangles::default();
    let rough = |x: f32, y: f32| 0.03 * ((37.0 * x).sin() * (41.0 * y).cos() + (113.0 * x + 71.0 * y).sin());
    let side = (count as f32 * 0.2 / 2.0).sqrt() as usize;
    surface(&mut triangles, side, side, |u, v| vec3(20.0 * u - 10.0, rough(u, v), 10.0 - 20.0 * v));
    let side = (count as f32 * 0.08 / 2.0).sqrt() as usize;
    for wall in 0..4 {
        let (sin, cos) = (wall as f32 * TAU / 4.0).sin_cos();
        let at = |x: f32, y: f32, z: f32| vec3(x * cos - z * sin, y, x * sin + z * cos);
        surface(&mut triangles, side, side, |u, v| at(20.0 * u - 10.0, 8.0 * v, -10.0 + rough(v, u)));
    }
    let side = (count as f32 * 0.48 / 24.0 / 2.0).sqrt() as usize;
    for column in 0..24 {
        let (sin, cos) = (column as f32 * TAU / 24.0).sin_cos();
        surface(&mut triangles, side, side, |u, v| {
            let radius = 0.35 + 0.05 * (TAU * 2.0 * v).cos() + 0.02 * (TAU * 12.0 * u).cos();
            let (s, c) = (-u * TAU).sin_cos();
            vec3(7.0 * cos + radius * c, 6.0 * v, 7.0 * sin + radius * s)
        });
    }
    triangles
}

/// Million rays per second: of CPU time on software devices, otherwise of wall time.
fn gpu_mrays(
    gpu: &Arc<Headless>,
    scene_buffer: &SceneBuffer,
    geometry: &Geometry,
    storage: Storage,
    query: HitQuery,
    rays: &[Ray],
) -> f64 {
    let tracer = GpuRays::new(gpu, scene_buffer, geometry, storage, query, None);
    let batch = tracer.batch(&GpuSceneBuffer::new(&gpu.device, &gpu.queue, scene_buffer, storage), rays);
    tracer.run(&batch);
    let run = |_| {
        let watch = Stopwatch::start();
        tracer.run(&batch);
        if gpu.is_software() { watch.cpu_ms().unwrap_or(watch.wall_ms()) } else { watch.wall_ms() }
    };
    let ms = (0..5).map(run).fold(f64::INFINITY, f64::min);
    rays.len() as f64 / ms * 1e-3
}

/// Cost of ray traversal: build times, and ray rates on the CPU and on a device
#[derive(Args, Clone, Debug)]
pub struct TraversalArgs {
    /// Numbers of triangles
    #[arg(default_values_t = [2_600, 26_000, 262_000, 2_600_000])]
    pub triangles: Vec<usize>,
}

pub fn bench(args: &TraversalArgs) {
    let gpu = Headless::find_roomy(true);
    say!(
        "| triangles | build ms | nodes | CPU primary | bounce | shadow | obvhs, same nodes | bounce | obvhs medium | bounce | build ms |"
    );
    say!("|---|---|---|---|---|---|---|---|---|---|---|");
    for &count in &args.triangles {
        let triangles = courtyard(count);
        let (still, build_ms) = cpu_ms(|| Bvh::build(&triangles, None, &[]));
        let geometry = Geometry { still, moving: Bvh::default() };
        let primary = primary_rays(SIZE, vec3(6.0, 3.0, 8.0), vec3(-2.0, 1.5, -4.0), 60.0);
        let (hits, _) = closest(&geometry, &primary);
        let bounce = bounce_rays(&geometry, &primary, &hits);
        let shared = Obvhs::sharing(&geometry.still);
        let medium = Obvhs::build(&triangles, BvhBuildParams::medium_build());
        let best = |rate: &dyn Fn() -> f64| (0..5).map(|_| rate()).fold(0.0, f64::max);
        say!(
            "| {} | {build_ms:.0} | {} | {:.2} | {:.2} | {:.2} | {:.2} | {:.2} | {:.2} | {:.2} | {:.0} |",
            triangles.len(),
            geometry.still.node_count(),
            best(&|| closest(&geometry, &primary).1.mrays()),
            best(&|| closest(&geometry, &bounce).1.mrays()),
            best(&|| occluded(&geometry, &bounce).mrays()),
            best(&|| shared.closest(&primary).mrays()),
            best(&|| shared.closest(&bounce).mrays()),
            best(&|| medium.closest(&primary).mrays()),
            best(&|| medium.closest(&bounce).mrays()),
            medium.build_ms,
        );
        let Some(gpu) = &gpu else { continue };
        for storage in [Storage::Texture, Storage::Buffer] {
            let scene_buffer =
                SceneBufferBuilder::default().geometry(&geometry, 0).finish(storage.limits(&gpu.device.limits()));
            let scene_buffer = match scene_buffer {
                Ok(scene_buffer) => scene_buffer,
                Err(error) => {
                    say!("{storage:?}: {error}");
                    continue;
                }
            };
            let rate = |query, rays: &[Ray]| gpu_mrays(gpu, &scene_buffer, &geometry, storage, query, rays);
            say!(
                "{}, {storage:?}: primary {:.2}, bounce {:.2}, shadow {:.2}; {:.0} bytes a triangle",
                gpu.info.name,
                rate(HitQuery::Closest, &primary),
                rate(HitQuery::Closest, &bounce),
                rate(HitQuery::Any, &bounce),
                scene_buffer.bytes() as f64 / triangles.len() as f64,
            );
        }
    }
}
