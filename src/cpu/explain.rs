//! Notes of a pixel that all methods share: inputs, texels that are filtered, decision, result. What a method alone
//! computes, its pass notes.

use super::Frame;
use super::history::History;
use super::inputs::Inputs;
use super::pixel::{Pixel, ProcessPixel};
use super::sparse_pass::Quads;
use crate::context::ContextDesc;
use crate::frame::Reset;
use crate::kernel::antialias::mean_of;
use crate::kernel::debug_view::PixelTrace;
use crate::kernel::depth::distance_of;
use crate::kernel::noise::{Noise, unpack_noise};
use crate::kernel::quads::WHOLE;
use crate::kernel::resample::{ROUNDS, Tap, TapsAround, sharp_sum, taps_of};
use crate::kernel::stored_sample::unpack_stored;
use crate::kernel::surface::unpack_surface;
use crate::notes::{Note, NoteStage, Notes, PixelNotes};
use crate::stats::FrameStats;

/// The pixel to explain, if it lies in view `view`.
pub(super) fn of_view<'a>(noted: &'a mut Option<&mut PixelNotes>, view: usize) -> Option<&'a mut PixelNotes> {
    noted.as_deref_mut().filter(|pixel| pixel.view == view && !pixel.notes.is_empty())
}

/// Computes a pixel once more, with notes. `stored`: notes what its words hold.
pub(super) fn explain(pass: &impl ProcessPixel, stored: fn(&Pixel, &mut Vec<Note>), pixel: &mut PixelNotes) {
    let PixelNotes { px: [x, y], notes, .. } = pixel;
    let result = pass.process(*x, *y, &mut FrameStats::default(), notes);
    note_trace(&result.trace, notes);
    notes.note(NoteStage::Shown, "color", result.output, "linear light, in the unit of the given colors");
    notes.note(NoteStage::Stored, "words", result.surface, "");
    stored(&result, notes);
}

/// Notes what a frame gives for a pixel, unless it lies outside the frame. `given`: the frame before its colors
/// were filled between samples.
pub(super) fn note_inputs(
    desc: &ContextDesc,
    given: &Frame<'_>,
    frame: &Frame<'_>,
    history: &History,
    quads: &[Quads],
    pixel: &mut PixelNotes,
) {
    let PixelNotes { view, px: [x, y], notes } = pixel;
    let (view, x, y) = (*view, *x, *y);
    if view >= frame.views.len() || x >= desc.size_px[0] || y >= desc.size_px[1] {
        return;
    }
    let facts = &frame.views[view];
    let state = history.state_after(view, given);
    let inputs = Inputs::new(desc, frame, view, &state, history.is_filled());
    let stage = NoteStage::Input;
    let (u, v) = (x as usize, y as usize);
    let e_deg = inputs.region_angle_deg(inputs.ray(x, y));
    notes.note(stage, "gaze", facts.gaze.resolve(state.gaze_px, &facts.geometry), "px");
    notes.note(stage, "distance from the gaze", e_deg, "deg");
    notes.note(stage, "jitter", inputs.uniforms.jitter_px, "px");
    notes.note(stage, "visible in the lens", inputs.is_visible(x, y), "");
    notes.note(stage, "exposure", inputs.color_exposure, "factor on colors and noise as given");
    notes.note(stage, "exposure by that of the previous frame", inputs.exposure, "");
    notes.note(stage, "history starts here", frame.reset != Reset::None || !history.is_filled(), "");
    if frame.color[view].size() == desc.size_px {
        notes.note(stage, "color", frame.color[view].at(u, v), "linear light, as given");
    }
    match quads.get(view) {
        Some(quads) => note_sample(quads, given, view, [x, y], notes),
        None => {
            let lod = inputs.candidate_lod(&desc.settings.foveation, x, y, e_deg);
            notes.note(stage, "level of detail", lod, "log2 px");
        }
    }
    note_geometry(desc, frame, &inputs, view, [x, y], notes);
    if let Some(noise) = inputs.noise(x, y) {
        notes.note(stage, "noise", [noise.samples, noise.variance], "samples, variance of one");
    }
    if let Some(trust) = inputs.trust(x, y) {
        notes.note(stage, "trust", trust, "");
    }
}

/// Depth and motion of a pixel, as given and in internal conventions.
fn note_geometry(
    desc: &ContextDesc,
    frame: &Frame<'_>,
    inputs: &Inputs<'_>,
    view: usize,
    [x, y]: [u32; 2],
    notes: &mut Vec<Note>,
) {
    let (stage, at) = (NoteStage::Input, (x as usize, y as usize));
    if let Some(depth) = frame.depth.map(|d| d[view]) {
        notes.note(stage, "depth as given", depth.at(at.0, at.1), "in the frame's convention");
        let disparity = inputs.disparity(x, y);
        notes.note(stage, "distance", distance_of(disparity), "below 0: unknown");
        notes.note(stage, "disparity", disparity, "1/distance");
    }
    if let Some(motion) = frame.motion.map(|m| m[view]) {
        notes.note(stage, "motion as given", motion.at(at.0, at.1), "in the frame's convention");
    }
    notes.note(stage, "motion", inputs.motion(x, y), "px, previous minus current position, y down");
    if let Some(test) = desc.settings.depth_test.filter(|_| inputs.tests_depth()) {
        notes.note(stage, "tolerance of the depth test", test.relative, "relative");
    }
}

