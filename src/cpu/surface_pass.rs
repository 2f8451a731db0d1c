//! Loop over pixels for the methods that store surfaces (smr, taa).

use super::Pass;
use super::inputs::Inputs;
use super::surface_history::SurfaceHistory;
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
    let width = desc.size_px[0] as usize;
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
        let mut noise = noise.chunks_mut(width);
        let mut trace_rows = traces.as_mut().map(|t| t[i].pixels_mut().chunks_mut(width));
        let mut rows: Vec<_> = surfaces
            .chunks_mut(width)
            .zip(output[i].pixels_mut().chunks_mut(width))
            .map(|(surfaces, out)| Row {
                surfaces,
                noise: noise.next(),
                out,
                trace: trace_rows.as_mut().and_then(Iterator::next),
            })
            .collect();
        let row = |(y, row): (usize, &mut Row<'_>)| {
            let mut stats = FrameStats::default();
            for x in 0..width {
                let pixel = process_pixel(&view, x as u32, y as u32, &mut stats);
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
        stats = stats.add(rows.par_iter_mut().enumerate().map(row).reduce(FrameStats::default, FrameStats::add));
        history.build_mip_chain(i);
    }
    stats
}
