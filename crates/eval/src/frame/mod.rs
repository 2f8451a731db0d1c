//! Frames that sources produce and methods process, in memory or on a device.

mod rendered;
mod shading;

pub use rendered::{Content, DeviceContent, DeviceHandle, RenderedFrame};
pub use shading::{Shaded, ShadedColor, ShadingRequest};

use afterimage::Image;

/// A full-rate frame with the auxiliary images of a temporal method.
#[derive(Clone, Debug)]
pub struct SourceFrame {
    /// Linear Rec. 709 color, scene-referred. Non-finite pixels of the input are black here and counted below. It is
    /// empty if no reference was requested ([`without_images`](Self::without_images)).
    pub color: Image<[f32; 3]>,
    /// Depth along the view axis; `f32::INFINITY` (or 1e10) for the background. `None`: not known.
    pub depth: Option<Image<f32>>,
    /// Motion vectors in pixels, y down, previous minus current: `p` was at `p + motion`. `None`: nothing moves.
    pub motion: Option<Image<[f32; 2]>>,
    /// History confidence of each pixel, about 1 - FSR2's reactive mask: 1 reuses history as usual, 0 rejects it.
    /// `Some` if the source has content that moves without motion vectors.
    pub trust: Option<Image<f32>>,
    /// Matrix from this frame's view space (x right, y down, z forward) to the previous frame's; row-major, for column
    /// vectors. `None`: the camera did not move, or its motion is not known.
    pub previous_from_current: Option<[[f32; 4]; 4]>,
    /// Camera cut: no history is valid.
    pub cut: bool,
    /// Color pixels of the input that were NaN or infinite.
    pub nonfinite: u64,
}

impl SourceFrame {
    /// A frame without images, for methods that get all images from a device.
    pub fn without_images(previous_from_current: Option<[[f32; 4]; 4]>, cut: bool) -> Self {
        let color = Image::filled([0; 2], [0.0; 3]);
        Self { color, depth: None, motion: None, trust: None, previous_from_current, cut, nonfinite: 0 }
    }
}

/// A foveated frame, sampled sparsely by a sampling plan and reconstructed at every pixel.
#[derive(Clone, Debug)]
pub struct FoveatedFrame {
    /// Linear radiance.
    pub color: Image<[f32; 3]>,
    /// Level of detail: log2 of the sample spacing in pixels.
    pub lod: Image<f32>,
    /// Noise of the color at its level of detail: standard error of its luma (linear), and number of samples averaged.
    /// `None`: the methods get no noise input.
    pub noise: Option<Image<[f32; 2]>>,
    /// Number of samples in each ring.
    pub samples: Vec<u64>,
    /// Number of rays of all kinds.
    pub rays: u64,
    /// Number of samples that were not finite and count as black.
    pub nonfinite: u64,
}
