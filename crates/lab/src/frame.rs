//! Frames that sources produce and methods process. Frames on a device stay unchanged until their renderer renders the
//! next one.

pub use afterimage_eval::frame::{
    Content, DeviceContent, DeviceHandle, FoveatedFrame, RenderedFrame, Shaded, ShadedColor, ShadingRequest,
    SourceFrame,
};

use crate::device::Headless;
use afterimage::Image;
use std::sync::Arc;

/// A foveated frame on a device: what [`Content::OnDevice`] holds.
#[derive(Clone, Debug)]
pub enum OnDevice {
    /// Composed of quad views, at full size.
    Composed(ComposedFrame),
    /// Depth and motion of every pixel. The color has only pixels that were chosen and shaded later.
    Surfaces(DeviceFrame),
}

/// A frame of the rasterizer: the full-rate frame, or surfaces whose pixels are shaded later.
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
