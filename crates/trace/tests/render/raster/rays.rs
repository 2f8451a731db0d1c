//! Frames of the rasterizer compared with rays.

use super::rig::{Frame, is_smooth};
use afterimage_lab::scene::Scene;
use afterimage_lab::scene::effects::Effects;
use afterimage_lab::view::View;
use afterimage_trace::surfaces::Surfaces;
use afterimage_trace::world::World;

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

/// Compares only pixels whose 3x3 neighbourhood is smooth according to the rays.
pub fn compare(frame: &Frame, rays: &Surfaces) -> Difference {
    let [w, h] = [frame.distance.width(), frame.distance.height()];
    let mut d = Difference { motion_px: 0.0, distance: 0.0, surface_pixels: 0, sky_pixels: 0 };
    for (x, y) in (0..h).flat_map(|y| (0..w).map(move |x| (x, y))).filter(|&(x, y)| is_smooth(&rays.depth, [x, y])) {
        let mut around = (y - 1..=y + 1).flat_map(|j| (x - 1..=x + 1).map(move |i| (i, j)));
        if around.any(|(i, j)| frame.distance.at(i, j).is_finite() != rays.depth.at(i, j).is_finite()) {
            continue;
        }
        let (a, b) = (frame.motion.at(x, y), rays.motion.at(x, y));
        if a[0].abs().max(b[0].abs()) < 1e5 {
            d.motion_px = d.motion_px.max((a[0] - b[0]).abs()).max((a[1] - b[1]).abs());
        }
        let depth = rays.depth.at(x, y);
        if depth.is_finite() {
            d.surface_pixels += 1;
            d.distance = d.distance.max((frame.distance.at(x, y) / depth - 1.0).abs());
        } else {
            d.sky_pixels += 1;
        }
    }
    d
}
