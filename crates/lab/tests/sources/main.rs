//! Where frames and eyes come from, and how good what is shown is.

mod analytic;
mod fixtures;
mod metric;
mod real_data;
mod scanpath;
mod source_files;
