//! Temporal antialiasing of the foveated frame: scrub, reproject, flush, resample, clip, blend, store and show.
//!
//! Each pixel reads its motion and depth, nine colors and twelve remembered surfaces (neighbours share most of them), and writes one
//! surface and one color: 40 bytes with half-float color and motion.

use super::surface_history::SurfaceHistory;
use super::surface_pass::Pixel;
use crate::kernel::debug_view::PixelTrace;
use crate::kernel::reproject::Verdict;
use crate::kernel::sanitize::MAX_HALF;
use crate::kernel::surface::{Surface, pack_surface};
use crate::kernel::taa;
use crate::stats::FrameStats;
use glam::Vec3;

/// One pixel: what is shown, what is stored, what was decided.
#[inline(always)]
pub(super) fn pixel(at: &SurfaceHistory<'_>, x: u32, y: u32, stats: &mut FrameStats) -> Pixel {
    let inputs = &at.inputs;
    let (candidate, usable) = inputs.candidate(x, y);
    let disparity = inputs.disparity(x, y);
    let motion = inputs.motion(x, y);
    let source = at.source(x, y, motion, disparity);
    let verdict = source.err().unwrap_or(Verdict::Valid);
    inputs.count(x, y, usable, disparity, verdict, stats);

    let (mut shown, mut share, mut stored_lod) = (candidate, 0.0, if usable { 0.0 } else { -1.0 });
    if let Ok(source) = source {
        let history = at.expose(at.resample(&source).sharp);
        stored_lod = 0.0;
        if usable {
            let alpha = taa::candidate_share(source.fraction, source.trust);
            let (sum, squares) = neighbourhood(at, x, y, candidate);
            shown = taa::blend_clipped(candidate, history, sum, squares, alpha);
            share = 1.0 - alpha;
        } else {
            (shown, share) = (history, 1.0);
        }
    }
    // The lobes of the resampling reach beyond what halves hold.
    shown = shown.min(Vec3::splat(MAX_HALF));
    let trace = PixelTrace {
        verdict,
        weight: 1.0 - share,
        quality: 0.0,
        age: 0,
        survival: share,
        gate: 1.0,
        take: verdict != Verdict::Valid,
        motion,
    };
    let surface = pack_surface(Surface { color: shown, lod: stored_lod, disparity });
    Pixel { shown, surface, noise: 0, trace }
}

/// Sums of colors and of their squares over 3x3 pixels, in YCoCg. Broken ones count as the middle one, whose color is `own`.
#[inline(always)]
fn neighbourhood(at: &SurfaceHistory<'_>, x: u32, y: u32, own: Vec3) -> (Vec3, Vec3) {
    let [width, height] = at.inputs.size;
    let (mut sum, mut squares) = (Vec3::ZERO, Vec3::ZERO);
    for tap in 0..9 {
        let nx = (x + tap % 3).max(1) - 1;
        let ny = (y + tap / 3).max(1) - 1;
        let (color, usable) = at.inputs.candidate(nx.min(width - 1), ny.min(height - 1));
        let v = taa::to_ycocg(if usable { color } else { own });
        sum += v;
        squares += v * v;
    }
    (sum, squares)
}
