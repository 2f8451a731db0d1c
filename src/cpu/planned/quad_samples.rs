//! Samples of shaded quads: their comparison with history, gain and fit around them, and candidates of pixels.

use super::candidate::{Candidate, note_sample};
use super::rectification::{Neighbour, observed_around, votes};
use super::view::{Samples, View};
use crate::cpu::quads::{Quads, offset_px2};
use crate::kernel::candidate::{
    NoisySums, add_noisy, add_sample, has_surface, no_samples, noisy_mean, sample_codes, sample_weight,
};
use crate::kernel::demodulation::{AlbedoChange, add_albedo, candidate_change, no_albedos};
use crate::kernel::depth::INVALID_DISPARITY;
use crate::kernel::noise::{NoiseSum, add_noise, mean_noise};
use crate::kernel::pack::has_code;
use crate::kernel::quads::WHOLE;
use crate::kernel::reconstruction::{
    LIGHT_RELATIVE, Observation, QuadRectification, add_observation, center_fit, fit_around, fit_by_votes, is_observed,
    mean_observation, neighbour_weight, no_observation, noisy_fit_around, none_around, pack_observation,
    pack_rectification, quad_code, spatial_weight, unpack_observation, unpack_rectification,
};
use crate::kernel::sanitize;
use crate::notes::Notes;
use crate::parallel::collect;
use glam::{Vec3, Vec4};

/// Rectification of history at the shaded quads, quad by quad ([`pack_rectification`]).
pub(super) type RectifiedQuads = Vec<[u32; 4]>;

