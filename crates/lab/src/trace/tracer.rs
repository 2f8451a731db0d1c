//! A tracer on whatever there is.

use super::cpu::CpuTracer;
use super::effects::Effects;
use super::film::Film;
use super::gpu::GpuTracer;
use super::scene_buffer::SceneBufferError;
use super::settings::TraceSettings;
use super::view::View;
use super::work::Work;
use super::world::World;
use crate::device::Backend;
use afterimage::FrameError;
use std::time::Duration;

/// On the CPU or on a device: the same paths, the same film.
#[derive(Debug)]
pub enum Tracer {
    /// With all threads.
    Cpu(CpuTracer),
    /// With kernels made for the scene.
    Gpu(Box<GpuTracer>),
}

impl Tracer {
    /// A tracer of `world`.
    ///
    /// # Errors
    /// If the device has no room for the scene.
    pub fn new(backend: &Backend, world: &World, settings: TraceSettings) -> Result<Self, SceneBufferError> {
        Ok(match backend {
            Backend::Cpu => Self::Cpu(CpuTracer::new(settings)),
            Backend::Gpu(device) => Self::Gpu(Box::new(GpuTracer::new(device.clone(), world, settings)?)),
        })
    }

    /// What is simulated.
    pub fn effects(&self, world: &World) -> Effects {
        match self {
            Self::Cpu(tracer) => tracer.effects(world),
            Self::Gpu(tracer) => tracer.effects(),
        }
    }

    /// Time that compiling kernels took; none on the CPU.
    pub fn compile_time(&self) -> Duration {
        match self {
            Self::Cpu(_) => Duration::ZERO,
            Self::Gpu(tracer) => tracer.compile_time,
        }
    }

    /// Bytes of the scene on the device; `None` on the CPU.
    pub fn scene_bytes(&self) -> Option<u64> {
        match self {
            Self::Cpu(_) => None,
            Self::Gpu(tracer) => Some(tracer.scene_bytes()),
        }
    }

    /// To be called after [`World::pose`].
    ///
    /// # Errors
    /// If more moves than at first.
    pub fn update(&mut self, world: &World) -> Result<(), SceneBufferError> {
        match self {
            Self::Cpu(_) => Ok(()),
            Self::Gpu(tracer) => tracer.update(world),
        }
    }

    /// To be called after [`trace`](Self::trace): on a lost device the film gets black samples.
    ///
    /// # Errors
    /// [`FrameError::DeviceLost`].
    pub fn check(&self) -> Result<(), FrameError> {
        match self {
            Self::Cpu(_) => Ok(()),
            Self::Gpu(tracer) => tracer.check(),
        }
    }

    /// Adds the samples of `work`, whose pixels must be on it, to `film`. `frame` is the frame's number: each has draws of its own.
    pub fn trace<'w>(&self, world: &World, view: &View, frame: u64, work: impl Into<Work<'w>>, film: &mut Film) {
        match self {
            Self::Cpu(tracer) => tracer.trace(world, view, frame, work, film),
            Self::Gpu(tracer) => tracer.trace(world, view, frame, work, film),
        }
    }
}
