//! Render targets, and reading them back.

use super::pipelines::{COLOR_FORMAT, DEPTH_FORMAT, MOTION_FORMAT, SAMPLES};
use crate::device::{Headless, texture_desc};
use afterimage::Image;
use afterimage::kernel::pack::half_value;
use std::cell::OnceCell;
use wgpu::{Device, Texture, TextureFormat, TextureUsages, TextureView};

/// Formats of the G-buffer besides depth and motion: base color and metalness; words (`shaders/raster/g_buffer.wgsl`).
pub(super) const KEPT_FORMATS: [TextureFormat; 2] = [TextureFormat::Rgba8Unorm, TextureFormat::Rgba32Uint];

/// Textures of a frame. They can be bound by later passes and copied.
#[derive(Debug)]
pub struct Targets {
    /// Linear color.
    pub color: Texture,
    /// Near plane divided by distance; 0 for pixels without a surface.
    pub depth: Texture,
    /// Motion in pixels, y down, previous minus current.
    pub motion: Texture,
    pub(super) views: [TextureView; 3],
    /// Multisampled color and depth.
    pub(super) samples: [TextureView; 2],
}

impl Targets {
    pub(super) fn new(device: &Device, size: [u32; 2]) -> Self {
        let [color, depth, motion] =
            [COLOR_FORMAT, DEPTH_FORMAT, MOTION_FORMAT].map(|format| attachment(device, size, format, 1));
        let view = |t: &Texture| t.create_view(&Default::default());
        let views = [&color, &depth, &motion].map(view);
        let samples = [COLOR_FORMAT, DEPTH_FORMAT].map(|format| view(&attachment(device, size, format, SAMPLES)));
        Self { color, depth, motion, views, samples }
    }

    /// Waits for all submitted work, then reads the color.
    pub fn read_color(&self, device: &Headless) -> Image<[f32; 3]> {
        read_color(device, &self.color)
    }

    /// Waits for all submitted work, then reads distance along the view axis in metres; infinity for pixels without a
    /// surface. `near` is [`Raster::near`](super::Raster::near).
    pub fn read_distance(&self, device: &Headless, near: f32) -> Image<f32> {
        read_distance(device, &self.depth, near)
    }

    /// Waits for all submitted work, then reads the motion vectors.
    pub fn read_motion(&self, device: &Headless) -> Image<[f32; 2]> {
        device.read::<[f32; 2]>(&self.motion, 0)
    }
}

/// Reads a texture of [`COLOR_FORMAT`].
pub(crate) fn read_color(device: &Headless, texture: &Texture) -> Image<[f32; 3]> {
    device.read::<[u16; 4]>(texture, 0).map(|[r, g, b, _]| [r, g, b].map(|v| half_value(u32::from(v))))
}

/// Reads a texture of [`DEPTH_FORMAT`] as distances.
pub(crate) fn read_distance(device: &Headless, texture: &Texture, near: f32) -> Image<f32> {
    device.read::<f32>(texture, 0).map(|d| if d > 0.0 { near / d } else { f32::INFINITY })
}

/// Textures of a foveated frame.
#[derive(Debug)]
pub struct FoveatedTargets {
    /// Atlases of color, depth and motion. Motion is in pixels of the full-rate frame.
    pub atlas: Targets,
    /// Depth of color with one sample per pixel; in deferred frames that have blended surfaces, of the opaque ones.
    pub(super) point_depth: Texture,
    pub(super) point_depth_view: TextureView,
    kept: OnceCell<[TextureView; 2]>,
    closed_depth: OnceCell<TextureView>,
    albedo: OnceCell<(Texture, TextureView)>,
}

impl FoveatedTargets {
    /// Targets for atlases of at most `size` texels.
    pub fn new(device: &Device, size: [u32; 2]) -> Self {
        let point_depth = attachment(device, size, DEPTH_FORMAT, 1);
        let point_depth_view = point_depth.create_view(&Default::default());
        let atlas = Targets::new(device, size);
        let (kept, closed_depth, albedo) = (OnceCell::new(), OnceCell::new(), OnceCell::new());
        Self { atlas, point_depth, point_depth_view, kept, closed_depth, albedo }
    }

    /// Texture of albedo, of the format of color.
    pub fn albedo(&self, device: &Device) -> &Texture {
        &self.albedo_target(device).0
    }

    pub(super) fn albedo_view(&self, device: &Device) -> &TextureView {
        &self.albedo_target(device).1
    }

    fn albedo_target(&self, device: &Device) -> &(Texture, TextureView) {
        self.albedo.get_or_init(|| {
            let texture = attachment(device, [self.atlas.color.width(), self.atlas.color.height()], COLOR_FORMAT, 1);
            let view = texture.create_view(&Default::default());
            (texture, view)
        })
    }

    fn attachment_view(&self, device: &Device, format: TextureFormat) -> TextureView {
        let size = [self.atlas.color.width(), self.atlas.color.height()];
        attachment(device, size, format, 1).create_view(&Default::default())
    }

    /// Base colors and words of the G-buffer, which has depth and motion of the atlas.
    pub(super) fn kept(&self, device: &Device) -> &[TextureView; 2] {
        self.kept.get_or_init(|| KEPT_FORMATS.map(|format| self.attachment_view(device, format)))
    }

    /// Depth of the opaque surfaces in chosen quads, and of the near plane elsewhere.
    pub(super) fn closed_depth(&self, device: &Device) -> &TextureView {
        self.closed_depth.get_or_init(|| self.attachment_view(device, DEPTH_FORMAT))
    }

    /// Replaces the targets by larger ones if an atlas of `size` texels does not fit.
    pub fn fit(&mut self, device: &Device, size: [u32; 2]) {
        let held = [self.atlas.color.width(), self.atlas.color.height()];
        if (0..2).any(|i| size[i] > held[i]) {
            *self = Self::new(device, [0, 1].map(|i| size[i].max(held[i])));
        }
    }
}

/// A render target. With one sample, it can also be bound and copied, and color be written by compute passes.
pub(super) fn attachment(device: &Device, size: [u32; 2], format: TextureFormat, samples: u32) -> Texture {
    let stored = if format == COLOR_FORMAT { TextureUsages::STORAGE_BINDING } else { TextureUsages::empty() };
    let one = TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_SRC | TextureUsages::COPY_DST | stored;
    let usage = TextureUsages::RENDER_ATTACHMENT | if samples == 1 { one } else { TextureUsages::empty() };
    let desc = texture_desc("raster target", size, format, usage);
    device.create_texture(&wgpu::TextureDescriptor { sample_count: samples, ..desc })
}
