//! What was measured of a point, as the files of a sweep have it.

use super::grid::{Options, Point};
use crate::report::method::MethodReport;
use afterimage_lab::clock::Quartiles;
use serde::{Deserialize, Serialize};

/// One point with one seed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Measurement {
    /// Version of the tool.
    pub version: String,
    /// The point.
    #[serde(flatten)]
    pub point: Point,
    /// Options that all points of the sweep share.
    pub common: Options,
    /// What was measured on.
    pub clip: ClipFacts,
    /// What measured.
    pub machine: Machine,
    /// Cost of the pass a frame in milliseconds, without the first frames.
    pub pass_ms: Quartiles,
    /// The same of each frame: of points of one round, frame by frame comparable.
    pub frame_ms: Vec<f64>,
    /// Name of the round that it was measured in.
    pub round: String,
    /// Cost of the control, the method `taa` with its defaults, in the same frames: what the machine's drift is told by.
    pub control_ms: Quartiles,
    /// Cost of tracing the foveated frame; `None` where a simulator foveates, which costs what no renderer would pay.
    pub render_ms: Option<Quartiles>,
    /// Samples of the foveated frame over those of the full-rate one.
    pub samples_share: f64,
    /// Camera samples a pixel of the frame, on average; `None` where a simulator foveates.
    pub samples_per_pixel: Option<f64>,
    /// Time of a copy that reads and writes as many bytes as the pass.
    pub copy_ms: f64,
    /// Scores and counts.
    pub figures: MethodReport,
    /// The settings, ready to paste into a program.
    pub rust: String,
}

/// What was measured on.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ClipFacts {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Frames scored.
    pub frames: u64,
    /// Frames timed.
    pub timed_frames: u64,
    /// Frames per second.
    pub fps: f32,
    /// Horizontal field of view in degrees.
    pub hfov_deg: f32,
}

/// What measured.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Machine {
    /// `cpu` or `gpu`.
    pub kind: String,
    /// Adapter, or threads.
    pub name: String,
    /// Driver; `none` on the CPU.
    pub driver: String,
    /// What the times are, in words.
    pub clock: String,
}
