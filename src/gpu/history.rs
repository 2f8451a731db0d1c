//! State between frames: two sets of textures, the previous frame's to read and the current one's to write, which swap
//! after each frame.
//!
//! A frame that was recorded may never run, because its encoder was dropped. So each set has the number of the frame
//! that wrote it in a buffer on the device. A frame states in its uniforms which number it expects
//! (`shaders/pass/past_frame.wgsl`), and starts without history if the device has another.

use super::buffer::filled_if_alive;
use super::mip_chain::{self, Candidates, MipLevel};
use crate::error::FrameError;
use crate::frame::ContextDesc;
use crate::kernel::foveate::level_len;
use crate::method::HistoryLayout;
use crate::uniforms::Held;
use wgpu::{
    Buffer, BufferDescriptor, BufferUsages, CommandEncoder, Device, Extent3d, Texture, TextureDescriptor,
    TextureDimension, TextureFormat, TextureUsages, TextureView, TextureViewDescriptor, TextureViewDimension,
};

/// `NO_FRAME` in `shaders/pass/inputs.wgsl`: the number of no frame.
pub(super) const NO_FRAME: u32 = u32::MAX;
/// Bytes of a frame number.
const NUMBER_BYTES: u64 = 4;

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
    /// Number of the frame that wrote the textures, on the device; 0 before one did.
    pub frame: Buffer,
}

/// Textures of the previous and the current frame, and the held state of the views.
#[derive(Debug)]
pub(super) struct History {
    layout: HistoryLayout,
    pub sets: [Planes; 2],
    /// Mip chain of noisy candidates, if there is one.
    pub candidates: Option<Candidates>,
    past: usize,
    filled: bool,
    /// Number of the last recorded frame; 0 before the first one.
    frame: u32,
    pub held: Vec<Held>,
}

impl History {
    /// Empty history, without the textures that stages [add](super::stage::Passes::extend).
    pub fn new(device: &Device, desc: &ContextDesc) -> Self {
        let layout = desc.settings.history_layout();
        let planes = || {
            let textures: Vec<_> = plan(desc, layout).iter().map(|p| p.create(device, desc)).collect();
            let views = textures.iter().map(|t| levels_view(t, 0, None, None)).collect();
            let targets = textures.iter().map(array_view).collect();
            let frame = device.create_buffer(&BufferDescriptor {
                label: Some("afterimage frame number"),
                size: 4 * NUMBER_BYTES,
                usage: BufferUsages::UNIFORM | BufferUsages::COPY_DST | BufferUsages::COPY_SRC,
                mapped_at_creation: false,
            });
            Planes { textures, views, targets, mip_levels: vec![], frame }
        };
        let held = vec![Held::default(); desc.view_count as usize];
        Self { layout, sets: [planes(), planes()], candidates: None, past: 0, filled: false, frame: 0, held }
    }

    pub fn layout(&self) -> HistoryLayout {
        self.layout
    }

    /// Discards history and the held state of the views: the next frame starts without history.
    pub fn forget(&mut self) {
        self.filled = false;
        self.held.fill(Held::default());
    }

    /// Whether a frame was recorded since the last reset.
    pub fn is_filled(&self) -> bool {
        self.filled
    }

    /// The previous frame's textures to read, and the current one's to write.
    pub fn split(&self) -> (&Planes, &Planes) {
        (&self.sets[self.past], &self.sets[1 - self.past])
    }

    /// Number that the device must have for the previous frame's textures, for the current frame to read them.
    pub fn past_frame(&self) -> u32 {
        if self.filled { self.frame } else { NO_FRAME }
    }

    /// The number of the next frame, on the device; an error if wgpu knows that the device is lost.
    pub fn next_number(&self, device: &Device) -> Result<Buffer, FrameError> {
        let (label, bytes) = ("afterimage frame number", next(self.frame).to_le_bytes());
        let (number, is_alive) = filled_if_alive(device, label, &bytes, BufferUsages::COPY_SRC);
        if is_alive { Ok(number) } else { Err(FrameError::DeviceLost) }
    }

    /// Makes the written frame the previous one: records its [`next_number`](Self::next_number) into `encoder`, which
    /// has its passes.
    pub fn finish(&mut self, encoder: &mut CommandEncoder, number: &Buffer) {
        self.frame = next(self.frame);
        self.number_next(encoder, number);
        self.swap();
    }

    /// Makes the written textures the previous frame's: those of `old`, resampled by passes that `encoder` has. If the
    /// previous frame itself never ran, its number in `old` is another, and so it is here.
    pub fn finish_resampled(&mut self, encoder: &mut CommandEncoder, old: &Self) {
        self.frame = old.frame;
        self.number_next(encoder, &old.split().0.frame);
        self.swap();
    }

    fn number_next(&self, encoder: &mut CommandEncoder, number: &Buffer) {
        encoder.copy_buffer_to_buffer(number, 0, &self.split().1.frame, 0, NUMBER_BYTES);
    }

    fn swap(&mut self) {
        self.past = 1 - self.past;
        self.filled = true;
    }
}

