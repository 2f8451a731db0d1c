//! Temporal post-process for foveated rendering.

pub mod convention;
pub mod display;
pub mod error;
pub mod image;
pub mod kernel;
#[cfg(feature = "lab")]
pub mod scanpath;
#[cfg(feature = "lab")]
pub mod source;
