//! The one shape in which a frame goes from its source to the methods.

#[cfg(feature = "full")]
use super::{DeviceFrame, OnDevice};
use super::{FoveatedFrame, SourceFrame};
use crate::clock::Elapsed;
use crate::lattices::SparseGeometry;
use afterimage::Lattices;

/// A frame as its source gives it: what the methods get, and the full-rate frame that metrics compare it with.
#[derive(Clone, Debug)]
pub struct RenderedFrame {
    /// Playback position.
    pub index: u64,
    /// Gaze that it was rendered for, in pixels.
    pub gaze_px: [f32; 2],
    /// The full-rate frame. Its images are missing if they were not asked for and no method needs them.
    pub reference: SourceFrame,
    /// The full-rate frame on a device, where it was rendered there.
    #[cfg(feature = "full")]
    pub reference_on_device: Option<DeviceFrame>,
    /// What the methods get.
    pub content: Content,
    /// Where depth and motion are defined. At the samples of what is on a device: the methods get those in place of
    /// the reference's.
    pub geometry: SparseGeometry,
    /// Number of camera samples of the content; `None` if it is the full-rate frame.
    pub samples: Option<u64>,
    /// Time of rendering the content until it was complete on its device: posing the scene, recording and drawing or
    /// tracing, without reading back. `None` if the source renders nothing.
    pub render: Option<Elapsed>,
    /// Time of rendering the full-rate frame with as many samples a pixel, if it was.
    pub full_rate: Option<Elapsed>,
}

/// The part of a frame that methods get.
#[derive(Clone, Debug)]
#[allow(clippy::large_enum_variant, reason = "there is one a frame")]
pub enum Content {
    /// The full-rate frame: a simulator foveates it.
    FullRate,
    /// A frame that its source foveated, in memory.
    Foveated(FoveatedFrame),
    /// A frame that its source foveated, on a device.
    #[cfg(feature = "full")]
    OnDevice(OnDevice),
}

impl Content {
    /// Where the samples lie, if the source gave them without anything between.
    pub fn lattices(&self) -> Option<Lattices> {
        match self {
            Self::FullRate => None,
            Self::Foveated(frame) => frame.lattices,
            #[cfg(feature = "full")]
            Self::OnDevice(OnDevice::Atlas(frame)) => Some(frame.lattices),
            #[cfg(feature = "full")]
            Self::OnDevice(OnDevice::Samples(frame)) => Some(frame.lattices),
            #[cfg(feature = "full")]
            Self::OnDevice(OnDevice::Composed(_)) => None,
        }
    }

    /// Whether a path tracer foveated the frame.
    pub fn is_traced(&self) -> bool {
        match self {
            Self::FullRate => false,
            Self::Foveated(_) => true,
            #[cfg(feature = "full")]
            Self::OnDevice(content) => matches!(content, OnDevice::Samples(_)),
        }
    }
}

impl RenderedFrame {
    /// A full-rate frame that took no time to render.
    pub fn full_rate(index: u64, gaze_px: [f32; 2], reference: SourceFrame) -> Self {
        Self {
            index,
            gaze_px,
            reference,
            #[cfg(feature = "full")]
            reference_on_device: None,
            content: Content::FullRate,
            geometry: SparseGeometry::Full,
            samples: None,
            render: None,
            full_rate: None,
        }
    }

    /// The same frame, foveated by its source.
    #[must_use]
    pub fn foveated(self, frame: FoveatedFrame) -> Self {
        let samples = Some(frame.samples.iter().sum());
        Self { content: Content::Foveated(frame), samples, ..self }
    }
}
