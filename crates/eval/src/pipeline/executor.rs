//! Interface of a pipeline to the processor that runs its methods.

use super::candidate::Candidate;
use super::run::{MethodOutput, RunKind};
use crate::frame::{DeviceHandle, RenderedFrame, Shaded, ShadingRequest};
use afterimage::internal::{ContextDesc, Reset};
use afterimage::{CreateError, DebugView, FrameError};

/// Methods on the CPU or on a device, in the order in which they were added.
pub trait Executor: Send {
    /// Adds a method with `desc`'s settings.
    ///
    /// # Errors
    /// [`CreateError`] if a setting is out of range or the processor does not support it.
    fn add(&mut self, kind: &RunKind, desc: &ContextDesc) -> Result<(), CreateError>;

    /// Device that the methods run on; `None`: they get foveated frames in memory.
    fn device(&self) -> Option<DeviceHandle>;

    /// Makes a frame the current one.
    ///
    /// # Errors
    /// [`FrameError`] if the frame does not match the methods.
    fn set(&mut self, frame: &RenderedFrame, candidate: &Candidate<'_>) -> Result<(), FrameError>;

    /// Runs a method on the current frame. `shade` shades chosen pixels, for frames that no simulator foveates.
    ///
    /// # Errors
    /// As for [`set`](Self::set).
    fn run(&mut self, run: usize, inputs: &RunInputs<'_>, shade: Shade<'_>) -> Result<MethodOutput, FrameError>;

    /// Bytes of history that a method keeps between frames.
    fn memory_bytes(&self, run: usize) -> usize;
}

/// Shades the pixels that a method chooses.
pub type Shade<'a> = &'a mut dyn FnMut(&ShadingRequest) -> Option<Shaded>;

/// The current frame, and the options of its processing.
pub struct RunInputs<'a> {
    /// The frame from its source.
    pub frame: &'a RenderedFrame,
    /// The foveated frame.
    pub candidate: &'a Candidate<'a>,
    /// Debug views to draw.
    pub debug: &'a [DebugView],
    /// Whether the methods get the source's trust mask.
    pub use_trust: bool,
    /// Pixel whose notes are taken, on the CPU.
    pub pixel: Option<[u32; 2]>,
}

impl RunInputs<'_> {
    /// A cut empties the history.
    pub fn reset(&self) -> Reset {
        if self.frame.reference.cut { Reset::All } else { Reset::None }
    }
}
