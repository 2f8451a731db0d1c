//! Loop over pixels for the methods that store surfaces (smr, taa).

use super::Pass;
use super::inputs::Inputs;
use super::surface_history::SurfaceHistory;
use crate::image::Image;
use crate::kernel::debug_view::PixelTrace;
use crate::kernel::noise::candidate_texel;
use crate::stats::FrameStats;
use glam::Vec3;
use rayon::prelude::*;

/// Result of a pixel.
pub(super) struct Pixel {
    /// Color for the frame's output.
    pub output: Vec3,
    /// Packed surface to store.
    pub surface: [u32; 2],
    /// Packed noise of the surface; stored only for noisy candidates.
    pub noise: u32,
    pub trace: PixelTrace,
}

/// Images of a view that a pass writes: `noise` is empty without noisy candidates.
pub(super) struct Targets<'a> {
    pub surfaces: &'a mut [[u32; 2]],
    pub noise: &'a mut [u32],
    pub output: &'a mut Image<[f32; 3]>,
    pub traces: Option<&'a mut Image<PixelTrace>>,
}

/// Results of a row of pixels.
struct Row<'a> {
    surfaces: &'a mut [[u32; 2]],
    noise: Option<&'a mut [u32]>,
    out: &'a mut [[f32; 3]],
    trace: Option<&'a mut [PixelTrace]>,
}

/// Runs `process_pixel`, a method, for every pixel of every view. It adds what it counts to the statistics.
pub(super) fn run(
    pass: Pass<'_, '_>,
    process_pixel: impl Fn(&SurfaceHistory<'_>, u32, u32, &mut FrameStats) -> Pixel + Sync,
) -> FrameStats {
    let Pass { desc, history, frame, output, mut traces } = pass;
    let has_history = history.is_filled();
    let mut stats = FrameStats::default();
    for i in 0..frame.views.len() {
        let held = history.hold(i, &frame.views[i]);
        let inputs = Inputs::new(desc, frame, i, &held, has_history);
        history.build_candidates(i, |x, y| {
            let (color, usable) = inputs.candidate(x, y);
            candidate_texel(color, usable, inputs.noise(x, y).expect("the frame was checked to have noise"))
        });
        let (past, surfaces, noise) = history.split_surfaces(i);
        let view = SurfaceHistory { inputs, past };
        let traces = traces.as_mut().map(|t| &mut t[i]);
        let targets = Targets { surfaces, noise, output: &mut output[i], traces };
        stats = stats.add(for_pixels(targets, |x, y, stats| process_pixel(&view, x, y, stats)));
        history.build_mip_chain(i);
    }
    stats
}

/// Runs `process_pixel` for every pixel of a view, rows in parallel.
pub(super) fn for_pixels(
    targets: Targets<'_>,
    process_pixel: impl Fn(u32, u32, &mut FrameStats) -> Pixel + Sync,
) -> FrameStats {
    let width = targets.output.width();
    let mut noise = targets.noise.chunks_mut(width);
    let mut traces = targets.traces.map(|t| t.pixels_mut().chunks_mut(width));
    let mut rows: Vec<_> = targets
        .surfaces
        .chunks_mut(width)
        .zip(targets.output.pixels_mut().chunks_mut(width))
        .map(|(surfaces, out)| Row {
            surfaces,
            noise: noise.next(),
            out,
            trace: traces.as_mut().and_then(Iterator::next),
        })
        .collect();
    let row = |(y, row): (usize, &mut Row<'_>)| {
        let mut stats = FrameStats::default();
        for x in 0..width {
            let pixel = process_pixel(x as u32, y as u32, &mut stats);
            row.out[x] = pixel.output.to_array();
            row.surfaces[x] = pixel.surface;
            if let Some(noise) = &mut row.noise {
                noise[x] = pixel.noise;
            }
            if let Some(trace) = &mut row.trace {
                trace[x] = pixel.trace;
            }
        }
        stats
    };
    rows.par_iter_mut().enumerate().map(row).reduce(FrameStats::default, FrameStats::add)
}
