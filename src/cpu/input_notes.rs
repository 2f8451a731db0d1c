//! Notes of what a frame gives for a pixel, before a pass reads it.

use super::frame::Frame;
use super::history::History;
use super::inputs::Inputs;
use super::quads::Quads;
use crate::context::ContextDesc;
use crate::frame::Reset;
use crate::kernel::depth::distance_of;
use crate::kernel::quads::WHOLE;
use crate::notes::{Note, NoteStage, Notes, PixelNotes};

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
