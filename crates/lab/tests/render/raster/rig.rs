//! Scenes drawn on the device.

use afterimage::Image;
use afterimage::wgpu::{CommandEncoder, Device};
use afterimage_lab::device::Headless;
use afterimage_lab::raster::{Raster, RasterSettings, Shading, Targets};
use afterimage_lab::scene::Scene;
use afterimage_lab::view::View;
use std::sync::Arc;

/// A frame read back from the device.
pub struct Frame {
    pub color: Image<[f32; 3]>,
    pub distance: Image<f32>,
    pub motion: Image<[f32; 2]>,
}

/// Without anisotropic filtering, which software devices do one texel at a time.
pub const FAST: RasterSettings = RasterSettings { anisotropy: 1, shadow_side: 1024, shading: Shading::Forward };

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

/// PSNR in dB of colors from 0 to 1.
pub fn psnr_db(a: &Image<[f32; 3]>, b: &Image<[f32; 3]>) -> f64 {
    let numbers = a.pixels().as_flattened().iter().zip(b.pixels().as_flattened());
    let squares: f64 = numbers.map(|(a, b)| f64::from(a - b).powi(2)).sum();
    -10.0 * (squares / (3 * a.pixels().len()) as f64).log10()
}
