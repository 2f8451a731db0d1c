//! Options that several subcommands share, and parsers of their values.

#[cfg(feature = "full")]
pub mod backend;
#[cfg(feature = "full")]
mod foveation;
pub mod gaze;
#[cfg(feature = "full")]
pub mod input;
#[cfg(feature = "full")]
mod method;
mod named;
#[cfg(feature = "full")]
mod number;
#[cfg(feature = "full")]
pub mod paths;
#[cfg(feature = "full")]
pub mod pattern;
mod picture;

#[cfg(feature = "full")]
pub use foveation::{FilterName, FoveationArgs};
#[cfg(feature = "full")]
pub use method::{MethodName, WrsArgs};
pub use named::{Named, by_name};
#[cfg(feature = "full")]
pub use number::{parse_exposure, parse_fps, parse_frames, parse_hfov, parse_samples, parse_size};
pub use picture::FormatName;
