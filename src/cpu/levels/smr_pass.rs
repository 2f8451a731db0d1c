//! Scale-matched reservoirs: sanitize, reproject, reject, resample, match scales, relight, decide, store and output.
//! `docs/method.md` has the equations. Twin: `shaders/levels/smr_pass.wgsl`.
//!
//! Each pixel reads its color, depth, three motion vectors, twelve stored surfaces and eight texels of their mip chain.
//! It reads four more colors where light changed; point-sampled blocks always read these, and four more texels of
//! history. Neighbours share most of these reads. It writes one surface, a third of a texel of the mip chain and one
//! color. Memory traffic: 48 bytes a pixel with color and motion as halves. With noisy candidates it also reads their
//! noise, the noise of one surface and eight texels of the candidates' mip chain, and writes one word of noise: 80
//! bytes a pixel, including the passes that compute that mip chain.

use super::surface_history::{Source, SurfaceHistory};
use super::surface_pass::SurfaceMethod;
use crate::cpu::pixel::Pixel;
use crate::foveation::FoveationKind;
use crate::kernel::approx;
use crate::kernel::color;
use crate::kernel::debug_view::PixelTrace;
use crate::kernel::foveate::mean_of_four;
use crate::kernel::lod::MAX_LOD;
use crate::kernel::mip_noise::{self, NOISY_LEVELS};
use crate::kernel::noise;
use crate::kernel::noise::{Noise, pack_noise};
use crate::kernel::reproject::Verdict;
use crate::kernel::sanitize::MAX_HALF;
use crate::kernel::smr;
use crate::kernel::smr::{Evidence, Matched, SmrParams};
use crate::kernel::surface::{Surface, pack_surface};
use crate::method::smr_params;
use crate::notes::{NoteStage, Notes};
use crate::settings::Settings;
use crate::stats::FrameStats;
use glam::Vec3;

/// Constants of smr in a frame.
pub(crate) struct Smr {
    params: SmrParams,
    settings: Settings,
}

impl SurfaceMethod for Smr {
    #[inline(always)]
    fn pixel(&self, view: &SurfaceHistory<'_>, px: [u32; 2], stats: &mut FrameStats, notes: &mut impl Notes) -> Pixel {
        let (inputs, [x, y]) = (&view.inputs, px);
        let noise = inputs.noise(x, y);
        let (candidate, usable) = inputs.candidate(x, y);
        let disparity = inputs.disparity(x, y);
        let motion = inputs.motion(x, y);
        let e_deg = inputs.region_angle_deg(inputs.ray(x, y));
        let lod = inputs.candidate_lod(&self.settings.foveation, x, y, e_deg);
        let coherent_motion = inputs.is_coherent(x, y, motion);
        notes.note(NoteStage::Candidate, "color", candidate, "linear light");
        notes.note(NoteStage::Candidate, "usable", usable, "");
        notes.note(NoteStage::Candidate, "level of detail", lod, "log2 px");
        notes.note(NoteStage::Reprojection, "a neighbour moves alike", coherent_motion, "");
        let mut source = view.source(x, y, motion, disparity, notes);
        if source.is_ok() && !coherent_motion {
            source = Err(Verdict::Disoccluded);
        }
        let verdict = source.err().unwrap_or(Verdict::Valid);
        inputs.count(x, y, usable, disparity, verdict, stats);

        let mut result = Matched { color: candidate, lod: if usable { lod } else { -1.0 }, share: 0.0, fit: 1.0 };
        let mut output_noise = noise;
        if let Ok(source) = source {
            if !usable {
                let history = view.resample(&source, notes);
                result = Matched { color: view.expose(history.sharp), lod: history.lod, share: 1.0, fit: 1.0 };
                output_noise = noise.map(|_| view.noise(&source));
            } else if let Some(noise) = noise {
                let (averaged, after) = self.averaged(view, px, (candidate, noise), lod, &source, notes);
                (result, output_noise) = (averaged, Some(after));
            } else if lod > 0.0 {
                result = self.matched(view, px, candidate, lod, &source, notes);
            } else {
                notes.note(NoteStage::Decision, "a full-rate candidate replaces history", true, "");
            }
        }
        // With gains, and with the overshoot of Catmull-Rom, colors may exceed the largest half.
        result.color = result.color.min(Vec3::splat(MAX_HALF));
        stats.replaced += u64::from(verdict == Verdict::Valid && result.share == 0.0);
        // Colors on a moving silhouette mix two surfaces. With the coarsest level of detail, the next candidate
        // replaces them.
        let stored_lod = if coherent_motion || result.lod < 0.0 { result.lod } else { MAX_LOD };
        let trace = PixelTrace {
            verdict,
            weight: approx::exp2_approx(-lod),
            quality: approx::exp2_approx(-result.lod.max(0.0)),
            age: 0,
            history_share: result.share,
            agreement: result.fit,
            is_replaced: result.share == 0.0,
            motion,
        };
        Pixel {
            output: result.color,
            surface: pack_surface(Surface { color: result.color, lod: stored_lod, disparity }),
            noise: output_noise.map_or(0, pack_noise),
            alpha: [1.0; 2],
            albedo: 0,
            trace,
        }
    }
}

