//! Frame sources, scanpaths and metrics.

#[path = "../common/explained.rs"]
mod explained;
#[path = "../common/hostile.rs"]
mod hostile;
#[path = "../common/roomy.rs"]
mod roomy;
#[path = "../common/shared_data.rs"]
mod shared_data;

mod analytic;
mod fixtures;
mod jitter;
mod metric;
mod quads;
mod real_data;
mod render_time;
mod scanpath;
mod source_files;
