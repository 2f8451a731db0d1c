//! Temporal upsampling: sanitize, reproject, reject, resample, gather samples, clip, blend, store and output.
//! Twin: `shaders/levels/taau_pass.wgsl`.
//!
//! Each pixel reads its motion and depth, nine samples and twelve stored surfaces (neighbours share most of these
//! reads), and writes one surface and one color. Whole frames have a sample in every pixel. Planned frames have one in
//! each shaded pixel: the others are filled before, and tell only what is around.

use super::surface_history::{Source, SurfaceHistory};
use super::surface_pass::SurfaceMethod;
use crate::cpu::pixel::Pixel;
use crate::kernel::debug_view::PixelTrace;
use crate::kernel::reproject::Verdict;
use crate::kernel::sanitize::MAX_HALF;
use crate::kernel::surface::{Surface, pack_surface};
use crate::kernel::taa;
use crate::kernel::taau;
use crate::kernel::taau::{Accumulated, SamplesAround};
use crate::notes::{NoteStage, Notes};
use crate::stats::FrameStats;
use glam::{Vec2, Vec3};

pub(crate) struct Taau;

impl SurfaceMethod for Taau {
    #[inline(always)]
    fn pixel(&self, view: &SurfaceHistory<'_>, px: [u32; 2], stats: &mut FrameStats, notes: &mut impl Notes) -> Pixel {
        let (inputs, [x, y]) = (&view.inputs, px);
        let disparity = inputs.disparity(x, y);
        let motion = inputs.motion(x, y);
        let source = view.source(x, y, motion, disparity, notes);
        let verdict = source.err().unwrap_or(Verdict::Valid);

        let (mut history, mut confidence, mut trust) = (Vec3::ZERO, 0.0, 0.0);
        if let Ok(source) = source {
            let resampled = view.resample(&source, notes);
            history = view.expose(resampled.sharp);
            confidence =
                taa::confidence_of(resampled.lod).min(taa::confidence_limit(source.fraction, taau::UPSAMPLED_SPREAD));
            trust = source.trust;
            notes.note(NoteStage::History, "confidence", confidence, "samples at the pixel");
        }
        let past = source.as_ref().ok().filter(|_| confidence > taa::SETTLED);
        let kernel = Kernel { tail: taau::tail(confidence * trust), narrowing: taau::narrowing(confidence) };
        let Samples { around, nearest, usable, past_luma } = samples(view, px, &kernel, past, notes);
        if past.is_some() {
            confidence = confidence.min(taa::agreeing(around.sum.x, around.squares.x, past_luma, around.count));
            notes.note(NoteStage::Comparison, "confidence that agrees with the samples around", confidence, "samples");
        }
        notes.note(NoteStage::Candidate, "nearest sample", nearest, "linear light");
        notes.note(NoteStage::Candidate, "usable", usable, "");
        let unit = "at the pixel, and with interpolation";
        notes.note(NoteStage::Candidate, "weight of the samples", around.weights, unit);
        inputs.count(x, y, usable, disparity, verdict, stats);

        let sampled = around.weights.y >= taau::LEAST_SAMPLE_WEIGHT;
        let is_filled = view.quads.is_some() && usable;
        let mut result = Accumulated { color: history, confidence, share: 0.0, kept: 1.0 };
        if sampled && source.is_ok() {
            result = taau::accumulate_noted(around, nearest, history, confidence, trust, notes);
        } else if sampled {
            let color = taau::upsampled(around, nearest);
            result = Accumulated { color, confidence: around.weights.y, share: 1.0, kept: 1.0 };
        } else if is_filled && source.is_err() {
            result = Accumulated { color: nearest, confidence: taau::LEAST_SAMPLE_WEIGHT, share: 1.0, kept: 1.0 };
        }
        notes.note(NoteStage::Decision, "confidence", result.confidence, "samples at the pixel");
        // With the overshoot of Catmull-Rom, colors may exceed the largest half.
        let output = result.color.min(Vec3::splat(MAX_HALF));
        let lod = if sampled || source.is_ok() || is_filled { taa::lod_of(result.confidence) } else { -1.0 };
        let trace = PixelTrace {
            verdict,
            weight: result.share,
            quality: (0.5 * result.confidence).min(1.0),
            age: 0,
            history_share: if source.is_ok() { 1.0 - result.share } else { 0.0 },
            agreement: result.kept,
            is_replaced: verdict != Verdict::Valid,
            motion,
        };
        let surface = pack_surface(Surface { color: output, lod, disparity });
        Pixel { output, surface, noise: 0, alpha: [1.0; 2], albedo: 0, trace }
    }
}

/// How samples around a pixel are weighted.
struct Kernel {
    tail: f32,
    narrowing: f32,
}

struct Samples {
    around: SamplesAround,
    /// Color of the nearest sample; black if it is not usable.
    nearest: Vec3,
    /// Whether the nearest sample is usable.
    usable: bool,
    /// Sum of history's lumas at the samples' pixels; 0 if history is not compared.
    past_luma: f32,
}

/// Nine samples around a pixel. At the frame's border the last samples repeat at positions beyond it.
/// `past`: position of the history to compare with, if any.
#[inline(always)]
fn samples(
    view: &SurfaceHistory<'_>,
    px: [u32; 2],
    kernel: &Kernel,
    past: Option<&Source>,
    notes: &mut impl Notes,
) -> Samples {
    let inputs = &view.inputs;
    let inside = |at: [i32; 2]| [0, 1].map(|i| at[i].clamp(0, inputs.size[i] as i32 - 1) as u32);
    let (nearest, usable) = inputs.candidate(px[0], px[1]);
    let mut found = Samples { around: SamplesAround::default(), nearest, usable, past_luma: 0.0 };
    for tap in 0..9 {
        let offset_px = [tap % 3 - 1, tap / 3 - 1];
        let at = inside([0, 1].map(|i| px[i] as i32 + offset_px[i]));
        let (color, usable) = inputs.candidate(at[0], at[1]);
        if usable {
            // A sample shows the point at its pixel minus the jitter.
            let offset = Vec2::new(offset_px[0] as f32, offset_px[1] as f32) - Vec2::from(inputs.uniforms.jitter_px);
            let mut weights = taau::sample_weights(offset, kernel.tail, kernel.narrowing);
            // What was filled between shaded quads is no sample. It still tells what is around.
            if view.quads.is_some_and(|quads| !quads.is_shaded(at)) {
                weights = Vec2::ZERO;
            }
            let values = [offset.x, offset.y, weights.x, weights.y, color.x, color.y, color.z];
            notes.note(NoteStage::Candidate, "sample", values, "x y px, two weights, linear light");
            found.around = taau::add_around(found.around, found.nearest, color, weights);
            if let Some(source) = past {
                found.past_luma += view.luma_beside(source, offset_px);
            }
        }
    }
    found
}
