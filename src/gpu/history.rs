//! State between frames: two sets of textures, the previous frame's to read and the current one's to write, which swap
//! after each frame.
//!
//! A frame that was recorded may never run, because its encoder was dropped. So each set has the number of the frame
//! that wrote it in a buffer on the device. A frame states in its uniforms which number it expects
//! (`shaders/shared/past_frame.wgsl`), and starts without history if the device has another.

use super::binding::Binding;
use super::groups::Resource;
use super::plane::{Plane, PlaneDesc};
use super::uniforms::NO_FRAME;
use crate::context::ContextDesc;
use crate::kernel::foveate::level_len;
use crate::method::HistoryLayout;
use crate::uniforms::ViewState;
use wgpu::{Buffer, BufferDescriptor, BufferUsages, CommandEncoder, Device, TextureFormat, TextureUsages};

const NUMBER_BYTES: u64 = 4;

#[derive(Debug)]
pub(super) struct Planes {
    /// The mip chain, if any, is the second.
    pub planes: Vec<Plane>,
    /// Alphas of stored samples, as floats, if the context keeps alpha; or their packed albedos, if frames have albedo.
    pub extra: Option<Plane>,
    /// Number of the frame that wrote the textures, on the device; 0 before one did.
    pub frame: Buffer,
}

impl Planes {
    /// The texture of binding `i` of three. The last one has alpha or albedo, if frames have them.
    fn at(&self, i: usize) -> Option<&Plane> {
        self.planes.get(i).or_else(|| self.extra.as_ref().filter(|_| i == 2))
    }
}

/// Textures of the previous and the current frame, and the state of the views.
#[derive(Debug)]
pub(super) struct History {
    layout: HistoryLayout,
    pub sets: [Planes; 2],
    /// Mip chain of noisy candidates, if there is one.
    pub candidates: Option<Plane>,
    past: usize,
    filled: bool,
    /// Number of the last recorded frame; 0 before the first one.
    frame: u32,
    pub state: Vec<ViewState>,
}

impl History {
    pub fn new(device: &Device, desc: &ContextDesc) -> Self {
        let layout = desc.settings.history_layout();
        let planes = || Planes {
            planes: plane_descs(desc).iter().map(|plane| plane.create(device)).collect(),
            extra: extra_plane(desc).map(|plane| plane.create(device)),
            frame: device.create_buffer(&BufferDescriptor {
                label: Some("afterimage frame number"),
                size: 4 * NUMBER_BYTES,
                usage: BufferUsages::UNIFORM | BufferUsages::COPY_DST | BufferUsages::COPY_SRC,
                mapped_at_creation: false,
            }),
        };
        let state = vec![ViewState::default(); desc.view_count as usize];
        let candidates = candidate_plane(desc).map(|plane| plane.create(device));
        Self { layout, sets: [planes(), planes()], candidates, past: 0, filled: false, frame: 0, state }
    }

    pub fn layout(&self) -> HistoryLayout {
        self.layout
    }

    /// Discards history and the state of the views: the next frame starts without history.
    pub fn forget(&mut self) {
        self.filled = false;
        self.state.fill(ViewState::default());
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

    pub fn next_number(&self) -> u32 {
        next(self.frame)
    }

    /// Makes the written frame the previous one: its [`next_number`](Self::next_number) is in `upload`, and `encoder`
    /// has its passes.
    pub fn finish(&mut self, encoder: &mut CommandEncoder, upload: &Buffer) {
        self.frame = self.next_number();
        self.number_next(encoder, upload);
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

    /// What passes bind by a number, if it is of this history.
    pub fn bound(&self, number: u32) -> Option<Resource> {
        let (past, next) = self.split();
        bound(past, next, number)
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

/// What passes bind by a number, if it is of a history that has `past` to read and `next` to write.
pub(super) fn bound(past: &Planes, next: &Planes, number: u32) -> Option<Resource> {
    let place = |first: Binding| number.checked_sub(first as u32).filter(|&i| i < 3).map(|i| i as usize);
    if number == Binding::PastFrame as u32 {
        Some((&past.frame).into())
    } else if let Some(i) = place(Binding::Past) {
        past.at(i).map(|plane| (&plane.whole).into())
    } else {
        next.at(place(Binding::Next)?).map(|plane| (&plane.levels[0]).into())
    }
}

/// Bytes that a context holds between frames.
pub(super) fn memory_bytes(desc: &ContextDesc) -> u64 {
    let sets: u64 = plane_descs(desc).iter().chain(&extra_plane(desc)).map(|plane| 2 * plane.bytes()).sum();
    sets + candidate_plane(desc).map_or(0, |plane| plane.bytes())
}

/// Size of the largest texture, along x and y.
pub(super) fn largest_size(desc: &ContextDesc) -> [u32; 2] {
    plane_descs(desc).iter().fold([0; 2], |size, plane| [0, 1].map(|i| size[i].max(plane.size_px[i])))
}

/// Textures of one frame's history.
fn plane_descs(desc: &ContextDesc) -> Vec<PlaneDesc> {
    use TextureFormat::{R32Uint, Rg32Uint};
    let full = |format| plane(desc, format);
    match desc.settings.history_layout() {
        HistoryLayout::Nothing => vec![],
        HistoryLayout::Reservoirs { keys: false, references: false } => [Rg32Uint, R32Uint].map(full).into(),
        HistoryLayout::Reservoirs { .. } => [Rg32Uint, R32Uint, R32Uint].map(full).into(),
        HistoryLayout::Sparse { noisy: false, .. } => vec![full(Rg32Uint)],
        HistoryLayout::Sparse { noisy: true, .. } => [Rg32Uint, R32Uint].map(full).into(),
        HistoryLayout::Surfaces { levels: 0, .. } => vec![full(Rg32Uint)],
        HistoryLayout::Surfaces { levels, noisy: false } => vec![full(Rg32Uint), mip_chain(desc, levels)],
        HistoryLayout::Surfaces { levels, noisy: true } => {
            vec![full(Rg32Uint), mip_chain(desc, levels), full(R32Uint)]
        }
    }
}

/// Alphas or albedos of stored samples, if history has them.
fn extra_plane(desc: &ContextDesc) -> Option<PlaneDesc> {
    desc.has_extra_history().then(|| plane(desc, TextureFormat::R32Uint))
}

/// Mip chain of noisy candidates, if the layout has one.
fn candidate_plane(desc: &ContextDesc) -> Option<PlaneDesc> {
    match desc.settings.history_layout() {
        HistoryLayout::Surfaces { levels, noisy: true } => Some(mip_chain(desc, levels)),
        _ => None,
    }
}

fn plane(desc: &ContextDesc, format: TextureFormat) -> PlaneDesc {
    let usage = TextureUsages::COPY_SRC | TextureUsages::COPY_DST;
    PlaneDesc { usage, ..PlaneDesc::new("afterimage history", format, desc.size_px, desc.view_count) }
}

/// Levels 1 to `levels` of a mip chain.
fn mip_chain(desc: &ContextDesc, levels: u32) -> PlaneDesc {
    // Mip sizes of a texture round down, levels of the mip chain round up. With padding they agree.
    let size_px = desc.size_px.map(|s| level_len(s, 1).next_multiple_of(1 << (levels - 1)));
    PlaneDesc { levels, size_px, ..plane(desc, TextureFormat::Rgba16Float) }
}