impl Smr {
    pub fn new(settings: &Settings) -> Self {
        Self { params: smr_params(settings), settings: *settings }
    }

    /// Output color for a candidate without noise.
    #[inline(always)]
    fn matched(
        &self,
        view: &SurfaceHistory<'_>,
        [x, y]: [u32; 2],
        candidate: Vec3,
        lod: f32,
        source: &Source,
        notes: &mut impl Notes,
    ) -> Matched {
        let history = view.resample(source, notes);
        notes.note(NoteStage::History, "level of detail", history.lod, "log2 px");
        let reuse = smr::reuse_weight(lod, history.lod, self.params.accumulate, false, [1.0; 2]);
        if reuse.share == 0.0 {
            notes.note(NoteStage::Decision, "history is too coarse to be of use", true, "");
            return Matched { color: candidate, lod, share: 0.0, fit: 1.0 };
        }
        // Point samples alias at their own scale: compare one level coarser.
        let shift = if self.params.blocks { 1.0 } else { 0.0 };
        let mip_chain = view.past.mip_chain.expect("smr stores a mip chain");
        let past = mip_chain.read(source.at, lod + shift, history.smooth);
        let unit = smr::brightness_unit(candidate, past[0], view.inputs.exposure);
        let inverse_unit = 1.0 / unit;
        let per_stored = view.inputs.exposure * inverse_unit;
        let [matched, level, next_level] = past.map(|c| c * per_stored);
        let own = candidate * inverse_unit;
        let radius = 0.75 * approx::exp2_approx(lod);
        let blocks = self.params.blocks;
        // Levels of history are means of blocks, not Gaussian blurs: the two agree better one level coarser.
        let gauss = self.settings.foveation.kind == FoveationKind::Gauss;
        let changed = self.params.relight
            && smr::may_relight(reuse.finer, false)
            && smr::is_changed(own, matched, level, next_level);
        let around = if blocks || changed { self.around(view, x, y, candidate, radius) } else { Vec3::ZERO };
        let around = around * inverse_unit;
        let predicted = if blocks { view.sampled(source, [x, y], lod) * per_stored } else { matched };
        let evidence = Evidence {
            candidate,
            unit,
            compared: if blocks { around } else { own },
            compared_coarser: if gauss { own } else { around },
            observed: if gauss { around } else { own },
            lod,
            history: view.expose(history.sharp),
            history_lod: history.lod,
            resampled: source.fraction != [0.0; 2] && !gauss,
            matched,
            level,
            next_level,
            matched_coarser: if blocks || gauss { matched } else { next_level },
            predicted: if gauss { next_level } else { predicted },
            trust: source.trust,
            noise: 0.0,
            confidence: [1.0; 2],
        };
        smr::decide_noted(&evidence, &self.params, notes)
    }