/// Whether a pixel of a planned frame is shaded, and the sample that is nearest to it.
fn note_sample(quads: &Quads, given: &Frame<'_>, view: usize, px: [u32; 2], notes: &mut Vec<Note>) {
    let stage = NoteStage::Input;
    notes.note(stage, "shaded", quads.is_shaded(px), "");
    notes.note(stage, "distance of the even pattern's quads", (1 << quads.level_at(px)) as f32, "px");
    let Some(at) = quads.nearest_sample(px) else { return };
    notes.note(stage, "nearest sample", [0, 1].map(|i| at[i] as f32 - px[i] as f32), "px from the pixel");
    let half = given.half.filter(|_| quads.mask(at.map(|v| v / 2)) != WHOLE);
    let color = match half {
        Some(half) => half[view].at(at[0] as usize / 2, at[1] as usize / 2),
        None => given.color[view].at(at[0] as usize, at[1] as usize),
    };
    notes.note(stage, "its color", color, "linear light, as given");
}

/// Notes the texels of history that are filtered.
#[inline(always)]
pub(super) fn note_taps<N: Notes>(taps: &TapsAround, tap: impl Fn([i32; 2]) -> Tap, notes: &mut N) {
    if !N::ON {
        return;
    }
    let sum = sharp_sum(taps);
    let mut complete = true;
    for four in (0..ROUNDS).map(|round| taps_of(taps, round)) {
        for (i, texel) in four.texels.into_iter().enumerate() {
            let Tap { same, .. } = tap(texel);
            complete &= same;
            let sharp = four.sharp_x[i] * four.sharp_rows[i / 2] / sum;
            let linear = if i == 1 || i == 2 { four.linear_x[i - 1] * four.linear_row } else { 0.0 };
            let values = [texel[0] as f32, texel[1] as f32, sharp, linear, f32::from(same)];
            notes.note(NoteStage::History, "texel", values, "x y px, Catmull-Rom and linear weight, same surface");
        }
    }
    let filter = if complete { "Catmull-Rom" } else { "linear, texels of the surface alone" };
    notes.note(NoteStage::History, "filter", filter, "");
}

pub(super) fn note_trace(trace: &PixelTrace, notes: &mut Vec<Note>) {
    notes.note(NoteStage::Verdict, "history", trace.verdict.reason(), "");
    notes.note(NoteStage::Decision, "weight of the candidate", trace.weight, "");
    notes.note(NoteStage::Decision, "agreement of history and candidate", trace.agreement, "");
    notes.note(NoteStage::Decision, "history's share", trace.history_share, "");
    notes.note(NoteStage::Decision, "candidate replaces history", trace.is_replaced, "");
    notes.note(NoteStage::Decision, "quality of what is stored", trace.quality, "");
}

/// Notes the stored surface of taa, taau and smr.
pub(super) fn note_surface(pixel: &Pixel, notes: &mut Vec<Note>) {
    let stored = unpack_surface(pixel.surface);
    notes.note(NoteStage::Stored, "color", stored.color, "linear light");
    let unit = "log2 px (taa, taau: of the confidence), below 0: empty";
    notes.note(NoteStage::Stored, "level of detail", stored.lod, unit);
    notes.note(NoteStage::Stored, "disparity", stored.disparity, "1/distance, below 0: unknown");
    note_noise(pixel, notes);
}

/// Notes the stored sample of smr on planned frames.
pub(super) fn note_stored(pixel: &Pixel, notes: &mut Vec<Note>) {
    let stored = unpack_stored(pixel.surface);
    notes.note(NoteStage::Stored, "color", stored.color, "linear light");
    notes.note(NoteStage::Stored, "level of detail", stored.lod, "log2 px, below 0: empty");
    notes.note(NoteStage::Stored, "disparity", stored.disparity, "1/distance, below 0: unknown");
    notes.note(NoteStage::Stored, "place", stored.place_px, "px from the pixel's centre");
    note_noise(pixel, notes);
}

/// The same where history stores means of jittered samples.
pub(super) fn note_stored_mean(pixel: &Pixel, notes: &mut Vec<Note>) {
    note_stored(pixel, notes);
    let mean = mean_of(unpack_stored(pixel.surface).lod);
    notes.note(
        NoteStage::Stored,
        "mean",
        [mean.lod, mean.samples, mean.deviation, mean.run],
        "level of detail in log2 px, samples, their deviation, samples in a row on one side",
    );
}

fn note_noise(pixel: &Pixel, notes: &mut Vec<Note>) {
    let Noise { samples, variance } = unpack_noise(pixel.noise);
    notes.note(NoteStage::Stored, "noise", [samples, variance], "samples, variance of one; noisy frames only");
}
