//! Scenes drawn on the device, and frames compared with rays.

use afterimage::Image;
use afterimage::wgpu::{CommandEncoder, Device};
use afterimage_lab::device::Headless;
use afterimage_lab::raster::{Raster, RasterSettings, Targets};
use afterimage_lab::scene::Scene;
use afterimage_lab::trace::effects::Effects;
use afterimage_lab::trace::surfaces::Surfaces;
use afterimage_lab::trace::view::View;
use afterimage_lab::trace::world::World;
use std::sync::Arc;

/// A frame read back from the device.
pub struct Frame {
    pub color: Image<[f32; 3]>,
    pub distance: Image<f32>,
    pub motion: Image<[f32; 2]>,
}

/// Without anisotropic filtering, which software devices do one texel at a time.
pub const FAST: RasterSettings = RasterSettings { anisotropy: 1, shadow_side: 1024 };

/// A scene on the device.
pub struct Rig {
    pub device: Arc<Headless>,
    pub raster: Raster,
}

impl Rig {
    pub fn new(device: &Arc<Headless>, scene: &Scene, size: [u32; 2]) -> Self {
        let raster = afterimage_testing::gpu::validated(&device.device, "a scene", || {
            Raster::new(&device.device, &device.queue, scene, size, FAST).unwrap()
        });
        Self { device: device.clone(), raster }
    }

    /// Submits what is recorded. Panics on validation errors.
    pub fn submit(&mut self, record: impl FnOnce(&mut Raster, &Device, &mut CommandEncoder)) {
        let gpu = &self.device;
        afterimage_testing::gpu::validated(&gpu.device, "a frame", || {
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            record(&mut self.raster, &gpu.device, &mut encoder);
            gpu.queue.submit([encoder.finish()]);
        });
    }

    pub fn read(&self, targets: &Targets) -> Frame {
        Frame {
            color: targets.read_color(&self.device),
            distance: targets.read_distance(&self.device, self.raster.near()),
            motion: targets.read_motion(&self.device),
        }
    }

    /// The full-rate frame through the first view; the previous one was through the second.
    pub fn full(&mut self, [view, previous]: [&View; 2]) -> Frame {
        self.submit(|raster, device, encoder| raster.record(device, encoder, view, previous));
        self.read(self.raster.targets())
    }
}

/// Draws `scene` at `times[0]` through `views[0]`; the previous frame is at `times[1]` through `views[1]`.
pub fn draw(device: &Arc<Headless>, scene: &Scene, views: [&View; 2], times: [f64; 2]) -> Frame {
    let mut rig = Rig::new(device, scene, views[0].geometry().size_px());
    rig.raster.pose(scene, times[0], times[1]);
    rig.full(views)
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

/// Whether the pixel and its neighbours are one surface, or sky. Planes are linear in 1 / distance on screen; a bend of
/// 1 in 1000 counts as an edge.
pub fn is_smooth(distance: &Image<f32>, [x, y]: [usize; 2]) -> bool {
    if x == 0 || y == 0 || x + 1 == distance.width() || y + 1 == distance.height() {
        return false;
    }
    let nearness = |[x, y]: [usize; 2]| 1.0 / distance.at(x, y);
    let here = nearness([x, y]);
    let across = [[[x - 1, y], [x + 1, y]], [[x, y - 1], [x, y + 1]], [[x - 1, y - 1], [x + 1, y + 1]]];
    across.into_iter().all(|pair| {
        let [a, b] = pair.map(nearness);
        (a + b - 2.0 * here).abs() <= 1e-3 * here && (a > 0.0) == (here > 0.0) && (b > 0.0) == (here > 0.0)
    })
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

/// PSNR in dB of colors from 0 to 1.
pub fn psnr_db(a: &Image<[f32; 3]>, b: &Image<[f32; 3]>) -> f64 {
    let numbers = a.pixels().as_flattened().iter().zip(b.pixels().as_flattened());
    let squares: f64 = numbers.map(|(a, b)| f64::from(a - b).powi(2)).sum();
    -10.0 * (squares / (3 * a.pixels().len()) as f64).log10()
}
