//! The state between frames: two sets of textures, one the past, one to be written.

use crate::frame::ContextDesc;
use wgpu::{
    Device, Extent3d, Texture, TextureDescriptor, TextureDimension, TextureFormat, TextureUsages, TextureView,
    TextureViewDescriptor, TextureViewDimension,
};

/// Texture formats of a packed reservoir's planes ([`pack`](crate::kernel::pack)): words 0 and 1, word 2, and with A-ES the key.
const FORMATS: [TextureFormat; 3] = [TextureFormat::Rg32Uint, TextureFormat::R32Uint, TextureFormat::R32Float];

/// One frame's reservoirs.
#[derive(Debug)]
pub(super) struct Planes {
    pub textures: Vec<Texture>,
    pub views: Vec<TextureView>,
}

/// Both frames' reservoirs, and what else is remembered.
#[derive(Debug)]
pub(super) struct History {
    sets: [Planes; 2],
    past: usize,
    filled: bool,
    pub held_gaze: Vec<Option<[f32; 2]>>,
}

impl History {
    pub fn new(device: &Device, desc: &ContextDesc, keys: bool) -> Self {
        let planes = || {
            let textures: Vec<Texture> =
                FORMATS.iter().take(if keys { 3 } else { 2 }).map(|&f| texture(device, desc, f)).collect();
            let views = textures.iter().map(array_view).collect();
            Planes { textures, views }
        };
        Self { sets: [planes(), planes()], past: 0, filled: false, held_gaze: vec![None; desc.view_count as usize] }
    }

    /// Forgets everything: the next frame starts afresh.
    pub fn forget(&mut self) {
        self.filled = false;
        self.held_gaze.fill(None);
    }

    pub fn is_filled(&self) -> bool {
        self.filled
    }

    /// The past to read and the set to write.
    pub fn split(&self) -> (&Planes, &Planes) {
        (&self.sets[self.past], &self.sets[1 - self.past])
    }

    /// Makes what was written the past.
    pub fn swap(&mut self) {
        self.past = 1 - self.past;
        self.filled = true;
    }

    /// Bytes of all textures.
    pub fn memory_bytes(&self) -> u64 {
        let textures = self.sets.iter().flat_map(|s| &s.textures);
        textures.map(bytes).sum()
    }
}

fn bytes(texture: &Texture) -> u64 {
    let texel = u64::from(texture.format().block_copy_size(None).unwrap_or(0));
    texel * u64::from(texture.width()) * u64::from(texture.height()) * u64::from(texture.depth_or_array_layers())
}

fn texture(device: &Device, desc: &ContextDesc, format: TextureFormat) -> Texture {
    device.create_texture(&TextureDescriptor {
        label: Some("afterimage history"),
        size: Extent3d { width: desc.size_px[0], height: desc.size_px[1], depth_or_array_layers: desc.view_count },
        mip_level_count: 1,
        sample_count: 1,
        dimension: TextureDimension::D2,
        format,
        usage: TextureUsages::TEXTURE_BINDING
            | TextureUsages::STORAGE_BINDING
            | TextureUsages::COPY_SRC
            | TextureUsages::COPY_DST,
        view_formats: &[],
    })
}

/// All layers of a texture as an array, mono frames too: shaders know only arrays.
pub(crate) fn array_view(texture: &Texture) -> TextureView {
    let aspect =
        if texture.format().has_depth_aspect() { wgpu::TextureAspect::DepthOnly } else { wgpu::TextureAspect::All };
    texture.create_view(&TextureViewDescriptor {
        label: Some("afterimage"),
        dimension: Some(TextureViewDimension::D2Array),
        aspect,
        base_mip_level: 0,
        mip_level_count: Some(1),
        ..TextureViewDescriptor::default()
    })
}
