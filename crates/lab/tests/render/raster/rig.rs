//! One device shared by all tests, and frames compared with rays.

use afterimage::Image;
use afterimage_lab::device::Headless;
use afterimage_lab::raster::{Raster, RasterSettings};
use afterimage_lab::scene::Scene;
use afterimage_lab::trace::effects::Effects;
use afterimage_lab::trace::surfaces::Surfaces;
use afterimage_lab::trace::view::View;
use afterimage_lab::trace::world::World;

/// A frame read back from the device.
pub struct Frame {
    pub color: Image<[f32; 3]>,
    pub distance: Image<f32>,
    pub motion: Image<[f32; 2]>,
}

/// Without anisotropic filtering, which software devices do one texel at a time.
pub const FAST: RasterSettings = RasterSettings { anisotropy: 1, shadow_side: 1024 };

/// Draws `scene` at `times[0]` through `views[0]`; the previous frame is at `times[1]` through `views[1]`. Panics on
/// validation errors.
pub fn draw(device: &Headless, scene: &Scene, views: [&View; 2], times: [f64; 2]) -> Frame {
    let size = views[0].geometry().size_px();
    afterimage_testing::gpu::validated(&device.device, "a frame", || {
        let mut raster = Raster::new(&device.device, &device.queue, scene, size, FAST).unwrap();
        raster.pose(scene, times[0], times[1]);
        let mut encoder = device.device.create_command_encoder(&Default::default());
        raster.record(&device.device, &mut encoder, views[0], views[1]);
        device.queue.submit([encoder.finish()]);
        let targets = raster.targets();
        Frame {
            color: targets.read_color(device),
            distance: targets.read_distance(device, raster.near()),
            motion: targets.read_motion(device),
        }
    })
}

/// The path tracer's surfaces for the same arguments.
pub fn rays(scene: &Scene, views: [&View; 2], times: [f64; 2]) -> Surfaces {
    let mut world = World::new(scene);
    world.pose(scene, times[0], times[1]);
    Surfaces::trace(&world, views[0], views[1], Effects::needed(scene))
}

/// Largest differences from rays away from silhouettes, in pixels of motion and in relative distance; and the numbers
/// of surface and sky pixels compared.
#[derive(Debug)]
pub struct Difference {
    pub motion_px: f32,
    pub distance: f32,
    pub surface_pixels: usize,
    pub sky_pixels: usize,
}

/// Compares only pixels whose 3x3 neighbourhood is one smooth surface: planar in 1/distance according to the rays.
pub fn compare(frame: &Frame, rays: &Surfaces) -> Difference {
    let [w, h] = [frame.distance.width(), frame.distance.height()];
    let mut d = Difference { motion_px: 0.0, distance: 0.0, surface_pixels: 0, sky_pixels: 0 };
    for y in 1..h - 1 {
        for x in 1..w - 1 {
            let nearness = |x: usize, y: usize| 1.0 / rays.depth.at(x, y);
            let here = nearness(x, y);
            let bend = |a: f32, b: f32| (a + b - 2.0 * here).abs();
            // Planes are linear in 1/distance on screen; a bend of 1 in 1000 counts as an edge.
            let bends = [
                bend(nearness(x - 1, y), nearness(x + 1, y)),
                bend(nearness(x, y - 1), nearness(x, y + 1)),
                bend(nearness(x - 1, y - 1), nearness(x + 1, y + 1)),
                bend(nearness(x - 1, y + 1), nearness(x + 1, y - 1)),
            ];
            let smooth = bends.iter().all(|&b| b <= 1e-3 * here);
            let drawn = (y - 1..=y + 1).all(|j| {
                (x - 1..=x + 1).all(|i| frame.distance.at(i, j).is_finite() == rays.depth.at(i, j).is_finite())
            });
            if !smooth || !drawn {
                continue;
            }
            let (a, b) = (frame.motion.at(x, y), rays.motion.at(x, y));
            if a[0].abs().max(b[0].abs()) < 1e5 {
                d.motion_px = d.motion_px.max((a[0] - b[0]).abs()).max((a[1] - b[1]).abs());
            }
            if here > 0.0 {
                d.surface_pixels += 1;
                d.distance = d.distance.max((frame.distance.at(x, y) * here - 1.0).abs());
            } else {
                d.sky_pixels += 1;
            }
        }
    }
    d
}
