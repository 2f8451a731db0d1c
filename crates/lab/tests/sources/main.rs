//! Frame sources, scanpaths and metrics.

mod analytic;
mod fixtures;
mod jitter;
mod metric;
mod real_data;
mod render_time;
mod scanpath;
mod source_files;
