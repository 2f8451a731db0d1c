//! The window's surface: configuration, resizing, recovery after a loss.

use super::device::Device;
use crate::failure::Failure;
use afterimage::wgpu::{self, CurrentSurfaceTexture, PresentMode, SurfaceConfiguration, SurfaceTexture, TextureFormat};
use std::sync::Arc;
use winit::window::Window;

/// Result of acquiring a surface texture.
pub enum Acquired {
    Frame(SurfaceTexture),
    /// No texture in this frame.
    Nothing,
    /// The surface was configured again: its contents are lost.
    Renewed,
}

/// A configured surface.
pub struct Surface {
    config: SurfaceConfiguration,
}

impl Surface {
    /// Configures the surface for a window of `size`.
    pub fn new(device: &Device, size: [u32; 2]) -> Result<Self, Failure> {
        let caps = &device.capabilities;
        // sRGB formats encode in hardware, which saves the shader a third of its time on a software device.
        let srgb = [TextureFormat::Bgra8UnormSrgb, TextureFormat::Rgba8UnormSrgb];
        let format = srgb.iter().chain(&caps.formats).find(|f| caps.formats.contains(f)).copied();
        let format =
            format.ok_or_else(|| Failure::Work("the window supports no texture format that can be drawn to".into()))?;
        // A software device is slower than the screen: waiting for vertical sync would only cost frames.
        let preferred: &[PresentMode] =
            if device.gpu.is_software() { &[PresentMode::Immediate, PresentMode::Mailbox] } else { &[] };
        let present_mode =
            preferred.iter().find(|m| caps.present_modes.contains(m)).copied().unwrap_or(PresentMode::Fifo);
        let config = SurfaceConfiguration {
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
            format,
            color_space: wgpu::SurfaceColorSpace::Auto,
            width: size[0].max(1),
            height: size[1].max(1),
            present_mode,
            // No queued frames: the picture uses the latest gaze.
            desired_maximum_frame_latency: 1,
            alpha_mode: wgpu::CompositeAlphaMode::Auto,
            view_formats: vec![],
        };
        device.surface.configure(&device.gpu.device, &config);
        Ok(Self { config })
    }

    /// Size in pixels.
    pub fn size(&self) -> [u32; 2] {
        [self.config.width, self.config.height]
    }

    /// Texture format.
    pub fn format(&self) -> TextureFormat {
        self.config.format
    }

    /// Configures the surface for the window's new size.
    pub fn resize(&mut self, device: &Device, [width, height]: [u32; 2]) {
        (self.config.width, self.config.height) = (width.max(1), height.max(1));
        device.surface.configure(&device.gpu.device, &self.config);
    }

    /// The texture of the next frame.
    pub fn acquire(&mut self, device: &mut Device, window: &Arc<Window>) -> Result<Acquired, Failure> {
        match device.surface.get_current_texture() {
            CurrentSurfaceTexture::Success(frame) | CurrentSurfaceTexture::Suboptimal(frame) => {
                return Ok(Acquired::Frame(frame));
            }
            CurrentSurfaceTexture::Timeout | CurrentSurfaceTexture::Occluded => return Ok(Acquired::Nothing),
            // The device's error handler counts validation errors.
            CurrentSurfaceTexture::Validation => return Ok(Acquired::Nothing),
            CurrentSurfaceTexture::Outdated => {}
            CurrentSurfaceTexture::Lost => {
                if device.is_lost() {
                    return Ok(Acquired::Nothing);
                }
                device.renew_surface(window)?;
            }
        }
        let size = window.inner_size();
        self.resize(device, [size.width, size.height]);
        Ok(Acquired::Renewed)
    }
}
