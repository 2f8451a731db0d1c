//! The scale-matched reservoir: scrub, reproject, flush, resample, match scales, relight, decide, store and show. `docs/method.md` has
//! the equations.
//!
//! Each pixel reads its colour, depth, five motions, twelve remembered surfaces, twelve texels of their coarser levels and four more
//! colours (neighbours share most of them), and writes one surface, a third of a texel of the coarser levels and one colour.

use super::remembered::{Remembered, Source};
use crate::kernel::approx;
use crate::kernel::debug_view::PixelTrace;
use crate::kernel::foveate::mean_of_four;
use crate::kernel::matched::{self, COHERENT_NEIGHBOURS, Evidence, Matched, SmrParams};
use crate::kernel::reproject::Verdict;
use crate::kernel::surface::{MAX_LOD, Surface, pack_surface};
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
        Self { params: settings.smr_params(), settings: *settings }
    }

    /// One pixel: what is shown, what is stored, what was decided.
    #[inline(always)]
    pub fn pixel(&self, at: &Remembered<'_>, x: u32, y: u32, stats: &mut FrameStats) -> (Vec3, [u32; 2], PixelTrace) {
        let inputs = &at.inputs;
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
        if let Ok(source) = source {
            if !usable {
                let history = at.resample(&source);
                made = Matched { color: at.expose(history.sharp), lod: history.lod, share: 1.0, fit: 1.0 };
            } else if lod > 0.0 {
                made = self.matched(at, x, y, candidate, lod, &source);
            }
        }
        stats.replaced += u64::from(verdict == Verdict::Valid && made.share == 0.0);
        // Colours of a moving silhouette mix two surfaces: shown, but not kept.
        let stored_lod = if coherent || made.lod < 0.0 { made.lod } else { MAX_LOD };
        let trace = PixelTrace {
            weight: approx::exp2(-lod),
            w_sum: 16.0 * approx::exp2(-made.lod.max(0.0)),
            age: 0,
            survival: made.share,
            verdict,
            gate: made.fit,
            take: made.share == 0.0,
            motion,
        };
        (made.color, pack_surface(Surface { color: made.color, lod: stored_lod, disparity }), trace)
    }

    /// Level of detail of the candidate.
    #[inline(always)]
    fn lod(&self, at: &Remembered<'_>, x: u32, y: u32) -> f32 {
        match at.inputs.view.lod {
            // NaN fails the comparison.
            Some(lods) => lods.at(x as usize, y as usize).clamp(0.0, MAX_LOD).max(0.0),
            None => self.settings.foveation.lod(at.inputs.eccentricity_deg(at.inputs.ray(x, y))),
        }
    }

    /// Whether enough neighbours move as the pixel does.
    #[inline(always)]
    fn is_coherent(&self, at: &Remembered<'_>, x: u32, y: u32, own: [f32; 2]) -> bool {
        let inputs = &at.inputs;
        if inputs.view.motion.is_none() {
            return true;
        }
        let [width, height] = inputs.size;
        let right = (x + 1).min(width - 1);
        let below = (y + 1).min(height - 1);
        let around = [(x.max(1) - 1, y), (right, y), (x, y.max(1) - 1), (x, below)];
        let alike: u32 = around.iter().map(|&(x, y)| u32::from(matched::moves_alike(own, inputs.motion(x, y)))).sum();
        alike >= COHERENT_NEIGHBOURS
    }

    #[inline(always)]
    fn matched(&self, at: &Remembered<'_>, x: u32, y: u32, candidate: Vec3, lod: f32, source: &Source) -> Matched {
        let history = at.resample(source);
        if matched::wanted(lod, history.lod, self.params.accumulate).share == 0.0 {
            return Matched { color: candidate, lod, share: 0.0, fit: 1.0 };
        }
        // A point sample is noise at its own scale: compare one level coarser.
        let shift = if self.params.blocks { 1.0 } else { 0.0 };
        let chain = at.past.chain.expect("smr remembers coarser levels");
        let [matched, matched_coarser] = chain.read(source.at, lod + shift, history.smooth);
        let radius = 0.75 * approx::exp2(lod);
        let around = self.around(at, x, y, radius);
        let (compared, compared_coarser) =
            if self.params.blocks { (around, self.around(at, x, y, 2.0 * radius)) } else { (candidate, around) };
        let evidence = Evidence {
            candidate,
            compared,
            compared_coarser,
            lod,
            history: at.expose(history.sharp),
            history_lod: history.lod,
            matched: at.expose(matched),
            matched_coarser: at.expose(matched_coarser),
            trust: source.trust,
        };
        matched::decide(&evidence, &self.params)
    }

    /// Mean of four candidates on the diagonals.
    #[inline(always)]
    fn around(&self, at: &Remembered<'_>, x: u32, y: u32, radius: f32) -> Vec3 {
        let [width, height] = at.inputs.size.map(|s| (s - 1) as f32);
        let tap = |sx: f32, sy: f32| {
            // The product last, as compilers order such sums.
            let tx = ((x as f32 + 0.5) + sx * radius).floor().clamp(0.0, width);
            let ty = ((y as f32 + 0.5) + sy * radius).floor().clamp(0.0, height);
            at.inputs.candidate(tx as u32, ty as u32).0
        };
        mean_of_four(tap(-1.0, -1.0), tap(1.0, -1.0), tap(-1.0, 1.0), tap(1.0, 1.0))
    }
}
