//! Frame sources, scanpaths and metrics.

mod analytic;
mod fixtures;
mod metric;
mod real_data;
mod scanpath;
mod source_files;
