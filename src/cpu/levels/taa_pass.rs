//! Temporal antialiasing of the foveated frame: sanitize, reproject, reject, resample, clip, blend, store and output.
//! Twin: `shaders/levels/taa_pass.wgsl`.
//!
//! Each pixel reads its motion and depth, nine colors and twelve stored surfaces (neighbours share most of these
//! reads), and writes one surface and one color. Memory traffic: 40 bytes a pixel with color and motion as halves.

use super::surface_history::{Source, SurfaceHistory};
use super::surface_pass::SurfaceMethod;
use crate::cpu::pixel::Pixel;
use crate::kernel::color::to_ycocg;
use crate::kernel::debug_view::PixelTrace;
use crate::kernel::reproject::Verdict;
use crate::kernel::sanitize::MAX_HALF;
use crate::kernel::surface::{Surface, pack_surface};
use crate::kernel::taa;
use crate::notes::{NoteStage, Notes};
use crate::stats::FrameStats;
use glam::Vec3;

pub(crate) struct Taa;

impl SurfaceMethod for Taa {
    #[inline(always)]
    fn pixel(&self, view: &SurfaceHistory<'_>, px: [u32; 2], stats: &mut FrameStats, notes: &mut impl Notes) -> Pixel {
        let (inputs, [x, y]) = (&view.inputs, px);
        let (candidate, usable) = inputs.candidate(x, y);
        let disparity = inputs.disparity(x, y);
        let motion = inputs.motion(x, y);
        let source = view.source(x, y, motion, disparity, notes);
        let verdict = source.err().unwrap_or(Verdict::Valid);
        inputs.count(x, y, usable, disparity, verdict, stats);
        notes.note(NoteStage::Candidate, "color", candidate, "linear light");
        notes.note(NoteStage::Candidate, "usable", usable, "");

        let (mut output, mut share, mut confidence) = (candidate, 0.0, 1.0);
        if let Ok(source) = source {
            let resampled = view.resample(&source, notes);
            let history = view.expose(resampled.sharp);
            confidence = taa::confidence_of(resampled.lod).min(taa::confidence_limit(source.fraction, taa::SPREAD));
            notes.note(NoteStage::History, "confidence", confidence, "samples");
            (output, share) = (history, 1.0);
            if usable {
                let past = (confidence > taa::SETTLED).then_some(&source);
                let Neighbourhood { sum, squares, past_luma } = neighbourhood(view, px, candidate, past);
                if past.is_some() {
                    confidence = confidence.min(taa::agreeing(sum.x, squares.x, past_luma, 9.0));
                }
                let alpha = taa::candidate_share(confidence, source.trust);
                let name = "confidence that agrees with the samples around";
                notes.note(NoteStage::Comparison, name, confidence, "samples");
                output = taa::blend_clipped_noted(candidate, history, sum, squares, alpha, confidence, notes);
                share = 1.0 - alpha;
                confidence = 1.0 / alpha;
            }
        }
        let stored_lod = if usable || source.is_ok() { taa::lod_of(confidence) } else { -1.0 };
        // With the overshoot of Catmull-Rom, colors may exceed the largest half.
        output = output.min(Vec3::splat(MAX_HALF));
        let trace = PixelTrace {
            verdict,
            weight: 1.0 - share,
            history_share: share,
            is_replaced: verdict != Verdict::Valid,
            motion,
            ..PixelTrace::default()
        };
        let surface = pack_surface(Surface { color: output, lod: stored_lod, disparity });
        Pixel { output, surface, noise: 0, alpha: [1.0; 2], albedo: 0, trace }
    }
}

/// Sums over 3x3 pixels.
struct Neighbourhood {
    /// Colors in YCoCg.
    sum: Vec3,
    /// Squares of these.
    squares: Vec3,
    /// Lumas of history; 0 if history is not compared.
    past_luma: f32,
}

/// Sums around a pixel. Non-finite pixels count as the centre, whose color is `own`. `past`: position of the history to
/// compare with, if any.
#[inline(always)]
fn neighbourhood(view: &SurfaceHistory<'_>, px: [u32; 2], own: Vec3, past: Option<&Source>) -> Neighbourhood {
    let mut around = Neighbourhood { sum: Vec3::ZERO, squares: Vec3::ZERO, past_luma: 0.0 };
    for tap in 0..9 {
        let offset = [tap % 3 - 1, tap / 3 - 1];
        let [x, y] = [0, 1].map(|i| (px[i] as i32 + offset[i]).clamp(0, view.inputs.size[i] as i32 - 1) as u32);
        let (color, usable) = view.inputs.candidate(x, y);
        let v = to_ycocg(if usable { color } else { own });
        around.sum += v;
        around.squares += v * v;
        if let Some(source) = past {
            around.past_luma += view.luma_beside(source, offset);
        }
    }
    around
}
