//! Measurement of a point, as stored in the files of a sweep.

use super::grid::{Options, Point};
use crate::method_report::MethodReport;
use afterimage_lab::clock::Quartiles;
use serde::{Deserialize, Serialize};

/// Measurement of one point with one seed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Measurement {
    /// Version of the tool.
    pub version: String,
    /// The point.
    #[serde(flatten)]
    pub point: Point,
    /// Options that all points of the sweep share.
    pub common: Options,
    /// Properties of the clip.
    pub clip: ClipFacts,
    /// The machine.
    pub machine: Machine,
    /// Time of the pass per frame in milliseconds, without the warm-up frames.
    pub pass_ms: Quartiles,
    /// Median CPU time of the pass, if the system measures it.
    pub pass_cpu_ms: Option<f64>,
    /// Time of the pass in each timed frame, milliseconds. Comparable frame by frame with points of the same round.
    pub frame_ms: Vec<f64>,
    /// Name of the round (batch).
    pub round: String,
    /// Time of the control method (`taa` with its defaults) in the same frames: shows the drift of the machine's speed.
    pub control_ms: Quartiles,
    /// Time of rendering the frame that the method gets: foveated where the renderer foveates, at full rate where a
    /// simulator does. `None` for frames that are not rendered.
    pub render_ms: Option<Quartiles>,
    /// Median CPU time of rendering that frame.
    pub render_cpu_ms: Option<f64>,
    /// Samples of the foveated frame divided by those of the full-rate frame.
    pub samples_share: f64,
    /// Mean camera samples per pixel; `None` if a simulator foveates.
    pub samples_per_pixel: Option<f64>,
    /// Time of a copy that moves as many bytes as the pass.
    pub copy_ms: f64,
    /// Scores and counts.
    pub figures: MethodReport,
    /// The settings, ready to paste into a program.
    pub rust: String,
}

/// Properties of a clip.
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

/// Machine, and clock of the times.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Machine {
    /// `cpu` or `gpu`.
    pub kind: String,
    /// Name of the adapter, or number of threads.
    pub name: String,
    /// Driver; `none` on the CPU.
    pub driver: String,
    /// Description of the clock.
    pub clock: String,
}
