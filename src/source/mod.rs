//! Where frames come from: stills, EXR sequences, analytic scenes. All hand out frames in one form.

pub mod analytic;

use crate::error::InputError;
use crate::image::Image;

/// One full-rate frame with what a temporal method needs to know about it.
#[derive(Clone, Debug)]
pub struct SourceFrame {
    /// Linear Rec. 709 colour, scene-referred. Non-finite pixels of the input are black here and counted below.
    pub color: Image<[f32; 3]>,
    /// Distance along the view axis; `f32::INFINITY` (or 1e10) where there is nothing. `None`: not known.
    pub depth: Option<Image<f32>>,
    /// Pixels, y down, previous minus current: `p` was at `p + motion`. `None`: nothing moves.
    pub motion: Option<Image<[f32; 2]>>,
    /// Takes a point from this frame's view space (x right, y down, z forward) to the previous frame's; row-major, for column
    /// vectors. `None`: the camera did not move, or its motion is not known.
    pub previous_from_current: Option<[[f32; 4]; 4]>,
    /// Nothing of the previous frame is valid here.
    pub cut: bool,
    /// Colour pixels of the input that were NaN or infinite.
    pub nonfinite: u64,
}

/// What is known about a source before its first frame is read.
#[derive(Clone, Debug, PartialEq)]
pub struct SourceInfo {
    /// As the user named it.
    pub name: String,
    /// Width and height of every frame in pixels.
    pub size: [u32; 2],
    /// Distinct frames; `None` for a source that never ends (analytic scenes).
    pub frames: Option<u64>,
    /// Frames per second, where the input says so.
    pub fps: Option<f32>,
    /// Horizontal field of view in degrees, where the input says so.
    pub hfov_deg: Option<f32>,
    /// The same picture for ever: nothing moves, and every pixel stays the same surface point.
    pub still: bool,
}

/// A stream of frames, by playback index.
///
/// A sequence shorter than the playback goes forwards and backwards (0, 1, ..., n-1, n-2, ..., 1, 0, 1, ...), with motion
/// vectors that follow. Memory does not grow with the number of frames.
pub trait FrameSource {
    /// Facts that hold for all frames.
    fn info(&self) -> &SourceInfo;

    /// The frame at playback position `index`. Positions may be asked for in any order; the vectors always refer to
    /// `index - 1`.
    ///
    /// # Errors
    /// If the file behind it cannot be read or is not what its header promised.
    fn frame(&mut self, index: u64) -> Result<SourceFrame, InputError>;
}
