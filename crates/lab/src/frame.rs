//! Frames that sources produce and methods process. Frames on a device stay unchanged until their renderer renders the
//! next one.

pub use afterimage_eval::frame::{
    Content, DeviceContent, DeviceHandle, FoveatedFrame, QuadRequest, RenderedFrame, Shaded, ShadedColor, SourceFrame,
};

use crate::device::Headless;
use afterimage::{Image, Lattices};
use std::sync::Arc;

/// A foveated frame on a device: what [`Content::OnDevice`] holds.
#[derive(Clone, Debug)]
pub enum OnDevice {
    /// Samples alone, in an atlas.
    Atlas(SparseFrame),
    /// Samples at their pixels.
    Samples(DeviceSamples),
    /// Composed of quad views, at full size.
    Composed(ComposedFrame),
    /// Depth and motion of every pixel. The color has only pixels that were chosen and shaded later.
    Surfaces(DeviceFrame),
}

/// A frame of the rasterizer: the full-rate frame, an atlas of the samples of a sparse one, or surfaces whose pixels
/// are shaded later.
#[derive(Clone, Debug)]
pub struct DeviceFrame {
    /// The device.
    pub device: Arc<Headless>,
    /// Linear color.
    pub color: wgpu::Texture,
    /// Near plane over distance; 0 for pixels without a surface.
    pub depth: wgpu::Texture,
    /// Pixels, y down, previous minus current; `Rg32Float`.
    pub motion: wgpu::Texture,
    /// Distance of the near plane.
    pub near: f32,
}

/// The samples of a sparse frame at their pixels on a device. They stay until the path tracer traces the next frame.
/// Pixels between them are undefined.
#[derive(Clone, Debug)]
pub struct DeviceSamples {
    /// The device.
    pub device: Arc<Headless>,
    /// Linear radiance; `Rgba32Float`.
    pub color: wgpu::Texture,
    /// Noise, as in [`FoveatedFrame::noise`]; `Rg32Float`.
    pub noise: wgpu::Texture,
    /// Distance along the view axis in metres, infinity for the background; `R32Float`. Defined for
    /// [`Geometry::Samples`](crate::lattices::Geometry::Samples).
    pub depth: wgpu::Texture,
    /// Pixels, y down, previous minus current; `Rg32Float`. Defined where depth is.
    pub motion: wgpu::Texture,
    /// Where the samples lie.
    pub lattices: Lattices,
    /// Number of samples of each lattice.
    pub samples: Vec<u64>,
}

impl DeviceSamples {
    /// Textures for frames of `size` pixels.
    pub fn new(device: &Arc<Headless>, size: [u32; 2]) -> Self {
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
#[derive(Clone, Debug)]
pub struct SparseFrame {
    /// Atlases of color, depth and motion. Motion is in pixels of the full-rate frame.
    pub atlas: DeviceFrame,
    /// The lattices, and where they lie in the atlases.
    pub lattices: Lattices,
}

/// A frame composed of quad views, at full size. It stays on the device until the next one is composed.
#[derive(Clone, Debug)]
pub struct ComposedFrame {
    /// The device.
    pub device: Arc<Headless>,
    /// Linear color, `Rgba32Float`, finite.
    pub color: wgpu::Texture,
    /// Distance along the view axis, `R32Float`, of the nearest pixel of a view; infinity where that pixel shows no
    /// surface.
    pub distance: wgpu::Texture,
    /// Pixels, y down, previous minus current; `Rg32Float`. Of the nearest pixel of a view.
    pub motion: wgpu::Texture,
    /// Level of detail, `R32Float`.
    pub lod: wgpu::Texture,
}

/// Each waits for all submitted work.
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
