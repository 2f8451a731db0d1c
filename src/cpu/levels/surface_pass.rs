//! Loop over views for the methods that store surfaces (smr, taa, taau).

use super::surface_history::SurfaceHistory;
use crate::cpu::explain::{explain, note_surface, of_view};
use crate::cpu::history::NextSurfaces;
use crate::cpu::inputs::Inputs;
use crate::cpu::pass::Pass;
use crate::cpu::pixel::{Pixel, ProcessPixel, Targets, for_pixels};
use crate::kernel::mip_noise::candidate_texel;
use crate::notes::Notes;
use crate::stats::FrameStats;

/// A method that reads and stores surfaces.
pub(crate) trait SurfaceMethod: Sync {
    /// Processes pixel `px` of a view, as [`ProcessPixel::process`].
    fn pixel(&self, view: &SurfaceHistory<'_>, px: [u32; 2], stats: &mut FrameStats, notes: &mut impl Notes) -> Pixel;
}

struct InView<'a, M> {
    method: &'a M,
    view: SurfaceHistory<'a>,
}

impl<M: SurfaceMethod> ProcessPixel for InView<'_, M> {
    #[inline(always)]
    fn process(&self, x: u32, y: u32, stats: &mut FrameStats, notes: &mut impl Notes) -> Pixel {
        let pixel = self.method.pixel(&self.view, [x, y], stats, notes);
        Pixel { output: self.view.inputs.unexposed(pixel.output), ..pixel }
    }
}

/// Runs a method for every pixel of every view.
pub(crate) fn run(pass: Pass<'_, '_>, method: &impl SurfaceMethod) -> FrameStats {
    let Pass { desc, history, frame, quads, output, mut traces, mut noted, .. } = pass;
    let has_history = history.is_filled();
    let mut stats = FrameStats::default();
    for i in 0..frame.views.len() {
        let state = history.advance(i, frame);
        let inputs = Inputs::new(desc, frame, i, &state, has_history);
        history.build_candidates(i, |x, y| {
            let (color, usable) = inputs.candidate(x, y);
            candidate_texel(color, usable, inputs.noise(x, y).expect("the frame was checked to have noise"))
        });
        let (past, NextSurfaces { words: surfaces, noise, .. }) = history.split_surfaces(i);
        let in_view = InView { method, view: SurfaceHistory { inputs, quads: quads.get(i), past } };
        let traces = traces.as_mut().map(|t| &mut t[i]);
        let targets = Targets { surfaces, noise, albedo: &mut [], output: &mut output[i], alpha: None, traces };
        stats = stats.add(for_pixels(targets, &in_view));
        if let Some(pixel) = of_view(&mut noted, i) {
            explain(&in_view, note_surface, pixel);
        }
        history.build_mip_chain(i);
    }
    stats
}
