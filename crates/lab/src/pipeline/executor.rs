//! What a pipeline asks of the processor that runs its methods.

use super::candidate::Candidate;
use super::run::{MethodOutput, RunKind};
use crate::frame::RenderedFrame;
use afterimage::kernel::noise::Noise;
use afterimage::{ContextDesc, CreateError, DebugView, FrameError, Image, Reset, Smr};

/// Methods on the CPU or on a device, in the order in which they were added.
pub(super) trait Executor: Send {
    /// Adds a method with `desc`'s settings.
    fn add(&mut self, kind: &RunKind, desc: &ContextDesc) -> Result<(), CreateError>;

    /// Whether the methods get foveated frames in memory.
    fn reads_memory(&self) -> bool;

    /// Makes a frame the current one.
    fn set(&mut self, frame: &RenderedFrame, candidate: &Candidate<'_>) -> Result<(), FrameError>;

    /// Runs a method on the current frame.
    fn run(&mut self, run: usize, shot: &Shot<'_>) -> Result<MethodOutput, FrameError>;

    /// Bytes of history that a method keeps between frames.
    fn memory_bytes(&self, run: usize) -> usize;

    /// Noise of a method's history, and smr's settings; `None` unless it is smr of noisy frames.
    fn history_noise(&self, run: usize) -> Option<(Image<Noise>, Smr)>;
}

/// The current frame, and what is asked of its methods.
pub(super) struct Shot<'a> {
    pub frame: &'a RenderedFrame,
    pub candidate: &'a Candidate<'a>,
    /// Debug views to draw.
    pub debug: &'a [DebugView],
    /// Whether the methods get the source's trust mask.
    pub use_trust: bool,
}

impl Shot<'_> {
    /// A cut empties the history.
    pub fn reset(&self) -> Reset {
        if self.frame.reference.cut { Reset::All } else { Reset::None }
    }
}
