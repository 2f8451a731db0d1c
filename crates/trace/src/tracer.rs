//! A path tracer on either backend.

use super::cpu::CpuTracer;
use super::film::Film;
use super::gpu::GpuTracer;
use super::scene_buffer::SceneBufferError;
use super::settings::TraceSettings;
use super::work::Spans;
use super::world::World;
use afterimage::FrameError;
use afterimage_lab::device::Backend;
use afterimage_lab::scene::effects::Effects;
use afterimage_lab::view::View;
use std::time::Duration;

/// A tracer on the CPU or on a GPU: the same paths, the same film.
#[derive(Debug)]
pub enum Tracer {
    /// On all CPU threads.
    Cpu(CpuTracer),
    /// On a GPU, with kernels specialized to the scene.
    Gpu(Box<GpuTracer>),
}

impl Tracer {
    /// Creates a tracer of `world`.
    ///
    /// # Errors
    /// If the scene does not fit on the device.
    pub fn new(backend: &Backend, world: &World, settings: TraceSettings) -> Result<Self, SceneBufferError> {
        Ok(match backend {
            Backend::Cpu => Self::Cpu(CpuTracer::new(settings)),
            Backend::Gpu(device) => Self::Gpu(Box::new(GpuTracer::new(device.clone(), world, settings)?)),
        })
    }

    /// Effects that are simulated.
    pub fn effects(&self, world: &World) -> Effects {
        match self {
            Self::Cpu(tracer) => tracer.effects(world),
            Self::Gpu(tracer) => tracer.effects(),
        }
    }

    /// Time spent compiling kernels; zero on the CPU.
    pub fn compile_time(&self) -> Duration {
        match self {
            Self::Cpu(_) => Duration::ZERO,
            Self::Gpu(tracer) => tracer.compile_time,
        }
    }

    /// Size of the scene on the device in bytes; `None` on the CPU.
    pub fn scene_bytes(&self) -> Option<u64> {
        match self {
            Self::Cpu(_) => None,
            Self::Gpu(tracer) => Some(tracer.scene_bytes()),
        }
    }

    /// Uploads moved geometry and lights. Call it after [`World::pose`].
    ///
    /// # Errors
    /// If more triangles or lights move than the capacity reserved at creation.
    pub fn update(&mut self, world: &World) -> Result<(), SceneBufferError> {
        match self {
            Self::Cpu(_) => Ok(()),
            Self::Gpu(tracer) => tracer.update(world),
        }
    }

    /// Reports a lost device. Call it after [`trace`](Self::trace): on a lost device the film receives black samples.
    ///
    /// # Errors
    /// [`FrameError::DeviceLost`].
    pub fn check(&self) -> Result<(), FrameError> {
        match self {
            Self::Cpu(_) => Ok(()),
            Self::Gpu(tracer) => tracer.check(),
        }
    }

    /// Adds the samples of `work` to `film`, which must contain all its pixels. `frame` is the frame number; every
    /// frame has its own random draws.
    pub fn trace(&self, world: &World, view: &View, frame: u64, work: &Spans, film: &mut Film) {
        match self {
            Self::Cpu(tracer) => tracer.trace(world, view, frame, work, film),
            Self::Gpu(tracer) => tracer.trace(world, view, frame, work, film),
        }
    }
}
