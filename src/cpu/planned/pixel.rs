//! Reconstruction of pixels from history, and from the samples around them.

use super::candidate::Candidate;
use super::quad_samples::RectifiedQuads;
use super::sparse_history::{Found, Source, Surroundings};
use super::view::{NO_NOISE, View};
use crate::cpu::pixel::{Pixel, ProcessPixel};
use crate::cpu::quads::Quads;
use crate::kernel::antialias::{
    Averaged, Mean, Near, average_beside, expected_mean_error, stored_mean, with_regular_run,
};
use crate::kernel::approx;
use crate::kernel::color::root_difference;
use crate::kernel::debug_view::PixelTrace;
use crate::kernel::noise::{Noise, pack_noise};
use crate::kernel::reconstruction::{
    Reconstructed, Reconstruction, accumulate, lod_loss_per_stop, reconstruct, relit, result_alpha,
};
use crate::kernel::reproject::Verdict;
use crate::kernel::sanitize;
use crate::kernel::stored_sample::{Interpolated, StoredSample, has_moved, pack_stored, with_motion};
use crate::notes::{NoteStage, Notes};
use crate::stats::FrameStats;
use glam::{Vec2, Vec3};

/// A view, its shaded quads, and the rectification of history at them.
pub(super) struct RectifiedView<'a> {
    pub view: &'a View<'a>,
    pub quads: &'a Quads,
    pub rectified: &'a RectifiedQuads,
}

impl ProcessPixel for RectifiedView<'_> {
    #[inline(always)]
    fn process(&self, x: u32, y: u32, stats: &mut FrameStats, notes: &mut impl Notes) -> Pixel {
        let pixel = self.pixel(x, y, stats, notes);
        Pixel { output: self.view.inputs.unexposed(pixel.output), ..pixel }
    }
}

impl RectifiedView<'_> {
    #[inline(always)]
    fn pixel<N: Notes>(&self, x: u32, y: u32, stats: &mut FrameStats, notes: &mut N) -> Pixel {
        let Self { view, quads, rectified } = *self;
        let inputs = &view.inputs;
        if !inputs.is_visible(x, y) {
            // Outside the visible area: black, without stored history.
            let (surface, noise) = (pack_stored(StoredSample::EMPTY), pack_noise(NO_NOISE));
            let trace = PixelTrace::default();
            return Pixel { output: Vec3::ZERO, surface, noise, alpha: [1.0; 2], albedo: 0, trace };
        }
        let disparity = inputs.disparity(x, y);
        let level = quads.level_at([x, y]);
        let mut candidate = view.quad_candidate(quads, [x, y], disparity, rectified, notes);
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
        let mut history = history.filter(|found| found.history.lod >= 0.0);
        let verdict = match &source {
            Err(verdict) => *verdict,
            Ok(Source { is_same: false, .. }) if history.is_none() => Verdict::Disoccluded,
            Ok(_) => Verdict::Valid,
        };
        inputs.count(x, y, candidate.usable, disparity, verdict, stats);
        if view.is_noisy && candidate.is_own {
            candidate = candidate.borrowing(history.as_ref().map_or(0.0, |found| found.noise.samples));
        }

        let sample = candidate.usable.then_some((candidate.color, candidate.albedo.albedo));
        let (past, albedos) = history.as_ref().map_or((None, None), |found| (Some(&found.history), found.albedos));
        let texture = view.texture([x, y], level, surface.is_edge, past, albedos, sample);
        if let Some(texture) = &texture {
            history = history.map(|found| Found { history: texture.of_history(found.history), ..found });
            candidate = candidate.times(texture.on_sample());
        }

        let is_near = view.antialiases && candidate.is_own && level == 0;
        let near = is_near.then(|| view.near(quads, [x, y], candidate.color));
        let mut pixel = match (source, &history) {
            (Ok(source), Some(past)) if candidate.usable => {
                let pixel = WithHistory { view, level, surface: &surface, past, candidate: &candidate, near };
                pixel.blend(source.previous.trust, notes)
            }
            (_, Some(past)) => history_alone(past),
            _ => candidate_alone(view, &candidate, near, notes),
        };
        pixel.result.stored.disparity = surface.stored;
        let Resolved { result, mean, noise, alpha, fit } = pixel;
        let (output, mut stored, share) = (result.color, result.stored, result.share);
        let samples = (level == 0 || history.is_none()).then_some(mean.samples);
        let retextured = texture.map(|texture| view.retextured([x, y], &texture, &result, samples));
        if let Some(texture) = retextured {
            stored.color *= texture.factor;
            stored.place_px += (view.sample_place_px() - stored.place_px) * texture.place_share;
        }
        // Means of colors may exceed the largest half.
        let output = output.clamp(Vec3::splat(-sanitize::MAX_HALF), Vec3::splat(sanitize::MAX_HALF));
        stats.replaced += u64::from(verdict == Verdict::Valid && share == 0.0);
        let trace = PixelTrace {
            verdict,
            weight: approx::exp2_approx(-candidate.lod),
            quality: approx::exp2_approx(-stored.lod.max(0.0)),
            age: 0,
            history_share: share,
            agreement: fit,
            is_replaced: share == 0.0,
            motion: surface.motion,
        };
        let stored = if view.antialiases { view.packed_mean([x, y], stored, mean) } else { pack_stored(stored) };
        let stored = with_motion(stored, surface.moved_px);
        let albedo = retextured.map_or(0, |texture| texture.word);
        Pixel { output, surface: stored, noise: pack_noise(noise), alpha, albedo, trace }
    }
}

