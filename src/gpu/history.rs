//! State between frames: two sets of textures, the previous frame's to read and the current one's to write, which swap
//! after each frame.

use super::mip_chain::{self, CandidatePass, Candidates, MipChainPass, MipLevel};
use crate::frame::ContextDesc;
use crate::kernel::foveate::level_len;
use crate::method::HistoryLayout;
use wgpu::{
    Device, Extent3d, Texture, TextureDescriptor, TextureDimension, TextureFormat, TextureUsages, TextureView,
    TextureViewDescriptor, TextureViewDimension,
};

/// Textures of one frame.
#[derive(Debug)]
pub(super) struct Planes {
    pub textures: Vec<Texture>,
    /// Views of all levels, to read.
    pub views: Vec<TextureView>,
    /// Views of the first level, to write.
    pub targets: Vec<TextureView>,
    /// Dispatches that fill the other levels.
    pub mip_levels: Vec<MipLevel>,
}

/// Textures of the previous and the current frame, and held gaze positions.
#[derive(Debug)]
pub(super) struct History {
    layout: HistoryLayout,
    sets: [Planes; 2],
    candidates: Option<Candidates>,
    past: usize,
    filled: bool,
    pub held_gaze: Vec<Option<[f32; 2]>>,
}

impl History {
    /// Empty history. `mip_chain` and `candidates` fill the mip chains of surfaces and of candidates, if the layout has
    /// them.
    pub fn new(
        device: &Device,
        desc: &ContextDesc,
        layout: HistoryLayout,
        mip_chain: Option<&MipChainPass>,
        candidates: Option<&CandidatePass>,
    ) -> Self {
        let planes = || {
            let full = |format| texture(device, desc, format, desc.size_px, 1);
            let mut textures = match layout {
                HistoryLayout::Nothing => vec![],
                HistoryLayout::Reservoirs { keys } => {
                    let formats = [TextureFormat::Rg32Uint, TextureFormat::R32Uint, TextureFormat::R32Float];
                    formats.into_iter().take(if keys { 3 } else { 2 }).map(full).collect()
                }
                HistoryLayout::Surfaces { .. } => vec![full(TextureFormat::Rg32Uint)],
            };
            let mut levels = vec![];
            if let (HistoryLayout::Surfaces { levels: count @ 1.., noisy }, Some(pass)) = (layout, mip_chain) {
                let texture = mip_chain_texture(device, desc, count);
                levels = pass.levels(device, &texture, desc.size_px);
                textures.push(texture);
                textures.extend(noisy.then(|| full(TextureFormat::R32Uint)));
            }
            let views = textures.iter().map(|t| levels_view(t, 0, None)).collect();
            let targets = textures.iter().map(|t| levels_view(t, 0, Some(1))).collect();
            Planes { textures, views, targets, mip_levels: levels }
        };
        let candidates = match layout {
            HistoryLayout::Surfaces { levels, noisy: true } => candidates.map(|c| c.levels(device, desc, levels)),
            _ => None,
        };
        let held_gaze = vec![None; desc.view_count as usize];
        Self { layout, sets: [planes(), planes()], candidates, past: 0, filled: false, held_gaze }
    }

    /// Mip chain of noisy candidates.
    pub fn candidates(&self) -> Option<&Candidates> {
        self.candidates.as_ref()
    }

    pub fn layout(&self) -> HistoryLayout {
        self.layout
    }

    /// Discards history and held gaze positions: the next frame starts without history.
    pub fn forget(&mut self) {
        self.filled = false;
        self.held_gaze.fill(None);
    }

    /// Whether a frame was recorded since the last reset.
    pub fn is_filled(&self) -> bool {
        self.filled
    }

    /// The previous frame's textures to read, and the current one's to write.
    pub fn split(&self) -> (&Planes, &Planes) {
        (&self.sets[self.past], &self.sets[1 - self.past])
    }

    /// Makes the written frame the previous one.
    pub fn swap(&mut self) {
        self.past = 1 - self.past;
        self.filled = true;
    }

    /// Bytes of all textures.
    pub fn memory_bytes(&self) -> u64 {
        let textures = self.sets.iter().flat_map(|s| &s.textures);
        textures.chain(self.candidates.iter().map(|c| &c.texture)).map(bytes).sum()
    }
}

fn bytes(texture: &Texture) -> u64 {
    let texel = u64::from(texture.format().block_copy_size(None).unwrap_or(0));
    let texels = |level: u32| u64::from(texture.width() >> level) * u64::from(texture.height() >> level);
    let all_levels: u64 = (0..texture.mip_level_count()).map(texels).sum();
    texel * all_levels * u64::from(texture.depth_or_array_layers())
}

/// Texture for levels 1 to `count` of a mip chain.
pub(super) fn mip_chain_texture(device: &Device, desc: &ContextDesc, count: u32) -> Texture {
    // Mip sizes of a texture round down, levels of the mip chain round up. With padding they agree.
    let multiple = 1 << (count - 1);
    let size = desc.size_px.map(|s| level_len(s, 1).next_multiple_of(multiple));
    texture(device, desc, mip_chain::FORMAT, size, count)
}

fn texture(device: &Device, desc: &ContextDesc, format: TextureFormat, size: [u32; 2], levels: u32) -> Texture {
    device.create_texture(&TextureDescriptor {
        label: Some("afterimage history"),
        size: Extent3d { width: size[0], height: size[1], depth_or_array_layers: desc.view_count },
        mip_level_count: levels,
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

/// View of all layers of a texture's first level as a 2D array. Textures with one layer, too, because the shaders bind
/// arrays.
pub fn array_view(texture: &Texture) -> TextureView {
    levels_view(texture, 0, Some(1))
}

/// View of all layers as a 2D array, of `count` levels from `first` on; `None`: of all levels from `first` on.
pub(super) fn levels_view(texture: &Texture, first: u32, count: Option<u32>) -> TextureView {
    let aspect =
        if texture.format().has_depth_aspect() { wgpu::TextureAspect::DepthOnly } else { wgpu::TextureAspect::All };
    texture.create_view(&TextureViewDescriptor {
        label: Some("afterimage"),
        dimension: Some(TextureViewDimension::D2Array),
        aspect,
        base_mip_level: first,
        mip_level_count: count,
        ..TextureViewDescriptor::default()
    })
}
