//! Frame sources, scanpaths and metrics.

#[path = "../common/explained.rs"]
mod explained;
#[allow(dead_code, reason = "tests of scenes use the rest")]
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
mod real_data;
mod scanpath;
mod source_files;
