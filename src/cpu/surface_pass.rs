//! The loop over pixels of the methods that remember surfaces.

use super::CpuFrame;
use super::history::History;
use super::inputs::Inputs;
use super::remembered::Remembered;
use super::smr_pass::Smr;
use super::taa_pass;
use crate::frame::ContextDesc;
use crate::image::Image;
use crate::kernel::debug_view::PixelTrace;
use crate::settings::{Method, Settings};
use crate::stats::FrameStats;
use rayon::prelude::*;

/// What is stored, shown and traced of a row of pixels.
type Row<'a> = (&'a mut [[u32; 2]], &'a mut [[f32; 3]], Option<&'a mut [PixelTrace]>);

pub(super) fn run(
    desc: &ContextDesc,
    settings: &Settings,
    history: &mut History,
    frame: &CpuFrame<'_>,
    output: &mut [Image<[f32; 3]>],
    mut trace: Option<&mut [Image<PixelTrace>]>,
) -> FrameStats {
    let is_filled = history.is_filled();
    let smr = Smr::new(settings);
    let width = desc.size_px[0] as usize;
    let mut stats = FrameStats::default();
    for (i, view) in frame.views.iter().enumerate() {
        let held = history.held_gaze(i);
        let constants = view.facts.constants(*held, settings, i, frame.index);
        *held = Some(constants.gaze_px);
        let (past, words) = history.split_surfaces(i);
        let at = Remembered { inputs: Inputs::new(desc, settings, frame, i, &constants, is_filled), past };
        let mut traces = trace.as_mut().map(|t| t[i].pixels_mut().chunks_mut(width));
        let mut rows: Vec<_> = words
            .chunks_mut(width)
            .zip(output[i].pixels_mut().chunks_mut(width))
            .map(|(words, out)| (words, out, traces.as_mut().and_then(Iterator::next)))
            .collect();
        let row = |(y, (words, out, trace)): (usize, &mut Row<'_>)| {
            let mut stats = FrameStats::default();
            for x in 0..width {
                let (shown, stored, decided) = if settings.method == Method::Taa {
                    taa_pass::pixel(&at, x as u32, y as u32, &mut stats)
                } else {
                    smr.pixel(&at, x as u32, y as u32, &mut stats)
                };
                out[x] = shown.to_array();
                words[x] = stored;
                if let Some(trace) = trace {
                    trace[x] = decided;
                }
            }
            stats
        };
        stats = stats.add(rows.par_iter_mut().enumerate().map(row).reduce(FrameStats::default, FrameStats::add));
        history.build_chain(i);
    }
    stats
}
