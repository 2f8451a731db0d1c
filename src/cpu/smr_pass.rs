//! The scale-matched reservoir: scrub, reproject, flush, resample, match scales, relight, decide, store and show. `docs/method.md` has
//! the equations.
//!
//! Each pixel reads its color, depth, three motions, twelve remembered surfaces, eight texels of their coarser levels and, where
//! something changed, four more colors (neighbours share most of them), and writes one surface, a third of a texel of the coarser
//! levels and one color: 48 bytes with half-float color and motion. Where candidates are noisy it reads their noise, the noise of
//! one surface and eight texels of the candidates' coarser levels, and writes one word of noise: 80 bytes with the making of those.

use super::surface_history::{Source, SurfaceHistory};
use super::surface_pass::Pixel;
use crate::kernel::approx;
use crate::kernel::color;
use crate::kernel::debug_view::PixelTrace;
use crate::kernel::foveate::mean_of_four;
use crate::kernel::matched;
use crate::kernel::matched::{Evidence, Matched, SmrParams};
use crate::kernel::noise;
use crate::kernel::noise::{NOISY_LEVELS, Noise, pack_noise};
use crate::kernel::reproject::Verdict;
use crate::kernel::sanitize::MAX_HALF;
use crate::kernel::surface::{MAX_LOD, Surface, pack_surface};
use crate::method::smr_params;
use crate::settings::Settings;
use crate::stats::FrameStats;
use glam::Vec3;

/// Constants of a frame.
pub(super) struct Smr {
    params: SmrParams,
    settings: Settings,
}

impl Smr {
    pub fn new(settings: &Settings) -> Self {
        Self { params: smr_params(settings), settings: *settings }
    }

    /// One pixel: what is shown, what is stored and how noisy, what was decided.
    #[inline(always)]
    pub fn pixel(&self, at: &SurfaceHistory<'_>, x: u32, y: u32, stats: &mut FrameStats) -> Pixel {
        let inputs = &at.inputs;
        let noise = inputs.noise(x, y);
        let (candidate, usable) = inputs.candidate(x, y);
        let disparity = inputs.disparity(x, y);
        let motion = inputs.motion(x, y);
        let lod = self.lod(at, x, y);
        let coherent = self.is_coherent(at, x, y, motion);
        let mut source = at.source(x, y, motion, disparity);
        if source.is_ok() && !coherent {
            source = Err(Verdict::Disoccluded);
        }
        let verdict = source.err().unwrap_or(Verdict::Valid);
        inputs.count(x, y, usable, disparity, verdict, stats);

        let mut made = Matched { color: candidate, lod: if usable { lod } else { -1.0 }, share: 0.0, fit: 1.0 };
        let mut known = noise;
        if let Ok(source) = source {
            if !usable {
                let history = at.resample(&source);
                made = Matched { color: at.expose(history.sharp), lod: history.lod, share: 1.0, fit: 1.0 };
                known = noise.map(|_| at.noise(&source));
            } else if let Some(noise) = noise {
                let (averaged, after) = self.averaged(at, [x, y], candidate, noise, lod, &source);
                (made, known) = (averaged, Some(after));
            } else if lod > 0.0 {
                made = self.matched(at, x, y, candidate, lod, &source);
            }
        }
        // Gains, and the lobes of the resampling, reach beyond what halves hold.
        made.color = made.color.min(Vec3::splat(MAX_HALF));
        stats.replaced += u64::from(verdict == Verdict::Valid && made.share == 0.0);
        // Colors of a moving silhouette mix two surfaces: shown, but not kept.
        let stored_lod = if coherent || made.lod < 0.0 { made.lod } else { MAX_LOD };
        let trace = PixelTrace {
            verdict,
            weight: approx::exp2(-lod),
            quality: approx::exp2(-made.lod.max(0.0)),
            age: 0,
            survival: made.share,
            gate: made.fit,
            take: made.share == 0.0,
            motion,
        };
        Pixel {
            shown: made.color,
            surface: pack_surface(Surface { color: made.color, lod: stored_lod, disparity }),
            noise: known.map_or(0, pack_noise),
            trace,
        }
    }

    /// Level of detail of the candidate.
    #[inline(always)]
    fn lod(&self, at: &SurfaceHistory<'_>, x: u32, y: u32) -> f32 {
        match at.inputs.lod {
            // NaN fails the comparison.
            Some(lods) => lods.at(x as usize, y as usize).clamp(0.0, MAX_LOD).max(0.0),
            None => self.settings.foveation.lod(at.inputs.eccentricity_deg(at.inputs.ray(x, y))),
        }
    }

