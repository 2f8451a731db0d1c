//! Textures that an application draws into.

use afterimage::gpu::Afterimage;
use wgpu_30::{
    Device, Extent3d, Texture, TextureDescriptor, TextureDimension, TextureFormat, TextureUsages, TextureView,
    TextureViewDescriptor, TextureViewDimension,
};

/// What an application draws into: the whole views, with a layer for each eye.
#[derive(Debug)]
pub struct Targets {
    /// Linear color, before tone mapping: [`COLOR`](Self::COLOR).
    pub color: Texture,
    /// Reversed depth of the prepass: [`DEPTH`](Self::DEPTH).
    pub depth: Texture,
    /// Motion vectors, previous minus current position in pixels, y down: [`MOTION`](Self::MOTION).
    pub motion: Texture,
    /// Depth of the prepass, with the near plane, 1, where nothing is to be shaded: [`DEPTH`](Self::DEPTH).
    pub primed: Texture,
    /// Layers of the left and of the right eye.
    pub views: [TargetViews; 2],
    /// Color of half the width and height, rounded up, of frames that are
    /// [halved](crate::HeadsetFrame::halve): [`COLOR`](Self::COLOR).
    pub half_color: Texture,
    /// The same of each eye, with a depth buffer.
    pub half_views: [HalfViews; 2],
}

/// Layers of an eye of half the width and height: attachments of a render pass.
#[derive(Debug)]
pub struct HalfViews {
    /// Color.
    pub color: TextureView,
    /// Depth without a prepass: clear it to 0, and test and write with `GreaterEqual`.
    pub depth: TextureView,
}

/// Layers of an eye in [`Targets`]: attachments of render passes.
#[derive(Debug)]
pub struct TargetViews {
    /// Of the color pass.
    pub color: TextureView,
    /// Depth of the prepass.
    pub depth: TextureView,
    /// Of the prepass.
    pub motion: TextureView,
    /// Depth of the color pass: load it, and test with `GreaterEqual`.
    pub primed: TextureView,
}

impl Targets {
    /// Format of colors.
    pub const COLOR: TextureFormat = TextureFormat::Rgba16Float;
    /// Format of depth.
    pub const DEPTH: TextureFormat = TextureFormat::Depth32Float;
    /// Format of motion vectors.
    pub const MOTION: TextureFormat = TextureFormat::Rg16Float;

    /// Targets of `size` pixels a layer. The headset makes those of its frames; others are for comparison, such as
    /// full-rate frames.
    pub fn new(device: &Device, size: [u32; 2]) -> Self {
        let input = TextureUsages::RENDER_ATTACHMENT | Afterimage::INPUT_USAGE | TextureUsages::COPY_SRC;
        let [color, depth, motion] =
            [Self::COLOR, Self::DEPTH, Self::MOTION].map(|format| layers(device, "headset", size, format, input));
        let usage = TextureUsages::RENDER_ATTACHMENT | TextureUsages::COPY_DST;
        let primed = layers(device, "primed depth", size, Self::DEPTH, usage);
        let views = [0, 1].map(|eye| TargetViews {
            color: layer(&color, eye),
            depth: layer(&depth, eye),
            motion: layer(&motion, eye),
            primed: layer(&primed, eye),
        });
        let half = size.map(|side| side.div_ceil(2));
        let half_color = layers(device, "headset", half, Self::COLOR, input);
        let half_depth = layers(device, "half depth", half, Self::DEPTH, TextureUsages::RENDER_ATTACHMENT);
        let half_views = [0, 1].map(|eye| HalfViews { color: layer(&half_color, eye), depth: layer(&half_depth, eye) });
        Self { color, depth, motion, primed, views, half_color, half_views }
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
