//! Plan of a frame shaded by quads: its regions, the even pattern, and the quads that history needs most. Mathematics:
//! `src/kernel/quads.rs`.

use super::view::View;
use crate::context::ContextDesc;
use crate::cpu::frame::Frame;
use crate::cpu::history::History;
use crate::cpu::inputs::Inputs;
use crate::cpu::quads::Quads;
use crate::foveation::Foveation;
use crate::frame::Reset;
use crate::image::Image;
use crate::kernel::antialias::{Mean, mean_of};
use crate::kernel::color::{expose, luma};
use crate::kernel::noise::{Noise, NoiseSum, add_noise, mean_noise, noise_need};
use crate::kernel::pack::tap_codes;
use crate::kernel::quads::{
    ENOUGH_SAMPLES, EvenPattern, IN_FOVEA, IN_MIDDLE, IN_PERIPHERY, KEYS, MOST_PATHS, WHOLE, acuity, is_even,
    known_samples, need_around, no_history_need, no_past, path_key, paths, place_in_quad, probed_px, quad_key, region,
    share_in_block, threshold, with_past,
};
use crate::kernel::sanitize;
use crate::kernel::stored_sample::{is_empty, unpack_full};
use crate::method::HistoryLayout;
use crate::notes::NoNotes;

/// Whether a frame shades one pixel of each quad, because nothing is known of its predecessor.
pub(crate) fn is_quarter(desc: &ContextDesc, history: &History, frame: &Frame<'_>) -> bool {
    let starts = frame.reset != Reset::None || !history.is_filled();
    let has_memory = matches!(history.layout(), HistoryLayout::Sparse { .. });
    starts && has_memory && desc.settings.foveation.takes_quarter()
}

