//! The device's hits equal the CPU's bit for bit: triangle, distance, barycentric weights.

use super::scenes::{all, direction, rays, soup, sphere};
use crate::given::device;
use afterimage_lab::device::Headless;
use afterimage_lab::rays::{Bvh, Geometry, Hit, Ray};
use afterimage_lab::scene::{Alpha, Material};
use afterimage_testing::{Draws, holds};
use afterimage_trace::gpu::ray_lists::{GpuRays, HitQuery};
use afterimage_trace::gpu::scene_buffer::{GpuSceneBuffer, Storage};
use afterimage_trace::scene_buffer::{SceneBuffer, SceneBufferBuilder};
use glam::{Vec3, vec3};
use std::sync::Arc;

const STORAGES: [Storage; 2] = [Storage::Texture, Storage::Buffer];

struct Rig {
    gpu: Arc<Headless>,
    geometry: Geometry,
    scene_buffer: SceneBuffer,
    on_device: GpuSceneBuffer,
    storage: Storage,
}

impl Rig {
    fn new(geometry: Geometry, max_moving: usize, storage: Storage) -> Option<Self> {
        let gpu = device()?;
        let limits = storage.limits(&gpu.device.limits());
        let scene_buffer = SceneBufferBuilder::default().geometry(&geometry, max_moving).finish(limits).unwrap();
        let on_device = GpuSceneBuffer::new(&gpu.device, &gpu.queue, &scene_buffer, storage);
        Some(Self { gpu, geometry, scene_buffer, on_device, storage })
    }

    fn ask(&self, query: HitQuery, rays: &[Ray], source: Option<&str>) -> Vec<Option<Hit>> {
        afterimage_testing::gpu::validated(&self.gpu.device, "the tracer", || {
            let tracer = GpuRays::new(&self.gpu, &self.scene_buffer, &self.geometry, self.storage, query, source);
            let batch = tracer.batch(&self.on_device, rays);
            tracer.run(&batch);
            tracer.hits(&batch)
        })
    }

    /// Number of rays whose hits differ from the CPU's in any bit.
    fn differing(&self, rays: &[Ray], source: Option<&str>) -> usize {
        let got = self.ask(HitQuery::Closest, rays, source);
        rays.iter().zip(got).filter(|(ray, got)| self.geometry.closest(ray, all) != *got).count()
    }

    #[track_caller]
    fn check(&self, name: &str, rays: &[Ray]) {
        let differing = self.differing(rays, None);
        println!("{name}, {:?}: {differing} of {} hits differ", self.storage, rays.len());
        assert_eq!(differing, 0, "{name}");
        let any = self.ask(HitQuery::Any, rays, None);
        assert!(rays.iter().zip(any).all(|(ray, got)| self.geometry.occluded(ray, all) == got.is_some()), "{name}");
    }
}

fn resting(still: Bvh) -> Geometry {
    Geometry { still, ..Geometry::default() }
}

#[test]
fn copies_of_triangles_are_told_apart_alike() {
    let once = soup("copies on the device", 300, Vec3::ZERO, 1.0);
    let mut twice = once.clone();
    twice.extend(&once);
    let geometry = Geometry { still: Bvh::build(&twice, None, &[]), moving: Bvh::build(&once, None, &[]) };
    let Some(rig) = Rig::new(geometry, 300, Storage::Texture) else { return };
    rig.check("copies", &rays("copies on the device", 20_000, Vec3::ZERO, 1.0));
}

#[test]
fn moving_triangles_are_where_they_were_last_written() {
    for storage in STORAGES {
        let still = Bvh::build(&soup("still on the device", 500, Vec3::ZERO, 1.0), None, &[]);
        let pose = |i: u32, count| Bvh::build(&soup(&format!("pose {i}"), count, Vec3::ZERO, 1.0), None, &[]);
        let Some(mut rig) = Rig::new(Geometry { still, moving: pose(0, 200) }, 200, storage) else { return };
        let rays = rays("poses", 5000, Vec3::ZERO, 1.0);
        rig.check("first pose", &rays);
        for (i, count) in [(1, 200), (2, 7), (3, 0), (4, 200)] {
            rig.geometry.moving = pose(i, count);
            // Until the upload, the device still has the earlier pose.
            assert!(rig.differing(&rays, None) > 0);
            rig.scene_buffer.rewrite_moving(&rig.geometry).unwrap();
            rig.on_device.write_moving(&rig.gpu.queue, &rig.scene_buffer);
            rig.check(&format!("pose {i} of {count}"), &rays);
        }
    }
}

