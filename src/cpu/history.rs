//! State between frames: the previous and the current frame's buffers, which swap after each frame.

use super::frame::Frame;
use super::levels::mip_chain::MipChain;
use crate::context::ContextDesc;
use crate::method::HistoryLayout;
use crate::resize::Resize;
use crate::uniforms::ViewState;
use glam::Vec4;

/// History of all views: buffers of the previous and the current frame. Buffers that a method does not use are empty.
#[derive(Clone, Debug, PartialEq)]
pub struct History {
    layout: HistoryLayout,
    view_len: usize,
    previous: Plane,
    current: Plane,
    /// Mip chains of this frame's candidates, one a view; empty unless candidates are noisy.
    candidates: Vec<MipChain>,
    filled: bool,
    state: Vec<ViewState>,
}

/// Buffers of one frame: all views, view after view.
#[derive(Clone, Debug, PartialEq)]
struct Plane {
    reservoirs: Vec<[u32; 3]>,
    log_keys: Vec<f32>,
    references: Vec<u32>,
    surfaces: Vec<[u32; 2]>,
    noise: Vec<u32>,
    /// Of stored samples, once a frame has alpha.
    alpha: Vec<f32>,
    /// Packed albedos of stored samples, of contexts with albedo.
    albedo: Vec<u32>,
    mip_chains: Vec<MipChain>,
}

impl Plane {
    fn new(desc: &ContextDesc) -> Self {
        let (size_px, view_count, layout) = (desc.size_px, desc.view_count, desc.settings.history_layout());
        let len = size_px[0] as usize * size_px[1] as usize * view_count as usize;
        let when = |used: bool| if used { len } else { 0 };
        let keyed = matches!(layout, HistoryLayout::Reservoirs { keys: true, .. });
        let referenced = matches!(layout, HistoryLayout::Reservoirs { references: true, .. });
        let noisy =
            matches!(layout, HistoryLayout::Surfaces { noisy: true, .. } | HistoryLayout::Sparse { noisy: true, .. });
        let is_stored = matches!(layout, HistoryLayout::Surfaces { .. } | HistoryLayout::Sparse { .. });
        Self {
            reservoirs: vec![[0; 3]; when(matches!(layout, HistoryLayout::Reservoirs { .. }))],
            log_keys: vec![0.0; when(keyed)],
            references: vec![0; when(referenced)],
            surfaces: vec![[0; 2]; when(is_stored)],
            noise: vec![0; when(noisy)],
            alpha: vec![],
            albedo: vec![0; when(desc.has_albedo)],
            mip_chains: mip_chains(size_px, view_count, layout),
        }
    }

    fn memory_bytes(&self) -> usize {
        size_of_val(&self.reservoirs[..])
            + size_of_val(&self.log_keys[..])
            + size_of_val(&self.references[..])
            + size_of_val(&self.surfaces[..])
            + size_of_val(&self.noise[..])
            + size_of_val(&self.alpha[..])
            + size_of_val(&self.albedo[..])
            + self.mip_chains.iter().map(MipChain::memory_bytes).sum::<usize>()
    }
}

