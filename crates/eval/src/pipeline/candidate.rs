//! The foveated frame, as input of a pipeline's methods.

use afterimage::Image;
use afterimage::internal::{FoveationKind, Pyramid, ViewFrame};
use std::borrow::Cow;

/// A foveated frame.
pub struct Candidate<'a> {
    /// Geometry and gaze.
    pub view: ViewFrame,
    /// Level of detail of every pixel.
    pub lods: Image<f32>,
    /// The frame in memory, if a method reads it there.
    pub in_memory: Option<InMemory<'a>>,
    /// Mip chain of a simulated frame, if it is in memory.
    pub pyramid: Option<Pyramid>,
}

/// A foveated frame in memory.
pub struct InMemory<'a> {
    /// Linear color.
    pub color: Cow<'a, Image<[f32; 3]>>,
    /// Whether the levels of detail are an input of the methods.
    pub has_lod: bool,
    /// Noise of the color, as in [`FoveatedFrame::noise`](crate::frame::FoveatedFrame::noise).
    pub noise: Option<&'a Image<[f32; 2]>>,
    /// Depth and motion of the samples, where they replace those of the full-rate frame.
    pub geometry: Option<(Image<f32>, Image<[f32; 2]>)>,
}

impl<'a> InMemory<'a> {
    /// A frame with this color and no other inputs.
    pub fn new(color: Cow<'a, Image<[f32; 3]>>) -> Self {
        Self { color, has_lod: false, noise: None, geometry: None }
    }
}

/// Whether methods need the levels of detail of a simulated frame as an input. `FoveationKind::Block` evaluates the
/// level at the center of a block, which a method cannot derive from the gaze.
pub fn needs_lod(filter: FoveationKind) -> bool {
    filter == FoveationKind::Block
}
