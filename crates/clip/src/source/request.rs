//! What a caller asks a source for.

use crate::frame::{DeviceHandle, RenderedFrame, SourceFrame};
use crate::lattices::SparseGeometry;
use crate::quad_views::QuadViews;
use afterimage::Lattices;

/// A request of a frame. Sources without a renderer give the full-rate frame, whatever is asked for.
#[derive(Clone)]
pub struct FrameRequest {
    /// Playback position. Motion vectors refer to `index - 1`.
    pub index: u64,
    /// Where the frame is to be sharp, in pixels.
    pub gaze_px: [f32; 2],
    /// What is to be rendered. A source that has a sampling pattern of its own gives that instead.
    pub wanted: Wanted,
    /// Jitter of the projection in pixels: what is at `p` without it is at `p + jitter_px`. Each pixel or point of a
    /// lattice then has one sample. `None`: no jitter, and pixels at full rate as the source filters them.
    pub jitter_px: Option<[f32; 2]>,
    /// Where depth and motion of a foveated frame are needed.
    pub geometry: SparseGeometry,
    /// Whether the full-rate frame is wanted in memory, as the reference of metrics.
    pub reference: bool,
    /// Samples a pixel of the reference: the mean of that many jittered full-rate frames. `None`: as the source filters
    /// pixels. Sources without a renderer, and path tracers, have theirs anyway.
    pub reference_samples: Option<u32>,
    /// Device that all methods run on: what is rendered there can stay.
    pub device: Option<DeviceHandle>,
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

impl FrameRequest {
    /// A request of the full-rate frame at a playback position, in memory.
    pub fn full_rate(index: u64) -> Self {
        Self {
            index,
            gaze_px: [0.0; 2],
            wanted: Wanted::FullRate,
            jitter_px: None,
            geometry: SparseGeometry::Full,
            reference: true,
            reference_samples: None,
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
