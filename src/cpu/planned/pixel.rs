//! Reconstruction of pixels from history, and from the samples around them and their light.

use super::albedo::Untextured;
use super::quad_samples::QuadLights;
use super::sparse_history::{Found, Source};
use super::view::{NO_NOISE, View};
use crate::cpu::pixel::{Pixel, ProcessPixel};
use crate::cpu::quads::Quads;
use crate::kernel::antialias::{Mean, average_beside, expected_mean_error, stored_mean, with_regular_run};
use crate::kernel::approx;
use crate::kernel::color::root_difference;
use crate::kernel::debug_view::PixelTrace;
use crate::kernel::noise::pack_noise;
use crate::kernel::reproject::Verdict;
use crate::kernel::sanitize;
use crate::kernel::sparse_smr::{Reconstructed, Reconstruction, accumulate, reconstruct, relit, result_alpha, worn};
use crate::kernel::stored_sample::{StoredSample, has_moved, pack_stored, with_motion};
use crate::notes::{NoteStage, Notes};
use crate::stats::FrameStats;
use glam::{Vec2, Vec3};

/// A view, its shaded quads, and the light at them.
pub(super) struct LitView<'a> {
    pub view: &'a View<'a>,
    pub quads: &'a Quads,
    pub lights: &'a QuadLights,
}

impl ProcessPixel for LitView<'_> {
    #[inline(always)]
    fn process(&self, x: u32, y: u32, stats: &mut FrameStats, notes: &mut impl Notes) -> Pixel {
        let pixel = self.pixel(x, y, stats, notes);
        Pixel { output: self.view.inputs.unexposed(pixel.output), ..pixel }
    }
}

