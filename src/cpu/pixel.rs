//! A pixel of the passes that store surfaces or samples, and the loop over the pixels of a view.

use crate::image::Image;
use crate::kernel::debug_view::PixelTrace;
use crate::notes::{NoNotes, Notes};
use crate::parallel::{ProcessRow, process_rows};
use crate::stats::FrameStats;
use glam::Vec3;

pub(super) struct Pixel {
    pub output: Vec3,
    pub surface: [u32; 2],
    /// Packed noise of the surface; stored only for noisy candidates.
    pub noise: u32,
    /// Alpha to show, and alpha to store with the surface; of frames with alpha.
    pub alpha: [f32; 2],
    /// Packed albedo of the surface; of frames with albedo.
    pub albedo: u32,
    pub trace: PixelTrace,
}

/// A pass that computes one pixel at a time.
pub(super) trait ProcessPixel: Sync {
    /// Processes pixel (x, y), counts it in `stats` and takes `notes`. Always inlined into the loop over a row, which
    /// is compiled for several instruction sets.
    fn process(&self, x: u32, y: u32, stats: &mut FrameStats, notes: &mut impl Notes) -> Pixel;
}

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