/// Number of the frame after that of number `frame`, 1 to `NO_FRAME - 1`. Textures that were never written have 0.
fn next(frame: u32) -> u32 {
    frame % (NO_FRAME - 1) + 1
}

/// Bytes that a context holds between frames.
pub(super) fn memory_bytes(desc: &ContextDesc) -> u64 {
    let layout = desc.settings.history_layout();
    let sets: u64 = plan(desc, layout).iter().map(|p| 2 * p.bytes(desc)).sum();
    sets + candidate_plan(desc).map_or(0, |p| p.bytes(desc))
}

/// Size of the largest texture, along x and y.
pub(super) fn largest_size(desc: &ContextDesc) -> [u32; 2] {
    let plans = plan(desc, desc.settings.history_layout());
    plans.iter().fold([0; 2], |size, p| [0, 1].map(|i| size[i].max(p.size_px[i])))
}

/// A texture of history.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plan {
    format: TextureFormat,
    size_px: [u32; 2],
    levels: u32,
}

/// Textures of one frame's history. The mip chain, if any, is the second.
fn plan(desc: &ContextDesc, layout: HistoryLayout) -> Vec<Plan> {
    let full = |format| Plan { format, size_px: desc.size_px, levels: 1 };
    match layout {
        HistoryLayout::Nothing => vec![],
        HistoryLayout::Reservoirs { keys, references } => {
            let formats = [TextureFormat::Rg32Uint, TextureFormat::R32Uint, TextureFormat::R32Uint];
            formats.into_iter().take(if keys || references { 3 } else { 2 }).map(full).collect()
        }
        HistoryLayout::Kept { noisy, .. } => {
            let formats = [TextureFormat::Rg32Uint, TextureFormat::R32Uint];
            formats.into_iter().take(if noisy { 2 } else { 1 }).map(full).collect()
        }
        HistoryLayout::Surfaces { levels, noisy } => {
            let mip_chain = (levels > 0).then(|| mip_chain_plan(desc, levels));
            let noise = (levels > 0 && noisy).then(|| full(TextureFormat::R32Uint));
            [Some(full(TextureFormat::Rg32Uint)), mip_chain, noise].into_iter().flatten().collect()
        }
    }
}

/// Mip chain of noisy candidates, if the layout has one.
pub(super) fn candidate_plan(desc: &ContextDesc) -> Option<Plan> {
    match desc.settings.history_layout() {
        HistoryLayout::Surfaces { levels, noisy: true } => Some(mip_chain_plan(desc, levels)),
        _ => None,
    }
}

/// Texture for levels 1 to `levels` of a mip chain.
fn mip_chain_plan(desc: &ContextDesc, levels: u32) -> Plan {
    // Mip sizes of a texture round down, levels of the mip chain round up. With padding they agree.
    let multiple = 1 << (levels - 1);
    let size_px = desc.size_px.map(|s| level_len(s, 1).next_multiple_of(multiple));
    Plan { format: mip_chain::FORMAT, size_px, levels }
}

impl Plan {
    pub fn create(self, device: &Device, desc: &ContextDesc) -> Texture {
        let [width, height] = self.size_px;
        device.create_texture(&TextureDescriptor {
            label: Some("afterimage history"),
            size: Extent3d { width, height, depth_or_array_layers: desc.view_count },
            mip_level_count: self.levels,
            sample_count: 1,
            dimension: TextureDimension::D2,
            format: self.format,
            usage: TextureUsages::TEXTURE_BINDING
                | TextureUsages::STORAGE_BINDING
                | TextureUsages::COPY_SRC
                | TextureUsages::COPY_DST,
            view_formats: &[],
        })
    }

    fn bytes(self, desc: &ContextDesc) -> u64 {
        let texel = u64::from(self.format.block_copy_size(None).unwrap_or(0));
        let texels = |level: u32| self.size_px.map(|s| u64::from(s >> level)).iter().product::<u64>();
        texel * (0..self.levels).map(texels).sum::<u64>() * u64::from(desc.view_count)
    }
}

/// View of all layers of a texture's first level as a 2D array. Textures with one layer also get a 2D array view,
/// because the shaders bind arrays.
pub fn array_view(texture: &Texture) -> TextureView {
    levels_view(texture, 0, Some(1), None)
}

/// View of one layer, or of all, as a 2D array, of `count` levels from `first` on; `None`: of all levels from `first`
/// on.
pub(super) fn levels_view(texture: &Texture, first: u32, count: Option<u32>, layer: Option<u32>) -> TextureView {
    let aspect =
        if texture.format().has_depth_aspect() { wgpu::TextureAspect::DepthOnly } else { wgpu::TextureAspect::All };
    texture.create_view(&TextureViewDescriptor {
        label: Some("afterimage"),
        dimension: Some(TextureViewDimension::D2Array),
        aspect,
        base_mip_level: first,
        mip_level_count: count,
        base_array_layer: layer.unwrap_or(0),
        array_layer_count: layer.map(|_| 1),
        ..TextureViewDescriptor::default()
    })
}