    /// Output color for a noisy candidate, and its noise.
    #[inline(always)]
    fn averaged(
        &self,
        view: &SurfaceHistory<'_>,
        [x, y]: [u32; 2],
        (candidate, noise): (Vec3, Noise),
        lod: f32,
        source: &Source,
        notes: &mut impl Notes,
    ) -> (Matched, Noise) {
        let history = view.resample(source, notes);
        let past = view.noise(source);
        notes.note(NoteStage::History, "level of detail", history.lod, "log2 px");
        notes.note(NoteStage::History, "noise", [past.samples, past.variance], "samples, variance of one");
        let exposed = view.expose(history.sharp);
        let luma = color::luma(exposed);
        let confidence =
            [past, Noise { samples: noise.samples, variance: past.variance }].map(|n| noise::noise_confidence(n, luma));
        let discounted = mip_noise::discount_coarser(past, noise, history.lod - lod);
        let params =
            SmrParams { accumulate: noise::history_share(discounted, noise, self.params.accumulate), ..self.params };
        let reuse = smr::reuse_weight(lod, history.lod, params.accumulate, true, confidence);
        if reuse.share == 0.0 {
            notes.note(NoteStage::Decision, "history is too coarse to be of use", true, "");
            return (Matched { color: candidate, lod, share: 0.0, fit: 1.0 }, noise);
        }
        let compared_lod = lod + NOISY_LEVELS;
        let candidates = view.past.candidates.expect("noisy candidates have a mip chain");
        let [compared, coarser] = candidates.read_candidates([x as f32, y as f32], compared_lod);
        let mip_chain = view.past.mip_chain.expect("smr stores a mip chain");
        let stored = mip_chain.read(source.at, compared_lod, history.smooth);
        let unit = smr::brightness_unit(compared.truncate(), stored[0], view.inputs.exposure);
        let inverse_unit = 1.0 / unit;
        let per_stored = view.inputs.exposure * inverse_unit;
        let [matched, level, next_level] = stored.map(|c| c * per_stored);
        let [mean, coarser] = [compared, coarser].map(|c| c.truncate() * inverse_unit);
        let around = Noise { samples: noise.samples, variance: compared.w * noise.samples };
        let evidence = Evidence {
            candidate,
            unit,
            compared: mean,
            compared_coarser: coarser,
            observed: mean,
            lod,
            history: exposed,
            history_lod: history.lod,
            resampled: source.fraction != [0.0; 2],
            matched,
            level,
            next_level,
            matched_coarser: next_level,
            predicted: matched,
            trust: source.trust,
            confidence,
            noise: mip_noise::noise_difference(past, around, color::luma(matched), inverse_unit),
        };
        let result = smr::decide_noted(&evidence, &params, notes);
        let acceptance = result.fit * source.trust;
        (result, noise::noise_after(past, around, result.share, reuse.finer * acceptance))
    }

    /// Mean of the four candidates at diagonal offsets of `radius` pixels. `own`, the usable candidate of the pixel,
    /// replaces non-finite ones.
    #[inline(always)]
    fn around(&self, view: &SurfaceHistory<'_>, x: u32, y: u32, own: Vec3, radius: f32) -> Vec3 {
        let [width, height] = view.inputs.size.map(|s| (s - 1) as f32);
        let tap = |sx: f32, sy: f32| {
            // The product last: shader compilers order such sums this way.
            let tx = ((x as f32 + 0.5) + sx * radius).floor().clamp(0.0, width);
            let ty = ((y as f32 + 0.5) + sy * radius).floor().clamp(0.0, height);
            match view.inputs.candidate(tx as u32, ty as u32) {
                (color, true) => color,
                // A non-finite pixel must not count as black.
                (_, false) => own,
            }
        };
        mean_of_four(tap(-1.0, -1.0), tap(1.0, -1.0), tap(-1.0, 1.0), tap(1.0, 1.0))
    }
}
