//! Requests of callers to a source.

use crate::frame::{DeviceHandle, RenderedFrame, SourceFrame};
use crate::quad_views::{Geometry, QuadViews};

/// A request of a frame. Sources without a renderer give the full-rate frame for every request.
#[derive(Clone)]
pub struct FrameRequest {
    /// Playback position. Motion vectors refer to `index - 1`.
    pub index: u64,
    /// Gaze in pixels, around which the frame should be sharp.
    pub gaze_px: [f32; 2],
    /// Content to render. A source with its own sampling pattern uses that pattern instead.
    pub wanted: Wanted,
    /// Jitter of the projection in pixels: a point at `p` without jitter is at `p + jitter_px`. Each pixel then has one
    /// sample. `None`: no jitter, and pixels at full rate as the source filters them.
    pub jitter_px: Option<[f32; 2]>,
    /// Where depth and motion of a foveated frame are needed.
    pub geometry: Geometry,
    /// Whether the albedo of every pixel is wanted. Sources that do not know it ignore this.
    pub albedo: bool,
    /// Whether the full-rate frame is wanted in memory, as the reference of metrics.
    pub reference: bool,
    /// Samples a pixel of the reference: the mean of that many jittered full-rate frames. `None`: as the source filters
    /// pixels. Files of frames, and path tracers, ignore this and use their own number.
    pub reference_samples: Option<u32>,
    /// Device on which all methods run. Frames that are rendered there need not be read back.
    pub device: Option<DeviceHandle>,
}

/// Content to render.
#[derive(Clone, Debug, PartialEq)]
pub enum Wanted {
    /// The full-rate frame, which a simulator foveates.
    FullRate,
    /// These quad views, composed.
    QuadViews(QuadViews),
    /// Depth and motion of every pixel. The pixels that a method chooses are shaded then
    /// ([`FrameSource::shade`](super::FrameSource::shade)).
    Surfaces,
}

impl FrameRequest {
    /// A request of the full-rate frame at a playback position, in memory.
    pub fn full_rate(index: u64) -> Self {
        Self {
            index,
            gaze_px: [0.0; 2],
            wanted: Wanted::FullRate,
            jitter_px: None,
            geometry: Geometry::Full,
            albedo: false,
            reference: true,
            reference_samples: None,
            device: None,
        }
    }

    /// Answer with the full-rate frame, to which the source adds other rendered content.
    pub fn answer(&self, reference: SourceFrame) -> RenderedFrame {
        RenderedFrame { geometry: self.geometry, ..RenderedFrame::full_rate(self.index, self.gaze_px, reference) }
    }

    /// Whether the full-rate frame must be rendered even if it is not requested as a reference: as input of a
    /// simulator, or for depth and motion of every pixel.
    pub fn needs_full_rate(&self) -> bool {
        match self.wanted {
            Wanted::FullRate => true,
            Wanted::QuadViews(_) => self.geometry == Geometry::Full,
            Wanted::Surfaces => false,
        }
    }
}