/// Quads to shade, and the number of paths of each pixel of a quad, view by view.
pub(crate) fn plan_quads(desc: &ContextDesc, history: &History, frame: &Frame<'_>) -> Vec<(Quads, Image<u8>)> {
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
pub(crate) fn given_quads(desc: &ContextDesc, masks: &[&Image<f32>]) -> Vec<Quads> {
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
    /// Chooses the quads of a frame, and the number of paths of each of their pixels. `has_memory`: whether the method
    /// has history to choose by.
    fn plan_quads(&self, foveation: &Foveation, index: u64, has_memory: bool) -> (Quads, Image<u8>) {
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
            self.is_visible_quad(quad, alone) && is_even(pattern.quads, quad[0], quad[1], region)
        });
        let first = Foveation::first_quad(index);
        let has_budget = foveation.budget > 0.0;
        let needs = Image::from_fn_parallel(size, |quad| {
            let [x, y] = quad.map(|v| v as usize);
            let is_even = even.at(x, y);
            let is_probed = regions.at(x, y) != IN_FOVEA && (!is_even || self.is_noisy);
            if !has_memory || !has_budget || !is_probed {
                return Need::default();
            }
            let place = if is_even { pattern.place(regions.at(x, y)) } else { place_in_quad(self.probed(quad)) };
            let need = self.need_of(quad, place, first);
            Need { first: if is_even { 0.0 } else { need.first }, ..need }
        });
        let keys = Image::from_fn_parallel(size, |[x, y]| {
            let in_block = [0, 1, 2, 3].map(|i| [x & !1 | i & 1, y & !1 | i >> 1]);
            let is_inside = |[u, v]: [u32; 2]| u < size[0] && v < size[1];
            let of_block =
                in_block.map(|q| if is_inside(q) { needs.at(q[0] as usize, q[1] as usize).first } else { 0.0 });
            let own = x & 1 | (y & 1) << 1;
            let Need { noise, samples, .. } = needs.at(x as usize, y as usize);
            let first = of_block[own as usize] * share_in_block(of_block, own);
            let is_even = even.at(x as usize, y as usize);
            let key = |need: f32| quad_key(need, x, y, self.frame_low, self.inputs.uniforms.key);
            PathKeys { first: key(if is_even { 0.0 } else { first + noise }), further: key(noise), samples }
        });
        let mut counts = vec![0; KEYS as usize];
        for &PathKeys { first, further, samples } in keys.pixels() {
            counts[first as usize] += 1;
            let of_paths = (2..=MOST_PATHS).map(|path| path_key(further, samples, path));
            of_paths.take_while(|&key| key > 0).for_each(|key| counts[key as usize] += 1);
        }
        let least = threshold(&counts, foveation.budget_quads(size));
        let masks = Image::from_fn_parallel(size, |quad| {
            let [x, y] = quad.map(|v| v as usize);
            let region = regions.at(x, y);
            if !(even.at(x, y) || keys.at(x, y).first >= least) {
                0
            } else if region == IN_FOVEA || !foveation.single_pixels {
                WHOLE
            } else if even.at(x, y) {
                1 << pattern.place(region)
            } else {
                1 << place_in_quad(probed_px(quad[0], quad[1], self.frame_low))
            }
        });
        let of_quads = Image::from_fn_parallel(size, |[x, y]| {
            let PathKeys { first, further, samples } = keys.at(x as usize, y as usize);
            paths(first, further, samples, even.at(x as usize, y as usize), least) as u8
        });
        (Quads::new(self.inputs.size, masks, regions, Quads::levels(foveation, self.is_noisy)), of_quads)
    }

    /// The pixel of a quad that is tested.
    fn probed(&self, [x, y]: [u32; 2]) -> [u32; 2] {
        probed_px(x, y, self.frame_low)
    }

    /// Whether the lens shows a pixel of a quad; with `place`, that pixel.
    fn is_visible_quad(&self, [x, y]: [u32; 2], place: Option<u32>) -> bool {
        let [width, height] = self.inputs.size;
        (0..4)
            .filter(|&i| place.is_none_or(|place| place == i))
            .map(|i| [2 * x + i % 2, 2 * y + i / 2])
            .any(|[x, y]| x < width && y < height && self.inputs.is_visible(x, y))
    }

    /// Need of the pixel `place` of a quad outside the fovea. `first`: place in its block of the quad that comes first
    /// without history.
    fn need_of(&self, [x, y]: [u32; 2], place: u32, first: [u32; 2]) -> Need {
        let [width, height] = self.inputs.size;
        let [u, v] = [2 * x + (place & 1), 2 * y + (place >> 1)];
        if u >= width || v >= height || !self.inputs.is_visible(u, v) {
            return Need::default();
        }
        let e_deg = self.inputs.region_angle_deg(self.inputs.ray(2 * x, 2 * y));
        let counts = acuity(e_deg);
        let of_history = |need: Need| Need { first: need.first * counts, noise: need.noise * counts, ..need };
        let without = Need { first: no_history_need(x, y, first), ..Need::default() };
        self.need_at([u, v]).map_or(without, of_history)
    }

    /// Need of a pixel, from the four stored samples around its previous position; `None` without history.
    fn need_at(&self, [x, y]: [u32; 2]) -> Option<Need> {
        let inputs = &self.inputs;
        if inputs.reset || self.words.is_empty() {
            return None;
        }
        let motion = inputs.motion(x, y);
        let trusted = inputs.trust(x, y).is_none_or(|trust| sanitize::trust(trust) > 0.0);
        if inputs.nearest(x, y, motion, &mut NoNotes).is_err() || !trusted {
            return None;
        }
        let disparity = inputs.disparity(x, y);
        let codes = tap_codes(inputs.expected_disparity(x, y, disparity));
        let moved_px = inputs.moved_px([x, y], disparity, motion);
        let at = [x as f32 + motion[0], y as f32 + motion[1]];
        let first = at.map(|v| v.floor());
        let mut around = no_past();
        let mut nearest = [0; 2];
        let mut noises = NoiseSum::default();
        for tap in 0..4 {
            let [tx, ty] = [first[0] + (tap & 1) as f32, first[1] + (tap >> 1) as f32];
            let texel = [tx as i32, ty as i32];
            let words = self.stored_words(texel[0], texel[1]);
            if is_empty(words) || !self.is_reusable(words, codes, moved_px) {
                continue;
            }
            let stored = unpack_full(words);
            let px2 = (tx - at[0]) * (tx - at[0]) + (ty - at[1]) * (ty - at[1]);
            if self.is_noisy {
                noises = add_noise(noises, self.stored_noise(texel), 1.0);
            }
            if px2 < around.nearest_px2 {
                nearest = texel;
            }
            let mean = match self.antialiases {
                true => mean_of(stored.lod),
                false => Mean { lod: stored.lod, samples: ENOUGH_SAMPLES, ..Mean::ONE },
            };
            around = with_past(around, stored.color, mean.lod, mean.samples, px2);
        }
        let first = need_around(around);
        if first < 0.0 {
            return None;
        }
        if !self.is_noisy {
            return Some(Need { first, noise: 0.0, samples: 1 });
        }
        let own = self.stored_noise(nearest);
        // The variance of few samples is uncertain: the mean of all four takes its place.
        let past = Noise { variance: mean_noise(noises).variance, ..own };
        let noise = noise_need(past, luma(expose(around.color, inputs.exposure)));
        Some(Need { first, noise, samples: known_samples(own.samples) })
    }
}

/// Need of a pixel.
#[derive(Clone, Copy, Debug)]
struct Need {
    /// Of a first path, without the noise of history.
    first: f32,
    /// Due to the noise of history, of a first path.
    noise: f32,
    /// Samples of history, from 1 on.
    samples: u32,
}

impl Default for Need {
    fn default() -> Self {
        Self { first: 0.0, noise: 0.0, samples: 1 }
    }
}

/// Keys of the paths of a quad's pixel: see [`paths`].
#[derive(Clone, Copy, Debug, Default)]
struct PathKeys {
    first: u32,
    further: u32,
    samples: u32,
}

/// The even pattern of a frame.
struct Pattern {
    quads: EvenPattern,
    /// Numbers of its pixels in their quads, in the middle region and in the periphery.
    places: [u32; 2],
}

impl Pattern {
    fn new(foveation: &Foveation, index: u64) -> Self {
        let [mid_x, mid_y, far_x, far_y] = foveation.pattern_px(index);
        let quads = EvenPattern {
            steps: [foveation.rate_mid, foveation.rate_far].map(|rate| rate / 2),
            middle: [mid_x / 2, mid_y / 2],
            periphery: [far_x / 2, far_y / 2],
            turn: (index & 1) as u32,
        };
        Self { quads, places: [place_in_quad([mid_x, mid_y]), place_in_quad([far_x, far_y])] }
    }

    fn place(&self, region: u32) -> u32 {
        self.places[usize::from(region != IN_MIDDLE)]
    }
}
