//! Notes of a pixel that all methods share: texels that are filtered, decision, result. What a method alone computes,
//! its pass notes; `input_notes.rs` notes the inputs.

use super::pixel::{Pixel, ProcessPixel};
use crate::kernel::antialias::mean_of;
use crate::kernel::debug_view::PixelTrace;
use crate::kernel::noise::{Noise, unpack_noise};
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

/// Notes the stored sample of a planned frame.
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