impl View<'_> {
    /// Pixels of a quad inside the frame.
    #[inline(always)]
    pub(super) fn pixels_of(&self, [x, y]: [u32; 2]) -> impl Iterator<Item = [u32; 2]> + use<> {
        let [width, height] = self.inputs.size;
        (0..4).map(move |i| [2 * x + i % 2, 2 * y + i / 2]).filter(move |px| px[0] < width && px[1] < height)
    }

    /// Color of a pixel, and whether it is usable.
    #[inline(always)]
    pub(super) fn color_px(&self, quads: &Quads, px: [u32; 2]) -> (Vec3, bool) {
        let is_whole = quads.mask(px.map(|v| v / 2)) == WHOLE;
        sanitize::color(if is_whole { self.inputs.color_at(px) } else { self.inputs.partial_color_at(px) })
    }

    /// Comparisons of the pixels of shaded quads outside the fovea, pixel by pixel.
    pub(super) fn observe_quads(&self, quads: &Quads) -> Samples {
        let [width, height] = self.inputs.size;
        collect(width * height, |i| {
            let px = [i % width, i / width];
            let level = quads.level_at(px);
            if level == 0 || !quads.is_shaded(px) {
                return pack_observation(no_observation());
            }
            let (sampled, usable) = self.color_px(quads, px);
            pack_observation(self.observe_px(px, level, sampled, usable).unwrap_or_else(no_observation))
        })
    }

    #[inline(always)]
    pub(super) fn observation_px(&self, quads: &Quads, px: [u32; 2], observed: &Samples) -> Option<Observation> {
        let words = observed[(px[1] * self.inputs.size[0] + px[0]) as usize];
        is_observed(words).then(|| unpack_observation(words, self.color_px(quads, px).0))
    }

    /// Gain and fit around each shaded quad. Quads of the fovea are not compared.
    pub(super) fn rectify_quads(&self, quads: &Quads, observed: &Samples) -> RectifiedQuads {
        let [columns, rows] = quads.size();
        let blocks = self.block_gains(quads, observed);
        collect(columns * rows, |i| {
            let quad = [i % columns, i / columns];
            if quads.mask(quad) == 0 {
                return [0; 4];
            }
            self.rectify_quad(quads, quad, observed, blocks.of_quad(quad))
        })
    }

    fn rectify_quad(&self, quads: &Quads, quad: [u32; 2], observed: &Samples, of_block: Vec3) -> [u32; 4] {
        // The quad's own comparison is the mean over the surface of its first compared pixel.
        let first = self.pixels_of(quad).find(|&px| self.observation_px(quads, px, observed).is_some());
        let disparity_of = |[x, y]: [u32; 2]| self.inputs.disparity(x, y);
        let disparity = disparity_of(first.unwrap_or(quad.map(|v| 2 * v)));
        let alike = |px: [u32; 2]| self.alike(disparity, disparity_of(px), LIGHT_RELATIVE);
        let mut own = no_observation();
        if first.is_some() {
            let all =
                self.pixels_of(quad).filter(|&px| alike(px)).filter_map(|px| self.observation_px(quads, px, observed));
            let mut sum = none_around();
            let mut confidence = 0.0;
            for o in all {
                sum = add_observation(sum, o, 1.0, 1.0);
                confidence += o.confidence;
            }
            own = mean_observation(sum, confidence);
        }
        let is_own = own.error >= 0.0;
        let distance2 = |other: [u32; 2]| offset_px2(other[0], quad[0]) + offset_px2(other[1], quad[1]);
        let least = quads.around(quad).map(distance2).fold(f32::MAX, f32::min);
        let mut near: Vec<Neighbour> = vec![];
        let is_compared = quads.level_at(quad.map(|v| 2 * v)) > 0;
        let mut others = 0;
        for other in quads.around(quad).chain([quad]).filter(|_| is_compared) {
            others = near.len();
            let spatial = spatial_weight(distance2(other), least);
            for px in self.pixels_of(other) {
                let Some(observation) = self.observation_px(quads, px, observed) else { continue };
                if alike(px) {
                    near.push((observation, neighbour_weight(own, observation, spatial), spatial));
                }
            }
        }
        let near = || near.iter().copied();
        let around = observed_around(near());
        // A single noisy sample does not show whether history fits.
        let fit_of_own = |o, gain| if self.is_noisy { 1.0 } else { center_fit(o, gain) };
        let (mut gain, mut fits) = (Vec3::ONE, 1.0);
        if around.weight >= 1e-6 {
            let (relit, left) = self.relit_around(around, near, of_block);
            gain = relit;
            fits = if self.is_noisy {
                noisy_fit_around(around, left)
            } else {
                let fit_of_quad = if is_own { center_fit(own, Vec3::ONE) } else { 0.0 };
                fit_around(around, left, fit_by_votes(around, votes(near().take(others)), fit_of_quad))
            };
        }
        let mut center_fits = [1.0; 4];
        let mut disparities = [INVALID_DISPARITY; 4];
        for px in self.pixels_of(quad) {
            let i = (px[0] & 1 | (px[1] & 1) << 1) as usize;
            center_fits[i] = self.observation_px(quads, px, observed).map_or(1.0, |own| fit_of_own(own, gain));
            disparities[i] = disparity_of(px);
        }
        pack_rectification(QuadRectification { gain, fit: fits, center_fits, is_own, disparities })
    }

    /// Candidate of a pixel, and its gain and fit, from the shaded quads around it.
    #[inline(always)]
    pub(super) fn quad_candidate<N: Notes>(
        &self,
        quads: &Quads,
        px: [u32; 2],
        disparity: f32,
        rectified: &RectifiedQuads,
        notes: &mut N,
    ) -> Candidate {
        let level = quads.level_at(px);
        let is_shaded = quads.is_shaded(px);
        if level == 0 {
            if !is_shaded {
                return Candidate::NONE;
            }
            let (color, usable) = self.color_px(quads, px);
            let alpha = if usable { self.alpha_at(px) } else { 1.0 };
            let albedo = if usable { AlbedoChange::none(self.albedo_at(px).truncate()) } else { AlbedoChange::NONE };
            return Candidate { color, usable, alpha, is_own: usable, albedo, ..Candidate::NONE };
        }
        let codes = sample_codes(disparity);
        let (mut sums, mut own) = (no_samples(), None);
        let columns = quads.size()[0];
        let mut noises = NoiseSum::default();
        let own_albedo = self.albedo_at(px);
        let mut albedos = no_albedos(own_albedo.truncate());
        let mut add = |at: [u32; 2]| {
            let (color, usable) = self.color_px(quads, at);
            if !usable {
                return;
            }
            let words = rectified[Quads::index(at.map(|v| v / 2), columns)];
            let place = at[0] & 1 | (at[1] & 1) << 1;
            let r = unpack_rectification(words, place);
            let alike = !self.inputs.tests_depth() || has_code(quad_code(words, place), codes);
            let px2 = offset_px2(at[0], px[0]) + offset_px2(at[1], px[1]);
            let weight = sample_weight(px2, alike);
            let alpha = self.alpha_at(at);
            sums = add_sample(sums, color, alpha, r, weight, px2, alike);
            if self.albedo.is_some() {
                albedos = add_albedo(albedos, own_albedo, self.albedo_at(at), color, weight);
            }
            if N::ON {
                note_sample(notes, at, weight, color, r, self.observe_px(at, level, color, usable));
            }
            if self.is_noisy {
                noises = add_noise(noises, self.sample_noise(at), weight);
            }
            if at == px {
                own = Some((color, alpha, r.center_fit));
            }
        };
        quads.samples_around(px).for_each(&mut add);
        let mut candidate = Candidate::of_samples(sums, level as f32, own);
        if self.albedo.is_some() && candidate.is_own {
            candidate.albedo = AlbedoChange::none(own_albedo.truncate());
        } else if self.albedo.is_some() && candidate.usable {
            let change = candidate_change(albedos, own_albedo, has_surface(sums));
            candidate = candidate.textured(change);
        }
        if self.is_noisy && candidate.usable {
            candidate.noise = if candidate.is_own { self.sample_noise(px) } else { mean_noise(noises) };
        }
        if self.is_noisy && candidate.is_own {
            candidate.around = self.mean_around(quads, px, codes, rectified);
        }
        candidate
    }

    /// Mean of the samples around a noisy pixel with a sample, its own included, and the mean variance of one.
    #[inline(always)]
    fn mean_around(&self, quads: &Quads, px: [u32; 2], codes: [u32; 2], rectified: &RectifiedQuads) -> Vec4 {
        let mut sums = NoisySums::default();
        for at in quads.all_samples_around(px) {
            let (color, usable) = self.color_px(quads, at);
            let words = rectified[Quads::index(at.map(|v| v / 2), quads.size()[0])];
            let place = at[0] & 1 | (at[1] & 1) << 1;
            let alike = !self.inputs.tests_depth() || has_code(quad_code(words, place), codes);
            if usable && (alike || at == px) {
                let px2 = offset_px2(at[0], px[0]) + offset_px2(at[1], px[1]);
                sums = add_noisy(sums, color, self.sample_noise(at), px2);
            }
        }
        noisy_mean(sums)
    }
}
