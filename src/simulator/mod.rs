//! Simulators of foveation: turn a full-rate frame into the frame that a foveating renderer would have delivered.
//!
//! [`Foveation`](crate::internal::Foveation) describes the foveation of renderers and of simulators. `GpuSimulator`
//! foveates textures. For images in memory (feature `cpu`) there are `Foveation::lod_map` and `Foveation::render`, with
//! a `Pyramid` of mip levels.

#[cfg(feature = "cpu")]
mod block;
#[cfg(feature = "cpu")]
mod cpu;
#[cfg(feature = "cpu")]
mod gaussian;
#[cfg(feature = "gpu")]
pub(crate) mod gpu;
#[cfg(feature = "cpu")]
mod mip;

#[cfg(feature = "gpu")]
pub use gpu::{GpuSimulator, SimulatorFrame};
#[cfg(feature = "cpu")]
pub use mip::Pyramid;
