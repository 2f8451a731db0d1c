//! The state between frames: one type owns both halves of the ping-pong and swaps them itself.

use super::mip_chain::MipChain;
use crate::frame::{ContextDesc, ViewFrame};
use crate::method::HistoryLayout;
use glam::Vec4;

/// What is remembered of all views, this frame's and the last one's. What a method does not use is empty.
#[derive(Clone, Debug, PartialEq)]
pub struct History {
    layout: HistoryLayout,
    view_len: usize,
    previous: Plane,
    current: Plane,
    /// Of this frame's candidates, view by view, where they are noisy.
    candidates: Vec<MipChain>,
    filled: bool,
    held_gaze: Vec<Option<[f32; 2]>>,
}

/// All views, view after view.
#[derive(Clone, Debug, PartialEq)]
struct Plane {
    reservoirs: Vec<[u32; 3]>,
    log_keys: Vec<f32>,
    surfaces: Vec<[u32; 2]>,
    noise: Vec<u32>,
    chains: Vec<MipChain>,
}

impl Plane {
    fn new(size_px: [u32; 2], view_count: u32, layout: HistoryLayout) -> Self {
        let len = size_px[0] as usize * size_px[1] as usize * view_count as usize;
        let when = |used: bool| if used { len } else { 0 };
        let keyed = layout == HistoryLayout::Reservoirs { keys: true };
        let noisy = matches!(layout, HistoryLayout::Surfaces { noisy: true, .. });
        Self {
            reservoirs: vec![[0; 3]; when(matches!(layout, HistoryLayout::Reservoirs { .. }))],
            log_keys: vec![0.0; when(keyed)],
            surfaces: vec![[0; 2]; when(matches!(layout, HistoryLayout::Surfaces { .. }))],
            noise: vec![0; when(noisy)],
            chains: chains(size_px, view_count, layout),
        }
    }

    fn memory_bytes(&self) -> usize {
        size_of_val(&self.reservoirs[..])
            + size_of_val(&self.log_keys[..])
            + size_of_val(&self.surfaces[..])
            + size_of_val(&self.noise[..])
            + self.chains.iter().map(MipChain::memory_bytes).sum::<usize>()
    }
}

/// One for each view, of as many levels as the layout has.
fn chains(size_px: [u32; 2], view_count: u32, layout: HistoryLayout) -> Vec<MipChain> {
    match layout {
        HistoryLayout::Surfaces { levels: levels @ 1.., .. } => {
            vec![MipChain::new(size_px, levels); view_count as usize]
        }
        _ => vec![],
    }
}

impl History {
    pub(super) fn new(desc: &ContextDesc) -> Self {
        let (size_px, view_count, layout) = (desc.size_px, desc.view_count, desc.settings.history_layout());
        Self {
            layout,
            view_len: size_px[0] as usize * size_px[1] as usize,
            previous: Plane::new(size_px, view_count, layout),
            current: Plane::new(size_px, view_count, layout),
            candidates: match layout {
                HistoryLayout::Surfaces { noisy: true, .. } => chains(size_px, view_count, layout),
                _ => vec![],
            },
            filled: false,
            held_gaze: vec![None; view_count as usize],
        }
    }

    pub(super) fn layout(&self) -> HistoryLayout {
        self.layout
    }

    pub(super) fn forget(&mut self) {
        self.filled = false;
        self.held_gaze.fill(None);
    }

    /// Makes what was written the past.
    pub(super) fn swap(&mut self) {
        std::mem::swap(&mut self.previous, &mut self.current);
        self.filled = true;
    }

    /// Whether there is a past at all.
    pub fn is_filled(&self) -> bool {
        self.filled
    }

    /// Position that the eye of a view is taken to look at; held if its gaze is lost next.
    pub(super) fn look(&mut self, index: usize, view: &ViewFrame) -> [f32; 2] {
        let px = view.gaze.resolve(self.held_gaze[index], view.geometry.size_px());
        self.held_gaze[index] = Some(px);
        px
    }

    /// The past reservoirs of `view` to read, and the rows to write.
    pub(super) fn split(&mut self, view: usize) -> (PastView<'_>, &mut [[u32; 3]], &mut [f32]) {
        let range = view * self.view_len..(view + 1) * self.view_len;
        let keys = if self.previous.log_keys.is_empty() { 0..0 } else { range.clone() };
        let past = PastView {
            words: &self.previous.reservoirs[range.clone()],
            log_keys: &self.previous.log_keys[keys.clone()],
        };
        (past, &mut self.current.reservoirs[range], &mut self.current.log_keys[keys])
    }

    /// The past surfaces of `view` to read, and the rows to write: surfaces, and their noise where there is any.
    pub(super) fn split_surfaces(&mut self, view: usize) -> (PastSurfaces<'_>, &mut [[u32; 2]], &mut [u32]) {
        let range = view * self.view_len..(view + 1) * self.view_len;
        let noise = if self.previous.noise.is_empty() { 0..0 } else { range.clone() };
        let past = PastSurfaces {
            words: &self.previous.surfaces[range.clone()],
            noise: &self.previous.noise[noise.clone()],
            chain: self.previous.chains.get(view),
            candidates: self.candidates.get(view),
        };
        (past, &mut self.current.surfaces[range], &mut self.current.noise[noise])
    }

    /// Builds the chain of the candidates of `view`, if there is one.
    pub(super) fn build_candidates(&mut self, view: usize, texel: impl Fn(u32, u32) -> Vec4 + Sync) {
        if let Some(chain) = self.candidates.get_mut(view) {
            chain.build_candidates(texel);
        }
    }

    /// Builds the coarser levels of what was written of `view`.
    pub(super) fn build_chain(&mut self, view: usize) {
        let range = view * self.view_len..(view + 1) * self.view_len;
        if let Some(chain) = self.current.chains.get_mut(view) {
            chain.build(&self.current.surfaces[range]);
        }
    }

    /// Packed reservoirs of the last processed frame, view after view ([`pack`](crate::kernel::pack)); empty but for wrs.
    pub fn words(&self) -> &[[u32; 3]] {
        &self.previous.reservoirs
    }

    /// Packed surfaces of the last processed frame, view after view ([`surface`](crate::kernel::surface)); empty but for taa and
    /// smr.
    pub fn surfaces(&self) -> &[[u32; 2]] {
        &self.previous.surfaces
    }

    /// Packed noise of the last processed frame, view after view ([`noise`](crate::kernel::noise)); empty but for smr with
    /// [`Settings::noisy`](crate::Settings::noisy).
    pub fn noise(&self) -> &[u32] {
        &self.previous.noise
    }

    pub(super) fn restore(&mut self, words: &[[u32; 3]]) {
        self.previous.reservoirs.copy_from_slice(words);
        self.previous.log_keys.fill(f32::MIN);
        self.filled = true;
    }

    /// Bytes held.
    pub fn memory_bytes(&self) -> usize {
        let candidates: usize = self.candidates.iter().map(MipChain::memory_bytes).sum();
        self.previous.memory_bytes() + self.current.memory_bytes() + candidates
    }
}

/// Last frame's reservoirs of one view.
#[derive(Clone, Copy)]
pub(super) struct PastView<'a> {
    pub words: &'a [[u32; 3]],
    pub log_keys: &'a [f32],
}

/// Last frame's surfaces of one view, and what of this frame's candidates they are held against.
#[derive(Clone, Copy)]
pub(super) struct PastSurfaces<'a> {
    pub words: &'a [[u32; 2]],
    pub noise: &'a [u32],
    pub chain: Option<&'a MipChain>,
    pub candidates: Option<&'a MipChain>,
}
