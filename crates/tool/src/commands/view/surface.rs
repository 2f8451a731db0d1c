//! The window's surface: configured, lost, found again.

use super::device::Device;
use crate::failure::Failure;
use std::sync::Arc;
use wgpu::{CurrentSurfaceTexture, PresentMode, SurfaceConfiguration, SurfaceTexture, TextureFormat};
use winit::window::Window;

/// What there is to draw to.
pub enum Acquired {
    Frame(SurfaceTexture),
    /// Nothing this time.
    Nothing,
    /// The surface was made anew: what it showed is gone.
    Renewed,
}

/// A configured surface.
pub struct Surface {
    config: SurfaceConfiguration,
}

impl Surface {
    /// For a window of `size`.
    pub fn new(device: &Device, size: [u32; 2]) -> Result<Self, Failure> {
        let caps = &device.capabilities;
        // Formats that encode by themselves spare the shader a third of its time on a software device.
        let encoding = [TextureFormat::Bgra8UnormSrgb, TextureFormat::Rgba8UnormSrgb];
        let format = encoding.iter().chain(&caps.formats).find(|f| caps.formats.contains(f)).copied();
        let format = format.ok_or_else(|| Failure::Work("the window takes no format that can be drawn".into()))?;
        // A software device never keeps up with the screen: waiting for it would only cost frames.
        let wanted: &[PresentMode] =
            if device.gpu.is_software() { &[PresentMode::Immediate, PresentMode::Mailbox] } else { &[] };
        let present_mode = wanted.iter().find(|m| caps.present_modes.contains(m)).copied().unwrap_or(PresentMode::Fifo);
        let config = SurfaceConfiguration {
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
            format,
            color_space: wgpu::SurfaceColorSpace::Auto,
            width: size[0].max(1),
            height: size[1].max(1),
            present_mode,
            // No frame waits behind another: the picture is of the latest gaze.
            desired_maximum_frame_latency: 1,
            alpha_mode: wgpu::CompositeAlphaMode::Auto,
            view_formats: vec![],
        };
        device.surface.configure(&device.gpu.device, &config);
        Ok(Self { config })
    }

    /// Pixels.
    pub fn size(&self) -> [u32; 2] {
        [self.config.width, self.config.height]
    }

    /// What is drawn to.
    pub fn format(&self) -> TextureFormat {
        self.config.format
    }

    /// Follows the window.
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
            // Counted by the device.
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
