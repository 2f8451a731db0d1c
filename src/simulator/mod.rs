//! Simulators of foveation: of a full-rate frame they make what a foveating renderer would have delivered.
//!
//! [`Foveation`](crate::foveation::Foveation) describes both. On the device: [`gpu`]; in memory: its methods `lod_map` and `render`.

#[cfg(feature = "cpu")]
mod block;
#[cfg(feature = "cpu")]
mod cpu;
#[cfg(feature = "cpu")]
mod gaussian;
#[cfg(feature = "gpu")]
pub mod gpu;
#[cfg(feature = "cpu")]
mod mip;

#[cfg(feature = "cpu")]
pub use mip::Pyramid;
