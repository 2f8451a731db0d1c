//! Textures that an application draws into.

use afterimage::gpu::Afterimage;
use wgpu_30::{
    Device, Extent3d, Texture, TextureDescriptor, TextureDimension, TextureFormat, TextureUsages, TextureView,
    TextureViewDescriptor, TextureViewDimension,
};

/// Atlas of the lattices, with a layer for each eye: what an application draws into.
#[derive(Debug)]
pub struct Targets {
    /// Linear color, before tone mapping: [`COLOR`](Self::COLOR).
    pub color: Texture,
    /// Reversed depth: [`DEPTH`](Self::DEPTH).
    pub depth: Texture,
    /// Motion vectors, previous minus current position in pixels of the whole view, y down: [`MOTION`](Self::MOTION).
    pub motion: Texture,
    /// Color, depth and motion of the left eye, then of the right one: attachments of a render pass.
    pub views: [[TextureView; 3]; 2],
}

impl Targets {
    /// Format of colors.
    pub const COLOR: TextureFormat = TextureFormat::Rgba16Float;
    /// Format of depth.
    pub const DEPTH: TextureFormat = TextureFormat::Depth32Float;
    /// Format of motion vectors.
    pub const MOTION: TextureFormat = TextureFormat::Rg16Float;

    /// Targets of `size` texels a layer. The headset makes those of its frames; others are for comparison, such as
    /// full-rate frames.
    pub fn new(device: &Device, size: [u32; 2]) -> Self {
        let usage = TextureUsages::RENDER_ATTACHMENT | Afterimage::INPUT_USAGE | TextureUsages::COPY_SRC;
        let [color, depth, motion] =
            [Self::COLOR, Self::DEPTH, Self::MOTION].map(|format| layers(device, "atlas", size, format, usage));
        let views = [0, 1].map(|eye| [layer(&color, eye), layer(&depth, eye), layer(&motion, eye)]);
        Self { color, depth, motion, views }
    }

    /// Size of a layer in texels.
    pub fn size(&self) -> [u32; 2] {
        [self.color.width(), self.color.height()]
    }
}

/// A texture with a layer for each eye.
pub(crate) fn layers(
    device: &Device,
    label: &str,
    [width, height]: [u32; 2],
    format: TextureFormat,
    usage: TextureUsages,
) -> Texture {
    device.create_texture(&TextureDescriptor {
        label: Some(label),
        size: Extent3d { width, height, depth_or_array_layers: 2 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    })
}

/// One eye's layer of a texture.
pub(crate) fn layer(texture: &Texture, eye: u32) -> TextureView {
    texture.create_view(&TextureViewDescriptor {
        dimension: Some(TextureViewDimension::D2),
        base_array_layer: eye,
        array_layer_count: Some(1),
        ..Default::default()
    })
}
