//! Traces scenes on the CPU and on the device.

use crate::given::device;
use afterimage_lab::device::{Backend, Headless};
use afterimage_lab::scene::{Camera, Scene};
use afterimage_lab::view::View;
use afterimage_trace::cpu::CpuTracer;
use afterimage_trace::film::{Film, Moments};
use afterimage_trace::gpu::GpuTracer;
use afterimage_trace::gpu::scene_buffer::Storage;
use afterimage_trace::settings::TraceSettings;
use afterimage_trace::work::Spans;
use afterimage_trace::world::World;
use std::sync::Arc;

/// The CPU, and the device if there is one.
pub fn backends() -> Vec<Backend> {
    std::iter::once(Backend::Cpu).chain(device().map(Backend::Gpu)).collect()
}

/// A scene prepared for tracing.
pub struct Rig {
    pub name: String,
    pub world: World,
    pub view: View,
}

impl Rig {
    /// Views the scene through its first camera, or through one that frames all of it.
    pub fn new(scene: Scene, size: [u32; 2]) -> Self {
        let aspect = size[0] as f32 / size[1] as f32;
        let camera = scene.pose(0.0).cameras.first().cloned().unwrap_or_else(|| scene.framing_camera(aspect));
        Self::seen_by(scene, &camera, size)
    }

    pub fn seen_by(scene: Scene, camera: &Camera, size: [u32; 2]) -> Self {
        let view = View::of_camera(camera, size, None).unwrap();
        Self { name: scene.name.clone(), world: World::new(&scene), view }
    }

    pub fn size(&self) -> [u32; 2] {
        self.view.geometry().size_px()
    }

    pub fn spans(&self, spp: u32) -> Spans {
        Spans::uniform(self.size()[0], 0..self.size()[1], 0..spp)
    }

    pub fn cpu(&self, settings: TraceSettings, spp: u32) -> Film {
        let mut film = Film::new(self.size());
        CpuTracer::new(settings).trace(&self.world, &self.view, 0, &self.spans(spp), &mut film);
        film
    }

    pub fn gpu(&self, device: &Arc<Headless>, settings: TraceSettings, storage: Storage, spp: u32) -> Film {
        afterimage_testing::gpu::validated(&device.device, &self.name, || {
            let tracer = GpuTracer::with_storage(device.clone(), &self.world, settings, storage, |t| t).unwrap();
            let mut film = Film::new(self.size());
            tracer.trace(&self.world, &self.view, 0, &self.spans(spp), &mut film);
            film
        })
    }
}

/// Number of pixels whose mean, squares or count differ in any bit.
pub fn differing(a: &Film, b: &Film) -> usize {
    let bits = |m: &Moments| ([m.mean, m.squares].map(|v| v.to_array().map(f32::to_bits)), m.count);
    a.moments.pixels().iter().zip(b.moments.pixels()).filter(|(a, b)| bits(a) != bits(b)).count()
}
