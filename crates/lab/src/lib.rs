//! Everything to see, test and price [`afterimage`]: where frames come from, where the eye looks, how good the result is.
//!
//! - [`source`]: stills, EXR sequences, analytic scenes, rendered scenes; all hand out [`frame::SourceFrame`]s.
//! - [`scene`]: glTF and built-in scenes. [`raster`]: render passes of them. [`trace`]: path tracing, foveated or not.
//! - [`scanpath`]: recorded and synthetic eyes.
//! - [`pipeline`]: a frame through foveation and methods. [`metric`]: how good what they show is.
//! - [`device`]: a device without a window.

pub mod clock;
pub mod device;
pub mod error;
pub mod frame;
pub mod kernel;
pub mod metric;
pub mod picture;
pub mod pipeline;
#[cfg(feature = "full")]
pub mod raster;
pub mod scanpath;
#[cfg(feature = "full")]
pub mod scene;
#[cfg(feature = "full")]
pub mod self_test;
#[cfg(feature = "full")]
pub mod shader;
pub mod source;
#[cfg(feature = "full")]
pub mod trace;
pub mod whole_file;
