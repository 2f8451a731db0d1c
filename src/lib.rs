//! Temporal post-process for foveated rendering.

pub mod convention;
pub mod cpu;
pub mod display;
pub mod error;
#[cfg(feature = "lab")]
pub mod foveation;
pub mod frame;
pub mod image;
pub mod kernel;
#[cfg(feature = "lab")]
pub mod metric;
#[cfg(feature = "lab")]
pub mod pipeline;
#[cfg(feature = "lab")]
pub mod report;
#[cfg(feature = "lab")]
pub mod scanpath;
pub mod settings;
#[cfg(feature = "lab")]
pub mod source;

pub use settings::Settings;
