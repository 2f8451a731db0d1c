//! Options that several subcommands share, and parsers of their values.

pub mod backend;
pub mod channels;
pub mod display;
mod foveation;
pub mod gaze;
mod gaze_columns;
mod gaze_frames;
mod gaze_layout;
pub mod gaze_log;
pub mod head;
pub mod input;
mod method;
mod named;
mod number;
pub mod paths;
pub mod pattern;
mod picture;

pub use foveation::{FilterName, FoveationArgs};
pub use method::{MethodArgs, MethodName};
pub use named::{Named, by_name};
pub use number::{
    parse_contrast, parse_distance_mm, parse_exposure, parse_fps, parse_frame_range, parse_frames, parse_hfov,
    parse_latency, parse_lux, parse_nits, parse_percent, parse_pixel, parse_samples, parse_size, parse_size_mm,
    parse_stops, print_exposure,
};
pub use picture::FormatName;