/// One mip chain a view, if the layout has any.
fn mip_chains(size_px: [u32; 2], view_count: u32, layout: HistoryLayout) -> Vec<MipChain> {
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
            previous: Plane::new(desc),
            current: Plane::new(desc),
            candidates: match layout {
                HistoryLayout::Surfaces { noisy: true, .. } => mip_chains(size_px, view_count, layout),
                _ => vec![],
            },
            filled: false,
            state: vec![ViewState::default(); view_count as usize],
        }
    }

    /// This history resampled to the size of `desc`, whose layout is the same.
    pub(super) fn resized(&self, resize: &Resize, desc: &ContextDesc) -> Self {
        let mut next = Self::new(desc);
        next.state = self.state.iter().map(|state| resize.state(*state)).collect();
        if !self.filled {
            return next;
        }
        next.filled = true;
        let past = &self.previous;
        let len = self.view_len;
        next.previous.reservoirs = past.reservoirs.chunks(len).flat_map(|v| resize.nearest(v)).collect();
        next.previous.log_keys = past.log_keys.chunks(len).flat_map(|v| resize.nearest(v)).collect();
        next.previous.references = past.references.chunks(len).flat_map(|v| resize.nearest(v)).collect();
        next.previous.noise = past.noise.chunks(len).flat_map(|v| resize.nearest(v)).collect();
        next.previous.alpha = past.alpha.chunks(len).flat_map(|v| resize.nearest(v)).collect();
        next.current.alpha = next.previous.alpha.clone();
        next.previous.albedo = past.albedo.chunks(len).flat_map(|v| resize.nearest(v)).collect();
        let is_sparse = matches!(self.layout, HistoryLayout::Sparse { .. });
        let means = matches!(self.layout, HistoryLayout::Sparse { means: true, .. });
        let surfaces = |v| if is_sparse { resize.sparse(v, means) } else { resize.surfaces(v) };
        next.previous.surfaces = past.surfaces.chunks(len).flat_map(surfaces).collect();
        for (mip_chain, words) in next.previous.mip_chains.iter_mut().zip(next.previous.surfaces.chunks(next.view_len))
        {
            mip_chain.build(words);
        }
        next
    }

    /// Begins to keep the alpha of stored samples, which is 1 until then.
    pub(super) fn keep_alpha(&mut self) {
        let len = self.previous.surfaces.len();
        self.previous.alpha.resize(len, 1.0);
        self.current.alpha.resize(len, 1.0);
    }

    pub(super) fn layout(&self) -> HistoryLayout {
        self.layout
    }

    pub(super) fn forget(&mut self) {
        self.filled = false;
        self.state.fill(ViewState::default());
    }

    /// Makes the written frame the previous one.
    pub(super) fn swap(&mut self) {
        std::mem::swap(&mut self.previous, &mut self.current);
        self.filled = true;
    }

    /// Whether a frame was processed since the last reset.
    pub fn is_filled(&self) -> bool {
        self.filled
    }

    /// Updates the state of view `index` with this frame, and returns it.
    pub(super) fn advance(&mut self, index: usize, frame: &Frame<'_>) -> ViewState {
        let state = self.state_after(index, frame);
        self.state[index] = state;
        state
    }

    /// Last known gaze position of a view, if any.
    pub(super) fn held_gaze_px(&self, index: usize) -> Option<[f32; 2]> {
        self.state.get(index).and_then(|state| state.gaze_px)
    }

    /// The state that [`hold`](Self::hold) would return, without changing anything.
    pub(super) fn state_after(&self, index: usize, frame: &Frame<'_>) -> ViewState {
        self.state[index].with(&frame.views[index], frame.exposure)
    }

    /// Previous packed samples of `view`; empty except on planned frames, and without history.
    pub(super) fn sparse(&self, view: usize) -> &[[u32; 2]] {
        let is_sparse = matches!(self.layout, HistoryLayout::Sparse { .. }) && self.filled;
        if is_sparse { &self.previous.surfaces[view * self.view_len..(view + 1) * self.view_len] } else { &[] }
    }

    /// Packed noise of these samples; empty unless candidates are noisy.
    pub(super) fn sparse_noise(&self, view: usize) -> &[u32] {
        let is_noisy = !self.previous.noise.is_empty() && self.filled;
        if is_noisy { &self.previous.noise[view * self.view_len..(view + 1) * self.view_len] } else { &[] }
    }

    /// Previous reservoirs of `view`, and the current ones to write.
    pub(super) fn split(&mut self, view: usize) -> (PastView<'_>, NextView<'_>) {
        let range = view * self.view_len..(view + 1) * self.view_len;
        let keys = if self.previous.log_keys.is_empty() { 0..0 } else { range.clone() };
        let references = if self.previous.references.is_empty() { 0..0 } else { range.clone() };
        let past = PastView {
            words: &self.previous.reservoirs[range.clone()],
            log_keys: &self.previous.log_keys[keys.clone()],
            references: &self.previous.references[references.clone()],
        };
        let next = NextView {
            words: &mut self.current.reservoirs[range],
            log_keys: &mut self.current.log_keys[keys],
            references: &mut self.current.references[references],
        };
        (past, next)
    }

    /// Previous surfaces of `view`, and the current ones to write.
    pub(super) fn split_surfaces(&mut self, view: usize) -> (PastSurfaces<'_>, NextSurfaces<'_>) {
        let range = view * self.view_len..(view + 1) * self.view_len;
        let noise = if self.previous.noise.is_empty() { 0..0 } else { range.clone() };
        let alpha = if self.previous.alpha.is_empty() { 0..0 } else { range.clone() };
        let albedo = if self.previous.albedo.is_empty() { 0..0 } else { range.clone() };
        let past = PastSurfaces {
            words: &self.previous.surfaces[range.clone()],
            noise: &self.previous.noise[noise.clone()],
            alpha: &self.previous.alpha[alpha.clone()],
            albedo: &self.previous.albedo[albedo.clone()],
            mip_chain: self.previous.mip_chains.get(view),
            candidates: self.candidates.get(view),
        };
        let next = NextSurfaces {
            words: &mut self.current.surfaces[range],
            noise: &mut self.current.noise[noise],
            alpha: &mut self.current.alpha[alpha],
            albedo: &mut self.current.albedo[albedo],
        };
        (past, next)
    }

    /// Fills the mip chain of the candidates of `view`, if there is one.
    pub(super) fn build_candidates(&mut self, view: usize, texel: impl Fn(u32, u32) -> Vec4 + Sync) {
        if let Some(mip_chain) = self.candidates.get_mut(view) {
            mip_chain.build_candidates(texel);
        }
    }

    /// Fills the mip chain of the current surfaces of `view`, if there is one.
    pub(super) fn build_mip_chain(&mut self, view: usize) {
        let range = view * self.view_len..(view + 1) * self.view_len;
        if let Some(mip_chain) = self.current.mip_chains.get_mut(view) {
            mip_chain.build(&self.current.surfaces[range]);
        }
    }

    /// Packed reservoirs of the last processed frame, view after view
    /// ([`stored_reservoir`](crate::kernel::stored_reservoir)); empty except for wrs.
    pub fn words(&self) -> &[[u32; 3]] {
        &self.previous.reservoirs
    }

    /// Packed surfaces of the last processed frame, view after view ([`surface`](crate::kernel::surface)); empty except
    /// for taa and smr.
    pub fn surfaces(&self) -> &[[u32; 2]] {
        &self.previous.surfaces
    }

    /// Packed noise of the last processed frame, view after view ([`noise`](crate::kernel::noise)); empty except for
    /// smr with [`Settings::noisy`](crate::internal::Settings::noisy).
    pub fn noise(&self) -> &[u32] {
        &self.previous.noise
    }

    /// Packed albedos of the last processed frame's stored samples, view after view
    /// ([`demodulation`](crate::kernel::demodulation)); empty unless [`ContextDesc::has_albedo`] is set.
    pub fn albedo(&self) -> &[u32] {
        &self.previous.albedo
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

/// Previous frame's reservoirs of one view.
#[derive(Clone, Copy)]
pub(super) struct PastView<'a> {
    pub words: &'a [[u32; 3]],
    /// Empty without A-ES.
    pub log_keys: &'a [f32],
    /// Empty unless the gate compares at the candidate's scale.
    pub references: &'a [u32],
}

/// This frame's reservoirs of one view, with the same parts as [`PastView`].
pub(super) struct NextView<'a> {
    pub words: &'a mut [[u32; 3]],
    pub log_keys: &'a mut [f32],
    pub references: &'a mut [u32],
}

/// Previous frame's surfaces of one view with their mip chain, and the mip chain of this frame's candidates to compare
/// them with.
#[derive(Clone, Copy)]
pub(super) struct PastSurfaces<'a> {
    pub words: &'a [[u32; 2]],
    pub noise: &'a [u32],
    /// Empty unless frames have alpha.
    pub alpha: &'a [f32],
    /// Empty unless frames have albedo.
    pub albedo: &'a [u32],
    pub mip_chain: Option<&'a MipChain>,
    pub candidates: Option<&'a MipChain>,
}

/// This frame's surfaces of one view, with their noise, alpha and albedo, which are empty where there is none.
pub(super) struct NextSurfaces<'a> {
    pub words: &'a mut [[u32; 2]],
    pub noise: &'a mut [u32],
    pub alpha: &'a mut [f32],
    pub albedo: &'a mut [u32],
}
