//! What a caller asks a source for.

#[cfg(feature = "full")]
use crate::device::Headless;
use crate::frame::{Guide, RenderedFrame, SourceFrame};
use crate::lattices::SparseGeometry;
use crate::quad_views::QuadViews;
use afterimage::Lattices;
#[cfg(feature = "full")]
use std::sync::Arc;

/// A request of a frame. Sources without a renderer give the full-rate frame, whatever is asked for.
#[derive(Clone)]
pub struct FrameRequest<'a> {
    /// Playback position. Motion vectors refer to `index - 1`.
    pub index: u64,
    /// Where the frame is to be sharp, in pixels.
    pub gaze_px: [f32; 2],
    /// What is to be rendered. A source that has a sampling pattern of its own gives that instead.
    pub wanted: Wanted,
    /// Where depth and motion of a foveated frame are needed.
    pub geometry: SparseGeometry,
    /// Whether the full-rate frame is wanted in memory, as the reference of metrics.
    pub reference: bool,
    /// Guides adaptive sampling.
    pub guide: Option<&'a dyn SamplingGuide>,
    /// Device that all methods run on: what is rendered there can stay.
    #[cfg(feature = "full")]
    pub device: Option<Arc<Headless>>,
}

/// What is to be rendered.
#[derive(Clone, Debug, PartialEq)]
pub enum Wanted {
    /// The full-rate frame, which a simulator foveates.
    FullRate,
    /// The samples of these lattices.
    Lattices(Lattices),
    /// These quad views, composed.
    QuadViews(QuadViews),
}

/// Says how many samples a frame needs where, once its surfaces are known.
pub trait SamplingGuide {
    /// Guide for the frame whose full-rate depth and motion are those of `reference`; `None` if nothing is known.
    fn guide(&self, reference: &SourceFrame) -> Option<Guide>;
}

impl FrameRequest<'_> {
    /// A request of the full-rate frame at a playback position, in memory.
    pub fn full_rate(index: u64) -> Self {
        Self {
            index,
            gaze_px: [0.0; 2],
            wanted: Wanted::FullRate,
            geometry: SparseGeometry::Full,
            reference: true,
            guide: None,
            #[cfg(feature = "full")]
            device: None,
        }
    }

    /// The full-rate frame, rendered as asked for. What else was rendered is added to it.
    pub fn answer(&self, reference: SourceFrame) -> RenderedFrame {
        RenderedFrame { geometry: self.geometry, ..RenderedFrame::full_rate(self.index, self.gaze_px, reference) }
    }

    /// Whether the full-rate frame is rendered, too, when nobody wants it as a reference: as what a simulator foveates,
    /// or for depth and motion of every pixel.
    pub fn needs_full_rate(&self) -> bool {
        self.wanted == Wanted::FullRate || self.geometry == SparseGeometry::Full
    }
}
