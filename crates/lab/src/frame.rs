//! Frames in memory: what sources hand out, what methods are given.

use afterimage::Image;

/// One full-rate frame with what a temporal method needs to know about it.
#[derive(Clone, Debug)]
pub struct SourceFrame {
    /// Linear Rec. 709 color, scene-referred. Non-finite pixels of the input are black here and counted below.
    pub color: Image<[f32; 3]>,
    /// Distance along the view axis; `f32::INFINITY` (or 1e10) where there is nothing. `None`: not known.
    pub depth: Option<Image<f32>>,
    /// Pixels, y down, previous minus current: `p` was at `p + motion`. `None`: nothing moves.
    pub motion: Option<Image<[f32; 2]>>,
    /// How far the past of each pixel may be believed (1 as usual, 0 not at all), where the source knows what moves without vectors.
    pub trust: Option<Image<f32>>,
    /// Takes a point from this frame's view space (x right, y down, z forward) to the previous frame's; row-major, for column
    /// vectors. `None`: the camera did not move, or its motion is not known.
    pub previous_from_current: Option<[[f32; 4]; 4]>,
    /// Nothing of the previous frame is valid here.
    pub cut: bool,
    /// Color pixels of the input that were NaN or infinite.
    pub nonfinite: u64,
}

/// A frame sampled by a plan and filled in.
#[derive(Clone, Debug)]
pub struct FoveatedFrame {
    /// Linear radiance.
    pub color: Image<[f32; 3]>,
    /// Level of detail, log2 of the distance of samples in pixels.
    pub lod: Image<f32>,
    /// Standard error of the color's luma, linear, and the samples that it is a mean of, at its level of detail.
    pub noise: Image<[f32; 2]>,
    /// Samples of each ring.
    pub samples: Vec<u64>,
    /// Rays of all kinds.
    pub rays: u64,
    /// Samples that were not finite and count as black.
    pub nonfinite: u64,
}

/// What is known of a frame before it is traced, at every pixel.
///
/// A number that makes no sense (NaN, below 0; an infinite deviation) says that nothing is known: no samples are held, the
/// deviation is the mean of the ring's known ones.
#[derive(Clone, Debug, PartialEq)]
pub struct Guide {
    /// Samples that the history holds of the surface seen now; 0: nothing, as behind what has moved away. Infinity: enough.
    pub known: Image<f32>,
    /// Standard deviation of one sample's luma. In any unit that is the same everywhere: errors in it are what gets small. 0:
    /// nothing to be gained.
    pub deviation: Image<f32>,
}

/// A full-rate frame on a device, as the rasterizer leaves it until it renders the next one.
#[cfg(feature = "full")]
#[derive(Clone, Debug)]
pub struct DeviceFrame {
    /// The device.
    pub device: std::sync::Arc<crate::device::Headless>,
    /// Linear color.
    pub color: wgpu::Texture,
    /// Near plane over distance; 0 where there is nothing.
    pub depth: wgpu::Texture,
    /// Pixels, y down, previous minus current; `Rg32Float`.
    pub motion: wgpu::Texture,
    /// Distance of the near plane.
    pub near: f32,
}
