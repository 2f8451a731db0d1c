//! Temporal antialiasing of the foveated frame: sanitize, reproject, reject, resample, clip, blend, store and output.
//! Twin: `shaders/pass/taa_pass.wgsl`.
//!
//! Each pixel reads its motion and depth, nine colors and twelve stored surfaces (neighbours share most of these
//! reads), and writes one surface and one color. Memory traffic: 40 bytes a pixel with color and motion as halves.

use super::surface_history::SurfaceHistory;
use super::surface_pass::{Pixel, SurfaceMethod};
use crate::kernel::debug_view::PixelTrace;
use crate::kernel::reproject::Verdict;
use crate::kernel::sanitize::MAX_HALF;
use crate::kernel::surface::{Surface, pack_surface};
use crate::kernel::taa;
use crate::stats::FrameStats;
use glam::Vec3;

/// Temporal antialiasing.
pub(super) struct Taa;

impl SurfaceMethod for Taa {
    #[inline(always)]
    fn pixel(&self, view: &SurfaceHistory<'_>, x: u32, y: u32, stats: &mut FrameStats) -> Pixel {
        let inputs = &view.inputs;
        let (candidate, usable) = inputs.candidate(x, y);
        let disparity = inputs.disparity(x, y);
        let motion = inputs.motion(x, y);
        let source = view.source(x, y, motion, disparity);
        let verdict = source.err().unwrap_or(Verdict::Valid);
        inputs.count(x, y, usable, disparity, verdict, stats);

        let (mut output, mut share, mut stored_lod) = (candidate, 0.0, if usable { 0.0 } else { -1.0 });
        if let Ok(source) = source {
            let history = view.expose(view.resample(&source).sharp);
            stored_lod = 0.0;
            if usable {
                let alpha = taa::candidate_share(source.fraction, source.trust);
                let (sum, squares) = neighbourhood(view, x, y, candidate);
                output = taa::blend_clipped(candidate, history, sum, squares, alpha);
                share = 1.0 - alpha;
            } else {
                (output, share) = (history, 1.0);
            }
        }
        // The overshoot of Catmull-Rom may exceed the largest half.
        output = output.min(Vec3::splat(MAX_HALF));
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
        let surface = pack_surface(Surface { color: output, lod: stored_lod, disparity });
        Pixel { output, surface, noise: 0, trace }
    }
}

/// Sums of colors and of their squares over 3x3 pixels, in YCoCg. Non-finite pixels count as the centre, whose color is
/// `own`.
#[inline(always)]
fn neighbourhood(view: &SurfaceHistory<'_>, x: u32, y: u32, own: Vec3) -> (Vec3, Vec3) {
    let [width, height] = view.inputs.size;
    let (mut sum, mut squares) = (Vec3::ZERO, Vec3::ZERO);
    for tap in 0..9 {
        let nx = (x + tap % 3).max(1) - 1;
        let ny = (y + tap / 3).max(1) - 1;
        let (color, usable) = view.inputs.candidate(nx.min(width - 1), ny.min(height - 1));
        let v = taa::to_ycocg(if usable { color } else { own });
        sum += v;
        squares += v * v;
    }
    (sum, squares)
}
