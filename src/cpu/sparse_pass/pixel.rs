//! Reconstruction of pixels from history, and from the samples around them and their light.

use super::candidate::{Candidate, Sums, note_sample, sample_codes};
use super::quad_samples::QuadLights;
use super::quads::offset_px2;
use super::sparse_history::{Found, Source, has_moved};
use super::view::{NO_NOISE, Samples, View};
use crate::cpu::pixel::{Pixel, ProcessPixel};
use crate::kernel::antialias::{Mean, expected_mean_error, stored_mean};
use crate::kernel::approx;
use crate::kernel::debug_view::PixelTrace;
use crate::kernel::lattice::point_weight;
use crate::kernel::noise::{NoiseSum, add_noise, mean_noise, pack_noise};
use crate::kernel::reproject::Verdict;
use crate::kernel::resample::has_code;
use crate::kernel::sanitize;
use crate::kernel::smr::root_difference;
use crate::kernel::sparse_smr::{LEAST_SHARE, Reconstruction, accumulate, reconstruct, relit, unpack_lit, worn};
use crate::kernel::stored_sample::{StoredSample, pack_stored};
use crate::notes::{NoteStage, Notes};
use crate::stats::FrameStats;
use crate::uniforms::LatticeUniforms;
use glam::{Vec2, Vec3};

/// A view, and the light at its samples.
pub(super) struct LitView<'a> {
    pub view: &'a View<'a>,
    pub lights: Lights<'a>,
}

/// Light at the samples of a view.
#[derive(Clone, Copy)]
pub(super) enum Lights<'a> {
    Lattices(&'a [Samples]),
    Quads(&'a QuadLights),
}

impl ProcessPixel for LitView<'_> {
    #[inline(always)]
    fn process(&self, x: u32, y: u32, stats: &mut FrameStats, notes: &mut impl Notes) -> Pixel {
        let pixel = self.view.pixel(x, y, self.lights, stats, notes);
        Pixel { output: self.view.inputs.unexposed(pixel.output), ..pixel }
    }
}

