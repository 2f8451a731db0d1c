//! Frame sources, renderers, scanpaths and metrics to test and measure [`afterimage`].
//!
//! - [`source`]: stills, EXR sequences, analytic scenes and rendered scenes, all as streams of [`frame::SourceFrame`]s.
//! - [`scene`]: glTF and built-in scenes, and the [`view`] of a camera. [`raster`]: a rasteriser for them. [`rays`]:
//!   what rays meet in them.
//! - [`scanpath`]: recorded and synthetic gaze.
//! - [`quad_views`]: foveation as headset runtimes draw it, for comparison.
//! - [`pipeline`]: foveates frames and runs the methods on them. [`metric`]: image quality of the output.
//! - [`device`]: a graphics device without a window. [`error`]: errors of inputs.

extern crate wgpu_30 as wgpu;

pub use afterimage_eval::{clock, metric, picture, quad_views, scanpath, whole_file};

pub mod device;
pub mod error;
mod file_kind;
pub mod frame;
pub mod kernel;
pub mod pipeline;
pub mod raster;
pub mod rays;
pub mod scene;
pub mod self_test;
pub mod shader;
pub mod source;
pub mod view;
