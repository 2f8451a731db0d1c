//! Evaluates the methods of [`afterimage`] on clips: plays frames through them, scores their output, and writes frames,
//! scores and a contact sheet. Nothing here needs a graphics device: `afterimage-lab` runs the same pipeline on one,
//! and adds renderers and files as sources.
//!
//! - [`frame`]: what sources give and methods take. [`source`]: the trait of sources, and analytic scenes.
//! - [`scanpath`]: recorded and synthetic gaze. [`quad_views`]: how sources can foveate.
//! - [`pipeline`]: foveates frames and runs the methods on them. [`metric`]: image quality of the output.
//! - [`clip`]: all of it over a clip.

pub mod clip;
pub mod clock;
pub mod error;
pub mod exposure;
pub mod frame;
pub mod method_report;
pub mod metric;
pub mod output;
pub mod picture;
pub mod pipeline;
pub mod quad_views;
pub mod report;
pub mod scanpath;
pub mod source;
pub mod times;
pub mod whole_file;