impl View<'_> {
    #[inline(always)]
    fn pixel<N: Notes>(&self, x: u32, y: u32, lights: Lights<'_>, stats: &mut FrameStats, notes: &mut N) -> Pixel {
        let inputs = &self.inputs;
        if !inputs.is_visible(x, y) {
            // Outside the visible area: black, without stored history.
            let (surface, noise) = (pack_stored(StoredSample::EMPTY), pack_noise(NO_NOISE));
            return Pixel { output: Vec3::ZERO, surface, noise, trace: PixelTrace::default() };
        }
        let disparity = inputs.disparity(x, y);
        let level = self.level_at([x, y]);
        let candidate = match (lights, self.quads) {
            (Lights::Quads(lights), Some(quads)) => self.quad_candidate(quads, [x, y], disparity, lights, notes),
            (Lights::Lattices(lights), _) => {
                self.candidate(LatticeUniforms::index_at(&self.lattices, [x, y]), [x, y], disparity, lights, notes)
            }
            (Lights::Quads(_), None) => Candidate::NONE,
        };
        let mut candidate = candidate;
        candidate.noise.samples *= (candidate.lod * super::quad_plan::tune(9, 0.0)).exp2();
        if self.is_noisy {
            candidate.fit = candidate.fit.max(super::quad_plan::tune(11, 0.0));
        }
        let surface = self.surface([x, y], level);
        candidate.note(notes);
        surface.note(notes);
        let source = self.source([x, y], &surface, notes);
        let is_final = candidate.usable && level == 0 && !self.is_noisy && !self.antialiases;
        let history = source.as_ref().ok().filter(|_| !is_final).map(|source| self.interpolated(source, notes));
        let history = history.filter(|found| found.history.lod >= 0.0);
        let verdict = match &source {
            Err(verdict) => *verdict,
            Ok(Source { is_same: false, .. }) if history.is_none() => Verdict::Disoccluded,
            Ok(_) => Verdict::Valid,
        };
        inputs.count(x, y, candidate.usable, disparity, verdict, stats);

        let mut output = candidate.color;
        let mut stored = StoredSample {
            color: candidate.color,
            lod: if candidate.usable { candidate.lod } else { -1.0 },
            disparity: surface.stored,
            place_px: if self.antialiases && candidate.is_own { self.sample_place_px() } else { Vec2::ZERO },
        };
        let mut mean = Mean::ONE;
        let (mut share, mut fits) = (0.0, 1.0);
        let mut noise = candidate.noise;
        if let (Ok(Source { previous, .. }), Some(found)) = (source, history) {
            let Found { history, noise: past, mean: past_mean } = found;
            if !candidate.usable {
                (output, share, noise, mean) = (history.color, 1.0, past, past_mean);
                stored = StoredSample { disparity: surface.stored, ..history.nearest };
            } else {
                let moved = match self.antialiases {
                    true => has_moved(surface.motion, Vec2::ZERO),
                    false => has_moved([0.0; 2], history.nearest.place_px),
                };
                let inputs = Reconstruction {
                    candidate: candidate.color,
                    lod: candidate.lod,
                    range: candidate.range,
                    history: history.color,
                    history_lod: history.lod,
                    nearest: history.nearest,
                    worn: worn(moved, self.antialiases),
                    gain: candidate.gain,
                    fit: candidate.fit,
                    trust: previous.trust,
                    accumulate: if self.is_noisy && !candidate.is_own {
                        super::quad_plan::tune(8, self.accumulate)
                    } else if self.is_noisy {
                        super::quad_plan::tune(10, self.accumulate)
                    } else {
                        self.accumulate
                    },
                };
                if N::ON {
                    let history = relit(inputs.history, inputs.gain, inputs.range);
                    notes.note(NoteStage::Light, "history after the gain", history, "linear light");
                    notes.note(NoteStage::Decision, "fit", inputs.fit, "");
                }
                let result = if self.is_noisy {
                    let accumulated = accumulate(&inputs, past, candidate.noise);
                    noise = accumulated.noise;
                    accumulated.result
                } else if self.antialiases {
                    let contrast = root_difference(history.range[0], history.range[1]);
                    let error = expected_mean_error(past_mean, contrast, moved);
                    let averaged = match candidate.is_own {
                        true => self.averaged([x, y], level, inputs, past_mean, error, notes),
                        false => stored_mean(&inputs, reconstruct(&inputs), past_mean),
                    };
                    mean = averaged.mean;
                    averaged.result
                } else {
                    reconstruct(&inputs)
                };
                (output, share, fits) = (result.color, result.share, candidate.fit);
                stored = StoredSample { disparity: surface.stored, ..result.stored };
            }
        }
        // Means of colors may exceed the largest half.
        output = output.clamp(Vec3::splat(-sanitize::MAX_HALF), Vec3::splat(sanitize::MAX_HALF));
        stats.replaced += u64::from(verdict == Verdict::Valid && share == 0.0);
        let trace = PixelTrace {
            verdict,
            weight: approx::exp2_approx(-candidate.lod),
            quality: approx::exp2_approx(-stored.lod.max(0.0)),
            age: 0,
            history_share: share,
            agreement: fits,
            is_replaced: share == 0.0,
            motion: surface.motion,
        };
        let stored = if self.antialiases { self.packed_mean([x, y], stored, mean) } else { pack_stored(stored) };
        Pixel { output, surface: stored, noise: pack_noise(noise), trace }
    }

    /// Candidate of a pixel, and its gain and fit, from the samples around it.
    #[inline(always)]
    fn candidate<N: Notes>(
        &self,
        index: usize,
        px: [u32; 2],
        disparity: f32,
        lights: &[Samples],
        notes: &mut N,
    ) -> Candidate {
        let lattice = &self.lattices[index];
        let Some([x, y]) = lattice.around(px) else { return Candidate::NONE };
        let is_sample = x.fraction == 0.0 && y.fraction == 0.0;
        if lattice.level == 0 {
            let (color, usable) = self.sampled(lattice, [x.points[0], y.points[0]]);
            let noise = if usable { self.sample_noise(px) } else { NO_NOISE };
            let own = Candidate { color, usable, lod: 0.0, noise, is_own: usable, ..Candidate::NONE };
            let coarser = index + 1;
            if !self.is_noisy || !usable || coarser == self.lattices.len() || self.lattices[coarser].points.contains(&0)
            {
                return own;
            }
            // The fit of history comes from the samples of the next lattice.
            return Candidate { fit: self.candidate(coarser, px, disparity, lights, notes).fit, ..own };
        }
        let mut sums = Sums::NOTHING;
        let mut noises = NoiseSum::default();
        let codes = sample_codes(disparity);
        let px2 = [(px[0], lattice.first_px[0], x.points), (px[1], lattice.first_px[1], y.points)]
            .map(|(px, first, points)| points.map(|point| offset_px2(px, first + (point << lattice.level))));
        // The pixel's own sample last, as in the shader.
        for tap in (0..4).rev() {
            let (right, below) = (tap & 1, tap >> 1);
            let point = [x.points[right as usize], y.points[below as usize]];
            let (color, usable) = self.sampled(lattice, point);
            if !usable {
                continue;
            }
            let at = lattice.px_of(point);
            let words = lights[index][(point[1] * lattice.points[0] + point[0]) as usize];
            let lit = unpack_lit(words);
            let alike = !self.inputs.tests_depth() || has_code(words[1], codes);
            let share = point_weight(x.fraction, right) * point_weight(y.fraction, below);
            let px2 = px2[0][right as usize] + px2[1][below as usize];
            let weight = sums.add(color, lit, share.max(LEAST_SHARE), px2, alike);
            if N::ON {
                note_sample(notes, at, weight, color, lit, self.observe(index, point));
            }
            if self.is_noisy {
                noises = add_noise(noises, self.sample_noise(at), weight);
            }
            if is_sample && tap == 0 && (alike || !self.antialiases || disparity < 0.0) {
                sums.own = Some((color, lit.own_fit));
            }
        }
        let mut candidate = sums.candidate(lattice.level);
        if self.is_noisy && candidate.usable {
            candidate.noise = if candidate.is_own { self.sample_noise(px) } else { mean_noise(noises) };
        }
        candidate
    }
}
