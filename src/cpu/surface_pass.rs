//! Loop over pixels for the methods that store surfaces (smr, taa).

use super::Pass;
use super::explain::{explain, note_surface, of_view};
use super::history::NextSurfaces;
use super::inputs::Inputs;
use super::pixel::{Pixel, ProcessPixel};
use super::surface_history::SurfaceHistory;
use crate::image::Image;
use crate::kernel::debug_view::PixelTrace;
use crate::kernel::noise::candidate_texel;
use crate::notes::{NoNotes, Notes};
use crate::parallel::{ProcessRow, process_rows};
use crate::stats::FrameStats;

/// Images of a view that a pass writes: `noise` is empty without noisy candidates.
pub(super) struct Targets<'a> {
    pub surfaces: &'a mut [[u32; 2]],
    pub noise: &'a mut [u32],
    /// Empty in frames without albedo.
    pub albedo: &'a mut [u32],
    pub output: &'a mut Image<[f32; 3]>,
    pub alpha: Option<AlphaTargets<'a>>,
    pub traces: Option<&'a mut Image<PixelTrace>>,
}

/// Alpha of a view that a pass writes.
pub(super) struct AlphaTargets<'a> {
    pub stored: &'a mut [f32],
    pub output: &'a mut Image<f32>,
}

struct Row<'a> {
    surfaces: &'a mut [[u32; 2]],
    noise: Option<&'a mut [u32]>,
    albedo: Option<&'a mut [u32]>,
    out: &'a mut [[f32; 3]],
    /// To store, and to show.
    alpha: Option<[&'a mut [f32]; 2]>,
    trace: Option<&'a mut [PixelTrace]>,
}

/// A method that reads and stores surfaces.
pub(super) trait SurfaceMethod: Sync {
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
pub(super) fn run(pass: Pass<'_, '_>, method: &impl SurfaceMethod) -> FrameStats {
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

/// Runs a pass for every pixel of a view, rows in parallel.
pub(super) fn for_pixels(targets: Targets<'_>, pass: &impl ProcessPixel) -> FrameStats {
    let width = targets.output.width();
    let mut noise = targets.noise.chunks_mut(width);
    let mut albedo = targets.albedo.chunks_mut(width);
    let mut alpha = targets
        .alpha
        .map(|AlphaTargets { stored, output }| stored.chunks_mut(width).zip(output.pixels_mut().chunks_mut(width)));
    let mut traces = targets.traces.map(|t| t.pixels_mut().chunks_mut(width));
    let mut rows: Vec<_> = targets
        .surfaces
        .chunks_mut(width)
        .zip(targets.output.pixels_mut().chunks_mut(width))
        .map(|(surfaces, out)| Row {
            surfaces,
            noise: noise.next(),
            albedo: albedo.next(),
            out,
            alpha: alpha.as_mut().and_then(Iterator::next).map(|(stored, shown)| [stored, shown]),
            trace: traces.as_mut().and_then(Iterator::next),
        })
        .collect();
    process_rows(&mut rows, pass)
}

impl<P: ProcessPixel> ProcessRow<Row<'_>> for P {
    #[inline(always)]
    fn process(&self, y: u32, row: &mut Row<'_>) -> FrameStats {
        let mut stats = FrameStats::default();
        for x in 0..row.out.len() {
            let pixel = ProcessPixel::process(self, x as u32, y, &mut stats, &mut NoNotes);
            row.out[x] = pixel.output.to_array();
            row.surfaces[x] = pixel.surface;
            if let Some(noise) = &mut row.noise {
                noise[x] = pixel.noise;
            }
            if let Some(albedo) = &mut row.albedo {
                albedo[x] = pixel.albedo;
            }
            if let Some([stored, shown]) = &mut row.alpha {
                [shown[x], stored[x]] = pixel.alpha;
            }
            if let Some(trace) = &mut row.trace {
                trace[x] = pixel.trace;
            }
        }
        stats
    }
}