#[test]
fn h80_a_closed_sphere_has_no_holes_on_the_device() {
    let mut asked = 0;
    for (center, radius, levels) in [(Vec3::ZERO, 1.0, 6), (Vec3::splat(1e6), 100.0, 4), (Vec3::ZERO, 1e-3, 4)] {
        let geometry = resting(Bvh::build(&sphere(center, radius, levels), None, &[]));
        let Some(rig) = Rig::new(geometry, 0, Storage::Texture) else { return };
        let mut d = Draws::new("holes");
        let corners = rig.geometry.still.triangles().iter().map(|t| t.positions());
        let targets = corners.flat_map(|[a, b, c]| [a, (a + b) * 0.5, (a + b + c) / 3.0]).map(|p| p - center);
        let mut directions: Vec<Vec3> = targets.chain((0..20_000).map(|_| direction(&mut d))).collect();
        for x in [0.0, -0.0] {
            for one in [1.0, -1.0] {
                directions.extend([vec3(one, x, -x), vec3(x, one, x), vec3(-x, x, one), vec3(one, one, x)]);
            }
        }
        let ray = |direction| Ray { origin: center, direction, t_max: f32::INFINITY };
        let rays: Vec<Ray> = directions.into_iter().map(ray).collect();
        let holes = rig.ask(HitQuery::Closest, &rays, None).iter().filter(|h| h.is_none()).count();
        println!("radius {radius} around {center}: {holes} holes, {} rays", rays.len());
        assert_eq!(holes, 0);
        rig.check("sphere", &rays);
        asked += rays.len();
    }
    holds!("H80", Gpu, "three closed spheres: 0 holes in {asked} rays, every hit the CPU's bit for bit");
}

#[test]
fn opacity_is_asked_where_it_matters_and_only_there() {
    let materials = [Material { alpha: Alpha::Mask { cutoff: 0.5 }, ..Material::default() }, Material::default()];
    let mut triangles = soup("alpha on the device", 600, Vec3::ZERO, 1.0);
    triangles.materials = (0..600).map(|i| i % 2).collect();
    let geometry = resting(Bvh::build(&triangles, None, &materials));
    let Some(rig) = Rig::new(geometry, 0, Storage::Texture) else { return };
    let rays = rays("alpha on the device", 10_000, Vec3::ZERO, 1.0);
    // An alpha test that accepts a third of the hits, by triangle index.
    let source = GpuRays::source(Storage::Texture)
        .replace("    return true;\n}", "    return triangle % 3u != 0u;\n}")
        .replace("if ALPHA {", "if true {");
    for (ray, got) in rays.iter().zip(rig.ask(HitQuery::Closest, &rays, Some(&source))) {
        assert_eq!(got, rig.geometry.closest(ray, |triangle, _, _| triangle % 3 != 0));
    }
    let differing = rig.differing(&rays, Some(&source));
    println!("{differing} hits go through");
    assert!(differing > 100);
}

#[test]
fn planted_errors_are_caught() {
    let geometry = |name: &str| Geometry {
        still: Bvh::build(&soup(name, 3000, Vec3::ZERO, 1.0), None, &[]),
        moving: Bvh::build(&soup(&format!("{name}, moving"), 300, Vec3::ZERO, 1.0), None, &[]),
    };
    let Some(rig) = Rig::new(geometry("planted"), 300, Storage::Texture) else { return };
    let rays = rays("planted", 20_000, Vec3::ZERO, 1.0);
    // The same rays, limited so that they hit nothing.
    let nearest = |r: &Ray| rig.geometry.closest(r, all).map_or(1.0, |h| h.t);
    let limits: Vec<Ray> = rays.iter().map(|r| Ray { t_max: nearest(r), ..*r }).collect();
    let source = GpuRays::source(Storage::Texture);
    let planted = [
        ("max(e0, max(e1, e2)) > 0.0", "max(e0, max(e1, e2)) < 0.0"),
        ("if MOVES {\n        hit", "if false {\n        hit"),
        ("hit.triangle != NO_TRIANGLE && number", "number"),
    ];
    afterimage_testing::planted::all_caught_once(source, &planted, |source| {
        Some(rig.differing(&rays, Some(source)) + rig.differing(&limits, Some(source)) > 0)
    });
}

#[test]
fn boxes_that_are_not_widened_let_rays_leak() {
    // Flat boxes: walls of an axis-aligned room, with distant rays towards them and along their edges.
    let mut triangles = afterimage_lab::scene::Triangles::default();
    for i in 0..40 {
        for j in 0..40 {
            let (x, y) = (i as f32 * 0.37 + 1000.1, j as f32 * 0.41 - 777.7);
            let at = |x, y| vec3(x, 0.3, y);
            triangles.push_quad([at(x, y), at(x + 0.37, y), at(x + 0.37, y + 0.41), at(x, y + 0.41)], 0);
        }
    }
    let Some(rig) = Rig::new(resting(Bvh::build(&triangles, None, &[])), 0, Storage::Texture) else { return };
    let mut d = Draws::new("flat boxes");
    let rays: Vec<Ray> = (0..40_000)
        .map(|_| {
            let origin = vec3(d.range(-3e4, 3e4), d.range(1.0, 3e3), d.range(-3e4, 3e4));
            let target = vec3(d.range(1000.2, 1014.0), 0.3, d.range(-777.0, -762.0));
            Ray { origin, direction: (target - origin).normalize(), t_max: f32::INFINITY }
        })
        .collect();
    rig.check("flat boxes", &rays);
    let source = GpuRays::source(Storage::Texture).replace("NODE_SLACK: f32 = 1.0 / 524288.0", "NODE_SLACK: f32 = 0.0");
    let differing = rig.differing(&rays, Some(&source));
    println!("without widening: {differing} of {} rays leak", rays.len());
    assert!(differing > 0, "planted error not caught");
}
