//! Row of a sweep's table.

use super::grid::Point;
use afterimage_lab::clock::Quartiles;
use serde::Serialize;
use std::collections::BTreeMap;

/// A point, merged over its seeds.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// Name of its files in `pictures/`.
    pub id: String,
    /// Method, and the options that differ between points.
    pub label: String,
    /// The point, with its first seed.
    #[serde(flatten)]
    pub point: Point,
    /// Number of seeds.
    pub seeds: usize,
    /// Time of the pass per frame, milliseconds, corrected for the machine's drift.
    pub pass_ms: Quartiles,
    /// Name of the round, and time of each frame, of the first seed.
    #[serde(skip)]
    pub frames: (String, Vec<f64>),
    /// Mean factor of the drift correction.
    pub drift: f64,
    /// Time of rendering the frame that the method gets, milliseconds: measured on scenes. `renderer_ms`, if given,
    /// times the share of the samples.
    pub render_ms: Option<f64>,
    /// Time of the pass and, where it is known, of rendering, milliseconds.
    pub cost_ms: f64,
    /// Time of the pass, the post-process, milliseconds: the median of `pass_ms`.
    pub post_ms: f64,
    /// Time of the whole frame, `render_ms` and `post_ms`; `None` where the renderer's time is not known.
    pub total_ms: Option<f64>,
    /// CPU time of rendering, if it was measured, corrected for drift as the others.
    pub render_cpu_ms: Option<f64>,
    /// CPU time of the pass.
    pub post_cpu_ms: Option<f64>,
    /// CPU time of rendering and of the pass together.
    pub total_cpu_ms: Option<f64>,
    /// Samples of the foveated frame divided by those of the full-rate frame.
    pub samples_share: f64,
    /// Mean camera samples per pixel, of traced frames.
    pub samples_per_pixel: Option<f64>,
    /// Time of a copy that moves as many bytes: a lower bound of the pass's time.
    pub copy_ms: f64,
    /// Bytes per pixel that the pass reads and writes.
    pub bytes_per_pixel: Option<u32>,
    /// Bytes per pixel that are kept between frames.
    pub memory_bytes_per_pixel: f64,
    /// Values by [`METRICS`](super::METRICS)' keys, means over the seeds.
    pub values: BTreeMap<&'static str, Option<f64>>,
    /// Mean squared error, mean over the seeds: whole image, then fovea, middle, periphery.
    pub mse: [Option<f64>; 4],
    /// Smallest and largest value over the seeds, if there are several.
    pub spread: BTreeMap<&'static str, [f64; 2]>,
    /// Metrics for which the point is on the frontier of its input.
    pub frontier: Vec<&'static str>,
    /// Output pixels that are NaN or infinite.
    pub nonfinite_out: u64,
    /// The command that runs the point.
    pub command: String,
    /// The settings, ready to paste into a program.
    pub rust: String,
}
