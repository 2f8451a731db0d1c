//! Times of path-traced frames: at full rate, foveated, and one against the other.

mod foveated;
mod traced_view;

pub use foveated::{PatternReport, ROUNDS, UNIFORM_EVERY, UNIFORM_SAMPLES, measure, one_path, patterns, regions};
pub use traced_view::{Foveated, FrameTime, Pattern, TracedView};
