//! Reconstruction of planned frames from history that keeps samples in their places. Its mathematics is in
//! `src/kernel/{stored_sample,reconstruction}.rs`.
//!
//! Four loops. The first compares each sample outside the fovea with history at its pixel. The second estimates the
//! gain of each block of quads. The third estimates gain and fit for each shaded quad, from its own comparisons, those
//! of the eight quads around it, and the gain of its block. The fourth interpolates gain, fit and samples for each
//! pixel, reads the stored samples around the pixel's previous position, and blends.

mod albedo;
mod antialias;
mod block_gains;
mod candidate;
mod observe;
mod pixel;
mod plan;
mod quad_plan;
mod quad_samples;
mod rectification;
mod sparse_history;
mod view;

pub(super) use plan::Planned;
pub(super) use quad_plan::given_quads;

use crate::cpu::explain::{explain, note_stored, note_stored_mean, of_view};
use crate::cpu::history::NextSurfaces;
use crate::cpu::inputs::Inputs;
use crate::cpu::pass::Pass;
use crate::cpu::pixel::{AlphaTargets, Targets, for_pixels};
use crate::stats::FrameStats;
use pixel::RectifiedView;
use view::{GivenAlbedo, GivenAlpha, View};

/// Runs the loops for every view.
pub(super) fn run(pass: Pass<'_, '_>) -> FrameStats {
    let Pass { desc, history, frame, quads, output, mut alpha, mut traces, mut noted } = pass;
    let has_history = history.is_filled();
    let mut stats = FrameStats::default();
    for (i, quads) in quads.iter().enumerate() {
        let state = history.advance(i, frame);
        let inputs = Inputs::new(desc, frame, i, &state, has_history);
        let (past, NextSurfaces { words: surfaces, noise, alpha: stored, albedo }) = history.split_surfaces(i);
        let given = alpha.as_ref().map(|alpha| GivenAlpha { given: alpha.given[i], past: past.alpha });
        let textures = frame.albedo.map(|albedo| GivenAlbedo { given: albedo[i], past: past.albedo });
        let view = View { alpha: given, albedo: textures, ..View::new(desc, frame, inputs, past.words, past.noise) };
        let traces = traces.as_mut().map(|t| &mut t[i]);
        let alpha = alpha.as_mut().map(|alpha| AlphaTargets { stored, output: &mut alpha.output[i] });
        let targets = Targets { surfaces, noise, albedo, output: &mut output[i], alpha, traces };
        let rectified = view.rectify_quads(quads, &view.observe_quads(quads));
        let rectified = RectifiedView { view: &view, quads, rectified: &rectified };
        stats = stats.add(for_pixels(targets, &rectified));
        if let Some(pixel) = of_view(&mut noted, i) {
            explain(&rectified, if view.antialiases { note_stored_mean } else { note_stored }, pixel);
        }
    }
    stats
}