    /// Whether a neighbour moves as the pixel does.
    #[inline(always)]
    fn is_coherent(&self, at: &SurfaceHistory<'_>, x: u32, y: u32, own: [f32; 2]) -> bool {
        let inputs = &at.inputs;
        if !inputs.has_motion() {
            return true;
        }
        let [width, height] = inputs.size;
        // Within the block of 2x2 pixels; beyond the border the pixel itself.
        let (across_x, across_y) = ((x ^ 1).min(width - 1), (y ^ 1).min(height - 1));
        matched::moves_alike(own, inputs.motion(across_x, y)) || matched::moves_alike(own, inputs.motion(x, across_y))
    }

    #[inline(always)]
    fn matched(&self, at: &SurfaceHistory<'_>, x: u32, y: u32, candidate: Vec3, lod: f32, source: &Source) -> Matched {
        let history = at.resample(source);
        if matched::reuse_weight(lod, history.lod, self.params.accumulate, false, [1.0; 2]).share == 0.0 {
            return Matched { color: candidate, lod, share: 0.0, fit: 1.0 };
        }
        // A point sample is noise at its own scale: compare one level coarser.
        let shift = if self.params.blocks { 1.0 } else { 0.0 };
        let chain = at.past.chain.expect("smr remembers coarser levels");
        let [matched, level, next_level] = chain.read(source.at, lod + shift, history.smooth).map(|c| at.expose(c));
        let radius = 0.75 * approx::exp2(lod);
        let (compared, reach) = if self.params.blocks {
            (self.around(at, x, y, candidate, radius), 2.0 * radius)
        } else {
            (candidate, radius)
        };
        let changed =
            self.params.relight && matched::is_changed(compared, matched, level, next_level, self.params.blocks);
        let compared_coarser = if changed { self.around(at, x, y, candidate, reach) } else { Vec3::ZERO };
        let evidence = Evidence {
            candidate,
            compared,
            compared_coarser,
            lod,
            history: at.expose(history.sharp),
            history_lod: history.lod,
            matched,
            level,
            next_level,
            trust: source.trust,
            noise: 0.0,
            confidence: [1.0; 2],
        };
        matched::decide(&evidence, &self.params)
    }

    /// The same for a noisy candidate, and the noise of what is made.
    #[inline(always)]
    fn averaged(
        &self,
        at: &SurfaceHistory<'_>,
        [x, y]: [u32; 2],
        candidate: Vec3,
        noise: Noise,
        lod: f32,
        source: &Source,
    ) -> (Matched, Noise) {
        let history = at.resample(source);
        let past = at.noise(source);
        let shown = at.expose(history.sharp);
        let luma = color::luma(shown);
        let confidence =
            [past, Noise { samples: noise.samples, variance: past.variance }].map(|n| noise::noise_confidence(n, luma));
        let worth = noise::coarser_worth(past, noise, history.lod - lod);
        let params =
            SmrParams { accumulate: noise::history_share(worth, noise, self.params.accumulate), ..self.params };
        let reuse = matched::reuse_weight(lod, history.lod, params.accumulate, true, confidence);
        if reuse.share == 0.0 {
            return (Matched { color: candidate, lod, share: 0.0, fit: 1.0 }, noise);
        }
        let compared_lod = lod + NOISY_LEVELS;
        let candidates = at.past.candidates.expect("smr makes coarser levels of noisy candidates");
        let [compared, coarser] = candidates.read_candidates([x as f32, y as f32], compared_lod);
        let chain = at.past.chain.expect("smr remembers coarser levels");
        let [matched, level, next_level] = chain.read(source.at, compared_lod, history.smooth).map(|c| at.expose(c));
        let around = Noise { samples: noise.samples, variance: compared.w * noise.samples };
        let evidence = Evidence {
            candidate,
            compared: compared.truncate(),
            compared_coarser: coarser.truncate(),
            lod,
            history: shown,
            history_lod: history.lod,
            matched,
            level,
            next_level,
            trust: source.trust,
            confidence,
            noise: noise::noise_difference(past, around, color::luma(matched)),
        };
        let made = matched::decide(&evidence, &params);
        let believed = made.fit * source.trust;
        (made, noise::noise_after(past, around, made.share, reuse.finer * believed))
    }

    /// Mean of four candidates on the diagonals of one that is usable.
    #[inline(always)]
    fn around(&self, at: &SurfaceHistory<'_>, x: u32, y: u32, own: Vec3, radius: f32) -> Vec3 {
        let [width, height] = at.inputs.size.map(|s| (s - 1) as f32);
        let tap = |sx: f32, sy: f32| {
            // The product last, as compilers order such sums.
            let tx = ((x as f32 + 0.5) + sx * radius).floor().clamp(0.0, width);
            let ty = ((y as f32 + 0.5) + sy * radius).floor().clamp(0.0, height);
            match at.inputs.candidate(tx as u32, ty as u32) {
                (color, true) => color,
                // Of a broken pixel nothing is known, least of all that it is black.
                (_, false) => own,
            }
        };
        mean_of_four(tap(-1.0, -1.0), tap(1.0, -1.0), tap(-1.0, 1.0), tap(1.0, 1.0))
    }
}
