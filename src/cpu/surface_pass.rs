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
use crate::kernel::noise::candidate_texel;
use crate::settings::{Method, Settings};
use crate::stats::FrameStats;
use glam::Vec3;
use rayon::prelude::*;

/// What becomes of a pixel.
pub(super) struct Pixel {
    pub shown: Vec3,
    /// What is stored.
    pub surface: [u32; 2],
    /// How noisy that is, where it matters.
    pub noise: u32,
    pub trace: PixelTrace,
}

/// What is stored, shown and traced of a row of pixels.
struct Row<'a> {
    surfaces: &'a mut [[u32; 2]],
    noise: Option<&'a mut [u32]>,
    out: &'a mut [[f32; 3]],
    trace: Option<&'a mut [PixelTrace]>,
}

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
        let inputs = Inputs::new(desc, settings, frame, i, &constants, is_filled);
        history.build_candidates(i, |x, y| {
            let (color, usable) = inputs.candidate(x, y);
            candidate_texel(color, usable, inputs.noise(x, y).expect("a frame is refused that lacks its noise"))
        });
        let (past, surfaces, noise) = history.split_surfaces(i);
        let at = Remembered { inputs, past };
        let mut noise = noise.chunks_mut(width);
        let mut traces = trace.as_mut().map(|t| t[i].pixels_mut().chunks_mut(width));
        let mut rows: Vec<_> = surfaces
            .chunks_mut(width)
            .zip(output[i].pixels_mut().chunks_mut(width))
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
                let made = if settings.method == Method::Taa {
                    taa_pass::pixel(&at, x as u32, y as u32, &mut stats)
                } else {
                    smr.pixel(&at, x as u32, y as u32, &mut stats)
                };
                row.out[x] = made.shown.to_array();
                row.surfaces[x] = made.surface;
                if let Some(noise) = &mut row.noise {
                    noise[x] = made.noise;
                }
                if let Some(trace) = &mut row.trace {
                    trace[x] = made.trace;
                }
            }
            stats
        };
        stats = stats.add(rows.par_iter_mut().enumerate().map(row).reduce(FrameStats::default, FrameStats::add));
        history.build_chain(i);
    }
    stats
}
