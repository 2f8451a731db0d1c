//! Frames in memory: the output of sources and the input of methods.

use afterimage::{Image, Lattices};

/// A full-rate frame with the auxiliary images of a temporal method.
#[derive(Clone, Debug)]
pub struct SourceFrame {
    /// Linear Rec. 709 color, scene-referred. Non-finite pixels of the input are black here and counted below.
    pub color: Image<[f32; 3]>,
    /// Depth along the view axis; `f32::INFINITY` (or 1e10) for the background. `None`: not known.
    pub depth: Option<Image<f32>>,
    /// Motion vectors in pixels, y down, previous minus current: `p` was at `p + motion`. `None`: nothing moves.
    pub motion: Option<Image<[f32; 2]>>,
    /// History confidence of each pixel, about 1 - FSR2's reactive mask: 1 reuses history as usual, 0 rejects it.
    /// `Some` where the source knows content that moves without motion vectors.
    pub trust: Option<Image<f32>>,
    /// Matrix from this frame's view space (x right, y down, z forward) to the previous frame's; row-major, for column
    /// vectors. `None`: the camera did not move, or its motion is not known.
    pub previous_from_current: Option<[[f32; 4]; 4]>,
    /// Camera cut: no history is valid.
    pub cut: bool,
    /// Color pixels of the input that were NaN or infinite.
    pub nonfinite: u64,
}

/// A foveated frame: sampled sparsely by a sampling plan, then reconstructed at every pixel, or given with its samples'
/// places.
#[derive(Clone, Debug)]
pub struct FoveatedFrame {
    /// Linear radiance.
    pub color: Image<[f32; 3]>,
    /// Level of detail: log2 of the sample spacing in pixels.
    pub lod: Image<f32>,
    /// Noise of the color at its level of detail: standard error of its luma (linear), and number of samples averaged.
    pub noise: Image<[f32; 2]>,
    /// Where the samples lie, if the frame is not reconstructed between them: only they have a color.
    pub lattices: Option<Lattices>,
    /// Number of samples in each ring.
    pub samples: Vec<u64>,
    /// Number of rays of all kinds.
    pub rays: u64,
    /// Number of samples that were not finite and count as black.
    pub nonfinite: u64,
}

/// Per-pixel guide for adaptive sampling, known before the frame is traced.
///
/// An invalid number (NaN, negative, or an infinite deviation) counts as unknown: 0 samples in the history, and the
/// mean of the ring's valid deviations.
#[derive(Clone, Debug, PartialEq)]
pub struct Guide {
    /// Number of samples that the history holds of the visible surface. 0: none, as at a disocclusion. Infinity: no
    /// more needed.
    pub known: Image<f32>,
    /// Standard deviation of one sample's luma, in any unit common to all pixels: sampling minimizes the error in that
    /// unit. 0: more samples gain nothing.
    pub deviation: Image<f32>,
}

/// A frame on a device, as the rasterizer leaves it until it renders the next one: the full-rate frame, or an atlas of
/// the samples of a sparse one.
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

/// The samples of a sparse frame at their pixels on a device, as the path tracer leaves them until it traces the next
/// frame. Nothing is defined between them.
#[cfg(feature = "full")]
#[derive(Clone, Debug)]
pub struct DeviceSamples {
    /// The device.
    pub device: std::sync::Arc<crate::device::Headless>,
    /// Linear radiance; `Rgba32Float`.
    pub color: wgpu::Texture,
    /// Noise, as in [`FoveatedFrame::noise`]; `Rg32Float`.
    pub noise: wgpu::Texture,
    /// Distance along the view axis in metres, infinity for the background; `R32Float`. Defined for
    /// [`SparseGeometry::Samples`](crate::lattices::SparseGeometry::Samples).
    pub depth: wgpu::Texture,
    /// Pixels, y down, previous minus current; `Rg32Float`. Defined where depth is.
    pub motion: wgpu::Texture,
    /// Where the samples lie.
    pub lattices: Lattices,
    /// Number of samples of each lattice.
    pub samples: Vec<u64>,
}

#[cfg(feature = "full")]
impl DeviceSamples {
    /// Textures for frames of `size` pixels.
    pub fn new(device: &std::sync::Arc<crate::device::Headless>, size: [u32; 2]) -> Self {
        use wgpu::{TextureFormat, TextureUsages};
        let usage = TextureUsages::TEXTURE_BINDING | TextureUsages::STORAGE_BINDING | TextureUsages::COPY_SRC;
        let texture = |format| device.texture(size, 1, format, usage | TextureUsages::COPY_DST);
        Self {
            color: texture(TextureFormat::Rgba32Float),
            noise: texture(TextureFormat::Rg32Float),
            depth: texture(TextureFormat::R32Float),
            motion: texture(TextureFormat::Rg32Float),
            lattices: Lattices::default(),
            samples: vec![],
            device: device.clone(),
        }
    }
}

/// The samples of a sparse frame, rendered alone: each lattice as a small view of its own.
#[cfg(feature = "full")]
#[derive(Clone, Debug)]
pub struct SparseFrame {
    /// Atlases of color, depth and motion. Motion is in pixels of the full-rate frame.
    pub atlas: DeviceFrame,
    /// The lattices, and where they lie in the atlases.
    pub lattices: afterimage::Lattices,
}

/// A frame composed of quad views, at full size. It stays on the device until the next one is composed.
#[cfg(feature = "full")]
#[derive(Clone, Debug)]
pub struct ComposedFrame {
    /// The device.
    pub device: std::sync::Arc<crate::device::Headless>,
    /// Linear color, `Rgba32Float`, finite.
    pub color: wgpu::Texture,
    /// Distance along the view axis, `R32Float`; infinity where there is nothing. Of the nearest pixel of a view.
    pub distance: wgpu::Texture,
    /// Pixels, y down, previous minus current; `Rg32Float`. Of the nearest pixel of a view.
    pub motion: wgpu::Texture,
    /// Level of detail, `R32Float`.
    pub lod: wgpu::Texture,
}

/// Each waits for all submitted work.
#[cfg(feature = "full")]
impl ComposedFrame {
    /// Reads the color.
    pub fn read_color(&self) -> Image<[f32; 3]> {
        self.device.read_rgb(&self.color, 0)
    }

    /// Reads the distance in metres.
    pub fn read_distance(&self) -> Image<f32> {
        self.device.read(&self.distance, 0)
    }

    /// Reads the motion vectors in pixels.
    pub fn read_motion(&self) -> Image<[f32; 2]> {
        self.device.read(&self.motion, 0)
    }

    /// Reads the levels of detail.
    pub fn read_lod(&self) -> Image<f32> {
        self.device.read(&self.lod, 0)
    }
}
