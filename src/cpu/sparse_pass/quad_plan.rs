//! Plan of a frame shaded by quads: its regions, the even pattern, and the quads that history needs most. Mathematics:
//! `src/kernel/quads.rs`.

use super::quads::Quads;
use super::view::View;
use crate::context::ContextDesc;
use crate::cpu::Frame;
use crate::cpu::history::History;
use crate::cpu::inputs::Inputs;
use crate::foveation::Foveation;
use crate::frame::Reset;
use crate::image::Image;
use crate::kernel::antialias::mean_of;
use crate::kernel::color::luma;
use crate::kernel::noise::noise_need;
use crate::kernel::quads::{
    ENOUGH_SAMPLES, IN_FOVEA, IN_MIDDLE, IN_PERIPHERY, KEYS, WHOLE, acuity, asked_px, in_pattern, in_turn, need,
    no_history_need, place_in_quad, quad_key, region, share_in_block, threshold,
};
use crate::kernel::resample::{has_code, tap_codes};
use crate::kernel::sanitize;
use crate::kernel::smr::root_difference;
use crate::kernel::stored_sample::{code_word, is_empty, unpack_full};
use crate::kernel::wrs::expose;
use crate::method::HistoryLayout;
use crate::notes::NoNotes;
use glam::Vec3;

/// Whether a frame shades one pixel of each quad, because nothing is known of its predecessor.
pub(in crate::cpu) fn is_quarter(desc: &ContextDesc, history: &History, frame: &Frame<'_>) -> bool {
    let starts = frame.reset != Reset::None || !history.is_filled();
    let has_memory = matches!(history.layout(), HistoryLayout::Sparse { .. });
    starts && has_memory && desc.settings.foveation.takes_quarter()
}

/// Quads to shade, view by view.
pub(in crate::cpu) fn plan_quads(desc: &ContextDesc, history: &History, frame: &Frame<'_>) -> Vec<Quads> {
    let is_quarter = is_quarter(desc, history, frame);
    let foveation = if is_quarter { desc.settings.foveation.after_cut() } else { desc.settings.foveation };
    let of_view = |i: usize| {
        let inputs = Inputs::new(desc, frame, i, &history.state_after(i, frame), history.is_filled());
        let has_memory = matches!(history.layout(), HistoryLayout::Sparse { .. });
        let view = View::new(desc, frame, inputs, history.sparse(i), history.sparse_noise(i));
        view.plan_quads(&foveation, frame.index, has_memory)
    };
    (0..frame.views.len()).map(of_view).collect()
}

/// Quads of a frame whose pixels the renderer chose itself, view by view.
pub(in crate::cpu) fn given_quads(desc: &ContextDesc, masks: &[&Image<f32>]) -> Vec<Quads> {
    let levels = Quads::levels(&desc.settings.foveation, desc.settings.noisy);
    let [width, height] = desc.size_px;
    let size = desc.size_px.map(|side| side.div_ceil(2));
    let of_view = |mask: &&Image<f32>| {
        let masks = Image::from_fn_parallel(size, |[x, y]| {
            let is_outside = |u: u32, v: u32| u >= width || v >= height;
            let of = |place: u32| {
                let (u, v) = (2 * x + (place & 1), 2 * y + (place >> 1));
                is_outside(u, v) || mask.at(u as usize, v as usize) > 0.5
            };
            let all = (0..4).fold(0, |all, place| all | u32::from(of(place)) << place);
            let inside = (0..4).filter(|place| !is_outside(2 * x + (place & 1), 2 * y + (place >> 1)));
            // A quad at the frame's edge is whole with its pixels inside.
            if all == WHOLE { WHOLE } else { all & inside.fold(0, |all, place| all | 1 << place) }
        });
        Quads::new(desc.size_px, masks, Image::filled(size, IN_PERIPHERY), levels)
    };
    masks.iter().map(of_view).collect()
}

