//! Tracing of one frame for one eye.

use super::TraceArgs;
use super::frames::Picture;
use super::report::Counts;
use super::setup::Setup;
use afterimage::Image;
use afterimage_lab::view::View;
use afterimage_trace::film::Film;
use afterimage_trace::sampling::Sampling;
use afterimage_trace::work::Spans;
use indicatif::ProgressBar;
use std::ops::Range;

/// Samples traced between two updates of the progress bar.
const STEP_ITEMS: u64 = 1 << 20;

/// One frame for one eye.
pub struct EyeFrame {
    pub view: View,
    pub frame: u64,
    /// Index of its sequence of random numbers.
    pub draws: u64,
}

impl EyeFrame {
    /// Traces the same number of samples in every pixel.
    pub fn uniform(&self, args: &TraceArgs, setup: &Setup, bar: &ProgressBar) -> (Picture, Counts) {
        let mut film = Film::new(args.size);
        for (rows, samples) in steps(args) {
            if samples.start == 0 {
                bar.inc(u64::from(rows.end - rows.start));
            }
            let spans = Spans::uniform(args.size[0], rows, samples);
            setup.tracer.trace(&setup.world, &self.view, self.draws, &spans, &mut film);
        }
        let samples = film.moments.pixels().iter().map(|m| u64::from(m.count)).sum();
        let (rays, nonfinite) = (film.rays, film.nonfinite);
        let counts = Counts { samples: vec![samples], ideal_samples: Some(samples as f64), rays, nonfinite };
        let lod = Image::filled(args.size, 0.0);
        (Picture { color: film.color(), variance: Some(film.variance()), lod }, counts)
    }

    /// Traces a foveated frame around a gaze.
    pub fn foveated(
        &self,
        args: &TraceArgs,
        setup: &Setup,
        sampling: &Sampling,
        gaze_px: [f32; 2],
        bar: &ProgressBar,
    ) -> (Picture, Counts) {
        let geometry = self.view.geometry();
        let plan = sampling.plan(geometry, gaze_px, args.spp, self.frame);
        let done = plan.trace(&setup.tracer, &setup.world, &self.view, self.draws);
        bar.inc(u64::from(args.size[1]));
        let ideal_samples = args.pattern.of.ideal_samples(sampling, geometry, gaze_px, args.spp);
        let counts = Counts { samples: done.samples, ideal_samples, rays: done.rays, nonfinite: done.nonfinite };
        (Picture { color: done.color, variance: None, lod: done.lod }, counts)
    }
}

/// Ranges of rows and samples that are traced together.
fn steps(args: &TraceArgs) -> impl Iterator<Item = (Range<u32>, Range<u32>)> {
    let [w, h] = args.size;
    let samples = (STEP_ITEMS / u64::from(w)).clamp(1, u64::from(args.spp)) as u32;
    let rows = (STEP_ITEMS / (u64::from(w) * u64::from(samples))).clamp(1, u64::from(h)) as u32;
    ranges(h, rows).flat_map(move |rows| ranges(args.spp, samples).map(move |samples| (rows.clone(), samples)))
}

/// The range 0 to `end`, split into ranges of `step`.
fn ranges(end: u32, step: u32) -> impl Iterator<Item = Range<u32>> {
    (0..end).step_by(step as usize).map(move |start| start..start.saturating_add(step).min(end))
}