/// What a pixel shows and stores, in frames with albedo still with the texture of its samples.
struct Resolved {
    result: Reconstructed,
    mean: Mean,
    noise: Noise,
    /// To show, and to store.
    alpha: [f32; 2],
    fit: f32,
}

/// A pixel without history: its candidate.
#[inline(always)]
fn candidate_alone(view: &View, candidate: &Candidate, near: Option<Near>, notes: &mut impl Notes) -> Resolved {
    // The samples around antialias alone.
    let change = view.centred_change(near);
    let color = candidate.color + change.unwrap_or(Vec3::ZERO);
    if change.is_some() {
        notes.note(NoteStage::Candidate, "samples around at the pixel's centre", color, "linear light");
    }
    let is_placed = view.antialiases && candidate.is_own && change.is_none();
    let stored = StoredSample {
        color,
        lod: if candidate.usable { candidate.lod } else { -1.0 },
        disparity: -1.0,
        place_px: if is_placed { view.sample_place_px() } else { Vec2::ZERO },
    };
    let result = Reconstructed { color, stored, share: 0.0, keeps_nearest: false, stored_share: 0.0 };
    Resolved { result, mean: Mean::ONE, noise: candidate.noise, alpha: [candidate.alpha; 2], fit: 1.0 }
}

/// A pixel without a usable candidate: its history.
#[inline(always)]
fn history_alone(past: &Found) -> Resolved {
    let Interpolated { color, nearest: stored, .. } = past.history;
    let result = Reconstructed { color, stored, share: 1.0, keeps_nearest: true, stored_share: 1.0 };
    Resolved { result, mean: past.mean, noise: past.noise, alpha: past.alpha, fit: 1.0 }
}

/// A pixel with history and a usable candidate.
struct WithHistory<'a> {
    view: &'a View<'a>,
    level: u32,
    surface: &'a Surroundings,
    past: &'a Found,
    candidate: &'a Candidate,
    /// Sums over the samples around a pixel of the fovea.
    near: Option<Near>,
}

impl WithHistory<'_> {
    /// History, relit, blended with the candidate. `trust`: trust in history.
    #[inline(always)]
    fn blend<N: Notes>(&self, trust: f32, notes: &mut N) -> Resolved {
        let Self { view, past, candidate, .. } = *self;
        let history = &past.history;
        let moved = match view.antialiases {
            true => has_moved(self.surface.motion.into(), Vec2::ZERO),
            false => has_moved(Vec2::ZERO, history.nearest.place_px),
        };
        let inputs = Reconstruction {
            candidate: candidate.color,
            lod: candidate.lod,
            range: candidate.range,
            history: history.color,
            history_lod: history.lod,
            nearest: history.nearest,
            lod_loss_per_stop: lod_loss_per_stop(moved, view.antialiases),
            gain: candidate.gain,
            fit: candidate.fit,
            trust,
            accumulate: view.accumulate,
        };
        if N::ON {
            let history = relit(inputs.history, inputs.gain, inputs.range);
            notes.note(NoteStage::Light, "history after the gain", history, "linear light");
            notes.note(NoteStage::Decision, "fit", inputs.fit, "");
        }
        let (result, mean, noise) = if view.is_noisy {
            let accumulated = accumulate(&inputs, past.noise, candidate.noise);
            (accumulated.result, Mean::ONE, accumulated.noise)
        } else if view.antialiases {
            let averaged = self.antialiased(inputs, moved, notes);
            (averaged.result, averaged.mean, candidate.noise)
        } else {
            (reconstruct(&inputs), Mean::ONE, candidate.noise)
        };
        let alpha = result_alpha(result, candidate.alpha, past.alpha[0], past.alpha[1]).into();
        Resolved { result, mean, noise, alpha, fit: candidate.fit }
    }

    /// The blend of jittered frames.
    #[inline(always)]
    fn antialiased(&self, inputs: Reconstruction, moved: bool, notes: &mut impl Notes) -> Averaged {
        let Self { view, past, candidate, .. } = *self;
        let at_edge = self.surface.is_moving_edge;
        if candidate.is_own {
            let contrast = root_difference(past.history.range[0], past.history.range[1]);
            let error = expected_mean_error(past.mean, contrast, moved);
            let mean = with_regular_run(past.mean, self.level);
            return view.averaged(self.near, at_edge, inputs, mean, error, notes);
        }
        if let Some(beside) = candidate.beside.filter(|_| at_edge && inputs.nearest.lod <= 0.0) {
            notes.note(NoteStage::Decision, "sample beside the pixel", beside, "linear light");
            let inputs = Reconstruction { candidate: beside, ..inputs };
            return average_beside(&inputs, past.mean, view.sample_place_px());
        }
        stored_mean(&inputs, reconstruct(&inputs), past.mean)
    }
}