impl View<'_> {
    /// Chooses the quads of a frame. `has_memory`: whether the method has history to choose by.
    fn plan_quads(&self, foveation: &Foveation, index: u64, has_memory: bool) -> Quads {
        let size = self.inputs.size.map(|side| side.div_ceil(2));
        let radii = [foveation.fovea_radius_deg(), foveation.mid_radius_deg()];
        let regions = Image::from_fn_parallel(size, |[x, y]| {
            let e_deg = self.inputs.region_angle_deg(self.inputs.ray(2 * x, 2 * y));
            region(e_deg, radii[0], radii[1])
        });
        let pattern = Pattern::new(foveation, index);
        let even = Image::from_fn_parallel(size, |quad| {
            let region = regions.at(quad[0] as usize, quad[1] as usize);
            let alone = (foveation.single_pixels && region != IN_FOVEA).then(|| pattern.place(region));
            self.is_visible_quad(quad, alone) && pattern.has(quad, region)
        });
        let first = Foveation::first_quad(index);
        let needs = Image::from_fn_parallel(size, |quad| {
            let [x, y] = quad.map(|v| v as usize);
            if !has_memory || even.at(x, y) || regions.at(x, y) == IN_FOVEA { 0.0 } else { self.need_of(quad, first) }
        });
        let keys = Image::from_fn_parallel(size, |[x, y]| {
            let in_block = [0, 1, 2, 3].map(|i| [x & !1 | i & 1, y & !1 | i >> 1]);
            let is_inside = |[u, v]: [u32; 2]| u < size[0] && v < size[1];
            let of_block = in_block.map(|q| if is_inside(q) { needs.at(q[0] as usize, q[1] as usize) } else { 0.0 });
            let own = x & 1 | (y & 1) << 1;
            let need = of_block[own as usize] * share_in_block(of_block, own);
            quad_key(need, x, y, self.frame_low, self.inputs.uniforms.key)
        });
        let mut counts = vec![0; KEYS as usize];
        for &key in keys.pixels() {
            counts[key as usize] += 1;
        }
        let least = threshold(&counts, foveation.budget_quads(size));
        let masks = Image::from_fn_parallel(size, |quad| {
            let [x, y] = quad.map(|v| v as usize);
            let region = regions.at(x, y);
            if !(even.at(x, y) || keys.at(x, y) >= least) {
                0
            } else if region == IN_FOVEA || !foveation.single_pixels {
                WHOLE
            } else if even.at(x, y) {
                1 << pattern.place(region)
            } else {
                1 << place_in_quad(asked_px(quad[0], quad[1], self.frame_low))
            }
        });
        Quads::new(self.inputs.size, masks, regions, Quads::levels(foveation, self.is_noisy))
    }

    /// Whether the lens shows a pixel of a quad; with `place`, that pixel.
    fn is_visible_quad(&self, [x, y]: [u32; 2], place: Option<u32>) -> bool {
        let [width, height] = self.inputs.size;
        (0..4)
            .filter(|&i| place.is_none_or(|place| place == i))
            .map(|i| [2 * x + i % 2, 2 * y + i / 2])
            .any(|[x, y]| x < width && y < height && self.inputs.is_visible(x, y))
    }

    /// Need of a quad outside the fovea. `first`: place in its block of the quad that comes first without history.
    fn need_of(&self, [x, y]: [u32; 2], first: [u32; 2]) -> f32 {
        let [width, height] = self.inputs.size;
        let [u, v] = asked_px(x, y, self.frame_low);
        if u >= width || v >= height || !self.inputs.is_visible(u, v) {
            return 0.0;
        }
        let e_deg = self.inputs.region_angle_deg(self.inputs.ray(2 * x, 2 * y));
        self.need_at([u, v]).map_or(no_history_need(x, y, first), |need| need * acuity(e_deg))
    }

    /// Need of a pixel, from the four stored samples around its previous position; `None` without history.
    fn need_at(&self, [x, y]: [u32; 2]) -> Option<f32> {
        let inputs = &self.inputs;
        if inputs.reset || self.words.is_empty() {
            return None;
        }
        let motion = inputs.motion(x, y);
        let trusted = inputs.trust(x, y).is_none_or(|trust| sanitize::trust(trust) > 0.0);
        if inputs.nearest(x, y, motion, &mut NoNotes).is_err() || !trusted {
            return None;
        }
        let codes = tap_codes(inputs.expected_disparity(x, y, inputs.disparity(x, y)));
        let at = [x as f32 + motion[0], y as f32 + motion[1]];
        let first = at.map(|v| v.floor());
        let mut best = (f32::MAX, -1.0, ENOUGH_SAMPLES);
        let mut nearest = ([0; 2], Vec3::ZERO);
        let (mut low, mut high) = (Vec3::splat(f32::MAX), Vec3::ZERO);
        for tap in 0..4 {
            let [tx, ty] = [first[0] + (tap & 1) as f32, first[1] + (tap >> 1) as f32];
            let words = self.stored_words(tx as i32, ty as i32);
            if is_empty(words) || (inputs.tests_depth() && !has_code(code_word(words), codes)) {
                continue;
            }
            let stored = unpack_full(words);
            (low, high) = (low.min(stored.color), high.max(stored.color));
            let px2 = (tx - at[0]) * (tx - at[0]) + (ty - at[1]) * (ty - at[1]);
            if px2 < best.0 {
                nearest = ([tx as i32, ty as i32], stored.color);
                let mean = mean_of(stored.lod);
                best = if self.antialiases { (px2, mean.lod, mean.samples) } else { (px2, stored.lod, ENOUGH_SAMPLES) };
            }
        }
        if best.1 < 0.0 {
            return None;
        }
        if self.is_noisy {
            let (texel, color) = nearest;
            let error = noise_need(self.stored_noise(texel), luma(expose(color, self.inputs.exposure)));
            return Some(need(best.1, ENOUGH_SAMPLES, root_difference(low, high)) + error);
        }
        Some(need(best.1, best.2, root_difference(low, high)))
    }
}

/// The even pattern of a frame.
struct Pattern {
    /// Distance of its quads in quads, in the middle region and in the periphery.
    steps: [u32; 2],
    offsets: [[u32; 2]; 2],
    /// Numbers of its pixels in their quads.
    places: [u32; 2],
    turn: u32,
}

impl Pattern {
    fn new(foveation: &Foveation, index: u64) -> Self {
        let steps = [foveation.rate_mid, foveation.rate_far].map(|rate| rate / 2);
        let [mid_x, mid_y, far_x, far_y] = foveation.pattern_px(index);
        let offsets = [[mid_x / 2, mid_y / 2], [far_x / 2, far_y / 2]];
        let places = [place_in_quad([mid_x, mid_y]), place_in_quad([far_x, far_y])];
        Self { steps, offsets, places, turn: (index & 1) as u32 }
    }

    fn place(&self, region: u32) -> u32 {
        self.places[usize::from(region != IN_MIDDLE)]
    }

    fn has(&self, [x, y]: [u32; 2], region: u32) -> bool {
        match region {
            IN_FOVEA => true,
            IN_MIDDLE => in_pattern(x, y, self.steps[0], self.offsets[0]),
            _ => in_pattern(x, y, self.steps[1], self.offsets[1]) && in_turn(x, y, self.steps[1], self.turn),
        }
    }
}
