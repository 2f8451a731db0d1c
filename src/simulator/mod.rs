//! Simulators of foveation: of a full-rate frame they make what a foveating renderer would have delivered.
//!
//! One [`Foveation`](crate::Foveation) describes renderer and simulator. [`GpuSimulator`] foveates textures; for images in memory
//! (feature `cpu`) there are the methods `lod_map` and `render` of `Foveation` and their [`Pyramid`].

#[cfg(feature = "cpu")]
mod block;
#[cfg(feature = "cpu")]
mod cpu;
#[cfg(feature = "cpu")]
mod gaussian;
#[cfg(feature = "gpu")]
#[doc(hidden)]
pub mod gpu;
#[cfg(feature = "cpu")]
mod mip;

#[cfg(feature = "gpu")]
pub use gpu::{GpuSimulator, SimulatorFrame};
#[cfg(feature = "cpu")]
pub use mip::Pyramid;
