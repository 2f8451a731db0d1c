//! Rendered frames: the type by which a source passes a frame to the methods.

use super::{FoveatedFrame, SourceFrame};
use crate::clock::Elapsed;
use crate::quad_views::Geometry;
use afterimage::Image;
use std::any::Any;
use std::fmt::Debug;
use std::sync::Arc;

/// A graphics device, or an object on one, for code that knows its type.
pub type DeviceHandle = Arc<dyn Any + Send + Sync>;

/// A frame from its source: the content for the methods, and the full-rate frame that metrics compare with.
#[derive(Clone, Debug)]
pub struct RenderedFrame {
    /// Playback position.
    pub index: u64,
    /// Gaze that it was rendered for, in pixels.
    pub gaze_px: [f32; 2],
    /// The full-rate frame. Its images are missing if they were not requested and no method needs them.
    pub reference: SourceFrame,
    /// The full-rate frame on a device, where it was rendered there.
    pub reference_on_device: Option<DeviceHandle>,
    /// Content for the methods.
    pub content: Content,
    /// Albedo of every pixel of the content, linear, if it was requested and the source has it.
    pub albedo: Option<Image<[f32; 3]>>,
    /// Jitter of the content's projection in pixels, as in
    /// [`FrameRequest::jitter_px`](crate::source::FrameRequest::jitter_px); 0 without jitter.
    pub jitter_px: [f32; 2],
    /// Where depth and motion of quad views are defined. The methods get the views' own instead of the reference's if
    /// they are defined there alone.
    pub geometry: Geometry,
    /// Number of camera samples of the content; `None` if it is the full-rate frame.
    pub samples: Option<u64>,
    /// Time of rendering the content until it was complete on its device: posing the scene, recording and drawing or
    /// tracing, without reading back. `None` if the source does not render.
    pub render: Option<Elapsed>,
    /// Time of rendering the full-rate frame with as many samples a pixel, if it was rendered.
    pub full_rate: Option<Elapsed>,
}

/// The part of a frame that methods get.
#[derive(Clone, Debug)]
#[allow(clippy::large_enum_variant, reason = "there is one a frame")]
pub enum Content {
    /// The full-rate frame: a simulator foveates it.
    FullRate,
    /// The full-rate frame with jitter and one sample a pixel: a simulator foveates it in place of the reference.
    Jittered(SourceFrame),
    /// A frame that its source foveated, in memory.
    Foveated(FoveatedFrame),
    /// Depth and motion of every pixel, those of the full-rate frame, in memory. The pixels that methods choose are
    /// shaded later.
    Surfaces,
    /// A frame that its source foveated, on a device.
    OnDevice(Arc<dyn DeviceContent>),
}

/// Interface of a pipeline to a foveated frame on a device. Reading waits for all submitted work.
pub trait DeviceContent: Any + Debug + Send + Sync {
    /// Level of detail of every pixel. `None`: the pixels that methods choose are shaded later,
    /// and depth and motion of every pixel are those of this content.
    fn lods(&self) -> Option<Image<f32>>;

    /// Reads the color, which is empty before pixels are shaded; `None` if it stays on the device.
    fn read_color(&self) -> Option<Image<[f32; 3]>>;

    /// Reads depth and motion vectors; `None` if they stay on the device.
    fn read_geometry(&self) -> Option<(Image<f32>, Image<[f32; 2]>)>;
}

impl Content {
    /// Whether a path tracer foveated the frame.
    pub fn is_traced(&self) -> bool {
        matches!(self, Self::Foveated(_))
    }
}

impl RenderedFrame {
    /// Whether every pixel of the frame is at full rate, so that a simulator foveates it.
    pub fn is_simulated(&self) -> bool {
        matches!(self.content, Content::FullRate | Content::Jittered(_))
    }

    /// A full-rate frame that took no time to render.
    pub fn full_rate(index: u64, gaze_px: [f32; 2], reference: SourceFrame) -> Self {
        Self {
            index,
            gaze_px,
            reference,
            reference_on_device: None,
            content: Content::FullRate,
            albedo: None,
            jitter_px: [0.0; 2],
            geometry: Geometry::Full,
            samples: None,
            render: None,
            full_rate: None,
        }
    }

    /// The full-rate frame. Simulators foveate it, and the methods get its depth, motion and trust.
    pub fn given(&self) -> &SourceFrame {
        match &self.content {
            Content::Jittered(frame) => frame,
            _ => &self.reference,
        }
    }

    /// The same frame, with one sample a pixel in `frame`, which is jittered by `jitter_px`.
    #[must_use]
    pub fn jittered(self, frame: SourceFrame, jitter_px: [f32; 2]) -> Self {
        Self { content: Content::Jittered(frame), jitter_px, ..self }
    }

    /// The same frame, foveated by its source.
    #[must_use]
    pub fn foveated(self, frame: FoveatedFrame) -> Self {
        let samples = Some(frame.samples.iter().sum());
        Self { content: Content::Foveated(frame), samples, ..self }
    }
}