impl LitView<'_> {
    #[inline(always)]
    fn pixel<N: Notes>(&self, x: u32, y: u32, stats: &mut FrameStats, notes: &mut N) -> Pixel {
        let Self { view, quads, lights } = *self;
        let inputs = &view.inputs;
        if !inputs.is_visible(x, y) {
            // Outside the visible area: black, without stored history.
            let (surface, noise) = (pack_stored(StoredSample::EMPTY), pack_noise(NO_NOISE));
            let trace = PixelTrace::default();
            return Pixel { output: Vec3::ZERO, surface, noise, alpha: [1.0; 2], albedo: 0, trace };
        }
        let disparity = inputs.disparity(x, y);
        let level = quads.level_at([x, y]);
        let mut candidate = view.quad_candidate(quads, [x, y], disparity, lights, notes);
        let surface = view.surface([x, y], level);
        candidate.note(notes);
        surface.note(notes);
        let source = view.source([x, y], &surface, notes);
        let is_final = candidate.usable && level == 0 && !view.is_noisy && !view.antialiases;
        let history = source
            .as_ref()
            .ok()
            .filter(|_| !is_final)
            .map(|source| view.interpolated(source, view.past_albedos([x, y]), notes));
        let history = history.filter(|found| found.history.lod >= 0.0);
        let verdict = match &source {
            Err(verdict) => *verdict,
            Ok(Source { is_same: false, .. }) if history.is_none() => Verdict::Disoccluded,
            Ok(_) => Verdict::Valid,
        };
        inputs.count(x, y, candidate.usable, disparity, verdict, stats);
        if view.is_noisy && candidate.is_own {
            candidate = candidate.borrowing(history.as_ref().map_or(0.0, |found| found.noise.samples));
        }

        let is_near = view.antialiases && candidate.is_own && level == 0;
        let near = is_near.then(|| view.near(quads, [x, y], candidate.color));
        // Without history the samples around antialias alone.
        let change = view.centred_change(near);
        let mut output = candidate.color + change.unwrap_or(Vec3::ZERO);
        if change.is_some() {
            notes.note(NoteStage::Candidate, "samples around at the pixel's centre", output, "linear light");
        }
        let is_placed = view.antialiases && candidate.is_own && change.is_none();
        let mut stored = StoredSample {
            color: output,
            lod: if candidate.usable { candidate.lod } else { -1.0 },
            disparity: surface.stored,
            place_px: if is_placed { view.sample_place_px() } else { Vec2::ZERO },
        };
        let mut mean = Mean::ONE;
        let (mut share, mut fits) = (0.0, 1.0);
        let mut noise = candidate.noise;
        // To show, and to store.
        let mut alpha = [candidate.alpha; 2];
        let mut albedos = None;
        let mut result = Reconstructed { color: output, stored, share: 0.0, keeps_nearest: false, stored_share: 0.0 };
        if let (Ok(Source { previous, .. }), Some(found)) = (source, history) {
            let Found { history, noise: past, mean: past_mean, alpha: past_alpha, albedos: past_albedos } = found;
            albedos = past_albedos;
            if !candidate.usable {
                (output, share, noise, mean, alpha) = (history.color, 1.0, past, past_mean, past_alpha);
                stored = StoredSample { disparity: surface.stored, ..history.nearest };
                result = Reconstructed { color: output, stored, share, keeps_nearest: true, stored_share: 1.0 };
            } else {
                let moved = match view.antialiases {
                    true => has_moved(surface.motion.into(), Vec2::ZERO),
                    false => has_moved(Vec2::ZERO, history.nearest.place_px),
                };
                let inputs = Reconstruction {
                    candidate: candidate.color,
                    lod: candidate.lod,
                    range: candidate.range,
                    history: history.color,
                    history_lod: history.lod,
                    nearest: history.nearest,
                    worn: worn(moved, view.antialiases),
                    gain: candidate.gain,
                    fit: candidate.fit,
                    trust: previous.trust,
                    accumulate: view.accumulate,
                };
                if N::ON {
                    let history = relit(inputs.history, inputs.gain, inputs.range);
                    notes.note(NoteStage::Light, "history after the gain", history, "linear light");
                    notes.note(NoteStage::Decision, "fit", inputs.fit, "");
                }
                result = if view.is_noisy {
                    let accumulated = accumulate(&inputs, past, candidate.noise);
                    noise = accumulated.noise;
                    accumulated.result
                } else if view.antialiases {
                    let contrast = root_difference(history.range[0], history.range[1]);
                    let error = expected_mean_error(past_mean, contrast, moved);
                    let beside = candidate.beside.filter(|_| surface.is_moving_edge && inputs.nearest.lod <= 0.0);
                    let averaged = if candidate.is_own {
                        let past = with_regular_run(past_mean, level);
                        view.averaged(near, surface.is_moving_edge, inputs, past, error, notes)
                    } else if let Some(beside) = beside {
                        notes.note(NoteStage::Decision, "sample beside the pixel", beside, "linear light");
                        let inputs = Reconstruction { candidate: beside, ..inputs };
                        average_beside(&inputs, past_mean, view.sample_place_px())
                    } else {
                        stored_mean(&inputs, reconstruct(&inputs), past_mean)
                    };
                    mean = averaged.mean;
                    averaged.result
                } else {
                    reconstruct(&inputs)
                };
                alpha = result_alpha(result, candidate.alpha, past_alpha[0], past_alpha[1]).into();
                (output, share, fits) = (result.color, result.share, candidate.fit);
                stored = StoredSample { disparity: surface.stored, ..result.stored };
            }
        }
        let (of_candidate, samples) = (candidate.albedo.albedo, mean.samples);
        let retextured = view.retexture(&Untextured {
            px: [x, y],
            level,
            at_edge: surface.is_edge,
            of_candidate,
            past: albedos,
            result,
            samples,
        });
        if let Some(texture) = retextured {
            output *= texture.shown;
            stored.color *= texture.stored;
            stored.place_px += (view.sample_place_px() - stored.place_px) * texture.place_share;
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
        let stored = if view.antialiases { view.packed_mean([x, y], stored, mean) } else { pack_stored(stored) };
        let stored = with_motion(stored, surface.moved_px);
        let albedo = retextured.map_or(0, |texture| texture.word);
        Pixel { output, surface: stored, noise: pack_noise(noise), alpha, albedo, trace }
    }
}
