//! Time and sample reduction of foveated against uniform path tracing.

use super::traced_view::{FrameTime, Pattern, TracedView};
use crate::Tracer;
use crate::sampling::{Layers, Regions, Sampling};
use afterimage_lab::clock::Quartiles;
use serde::Serialize;
use std::collections::BTreeMap;

/// Rounds. Each round times every pattern once, so that drift affects all patterns alike.
pub const ROUNDS: u64 = 3;

/// Samples per pixel of the uniform frame. Its time is scaled in proportion to the pattern's samples.
pub const UNIFORM_SAMPLES: u32 = 4;

/// Without a GPU, uniform frames with several samples a pixel are traced in every eighth band of rows only, and their
/// times are scaled.
pub const UNIFORM_EVERY: u32 = 8;

/// Results of a pattern in a scene.
#[derive(Clone, Debug, Serialize)]
pub struct PatternReport {
    /// Name of the pattern.
    pub pattern: String,
    /// Clock of the reductions: `CPU` time, or `wall` time on a hardware GPU.
    pub clock: &'static str,
    /// Samples per pixel where the pattern is densest, and everywhere in the uniform frame.
    pub samples_per_pixel: u32,
    /// Samples of the uniform frame divided by those of the pattern without overlaps for blending and partial blocks at
    /// borders.
    pub ideal_reduction: Option<f64>,
    /// Samples of a foveated frame, the last one.
    pub samples: u64,
    /// Samples of the uniform frame divided by those traced.
    pub sample_reduction: f64,
    /// Time of the uniform frame divided by that of the foveated one, including planning and interpolation.
    pub time_reduction: Option<f64>,
    /// Time reduction over ideal reduction.
    pub share_of_ideal: Option<f64>,
    /// Share of the uniform frame's time that is saved over the share of its samples that is.
    pub share_of_saved: Option<f64>,
    /// Time reduction over sample reduction.
    pub share_of_reduction: Option<f64>,
    /// CPU time of a foveated frame.
    pub cpu_ms: Option<Quartiles>,
    /// CPU time of a uniform frame with as many samples per pixel.
    pub uniform_cpu_ms: Option<Quartiles>,
    /// Wall time of a foveated frame.
    pub wall_ms: Option<Quartiles>,
    /// Wall time of a uniform frame with as many samples per pixel.
    pub uniform_wall_ms: Option<Quartiles>,
}

impl PatternReport {
    /// Times of a uniform and of a foveated frame by [`PatternReport::clock`].
    pub fn times(&self) -> Option<(Quartiles, Quartiles)> {
        if self.clock == "wall" { self.uniform_wall_ms.zip(self.wall_ms) } else { self.uniform_cpu_ms.zip(self.cpu_ms) }
    }
}

/// The paper's regions, optionally with a quarter of their samples.
pub fn regions(of: [u32; 3], is_quartered: bool, radius_scale: f32, gaze_px: [f32; 2]) -> Pattern {
    let [a, b, c] = of;
    let (samples, share) = if is_quartered { (of.map(|s| s / 4), ", a quarter of the samples") } else { (of, "") };
    let radii = if radius_scale == 1.0 { "" } else { ", halved radii" };
    Pattern {
        name: format!("regions {a},{b},{c}{radii}{share}"),
        sampling: Sampling::Regions(Regions { samples, radius_scale, ..Regions::default() }),
        samples: samples[0],
        gaze_px,
    }
}

/// One path a block of 1, 4 or 8 pixels a side, against one a pixel.
pub fn one_path(gaze_px: [f32; 2]) -> Pattern {
    let regions = Regions { samples: [1; 3], blocks: [4, 8], diameters_deg: [5.0, 15.0], ..Regions::default() };
    Pattern {
        name: "blocks of 1, 4, 8 pixels, one path each".into(),
        sampling: Sampling::Regions(regions),
        samples: 1,
        gaze_px,
    }
}

/// The papers' patterns, with a quarter of their samples where those are divisible by 4, which keeps the ratio.
pub fn patterns(subject: &TracedView) -> Vec<Pattern> {
    let middle = subject.middle_px();
    vec![
        regions([32, 16, 8], true, 1.0, middle),
        regions([32, 8, 4], true, 1.0, middle),
        regions([32, 2, 1], false, 1.0, middle),
        Pattern {
            name: "layers 6,10,20 degrees, steps 1,2,3,4".into(),
            sampling: Sampling::Layers(Layers::default()),
            samples: 4,
            gaze_px: middle,
        },
    ]
}

/// Times every pattern and uniform frames, `rounds` times each.
pub fn measure(
    subject: &TracedView,
    tracer: &Tracer,
    patterns: &[Pattern],
    rounds: u64,
    by_wall: bool,
) -> Vec<PatternReport> {
    let geometry = *subject.geometry();
    let size = geometry.size_px();
    let pixels = f64::from(size[0]) * f64::from(size[1]);
    let uniform_samples = |p: &Pattern| p.samples.min(UNIFORM_SAMPLES);
    let mut uniform: BTreeMap<u32, Vec<FrameTime>> = patterns.iter().map(|p| (uniform_samples(p), vec![])).collect();
    let mut took: Vec<Vec<FrameTime>> = vec![vec![]; patterns.len()];
    let mut traced = vec![0; patterns.len()];
    // Drivers compile at the first dispatch.
    subject.few(tracer);
    // A frame with one sample a pixel is soon traced, and bands of so few would mostly start kernels.
    let every = |samples| if by_wall || samples == 1 { 1 } else { UNIFORM_EVERY };
    for round in 0..rounds {
        for (&samples, took) in &mut uniform {
            took.push(subject.uniform(tracer, samples, every(samples), round));
        }
        for (i, p) in patterns.iter().enumerate() {
            let frame = subject.foveated(tracer, p, round);
            traced[i] = frame.samples;
            took[i].push(frame.took);
        }
    }
    let report = |(i, p): (usize, &Pattern)| {
        let all = pixels * f64::from(p.samples);
        let ideal_reduction = match p.sampling {
            Sampling::Regions(regions) => Some(all / regions.ideal_samples(&geometry)),
            _ => None,
        };
        let uniform = &uniform[&uniform_samples(p)];
        let more = f64::from(p.samples) / f64::from(uniform_samples(p));
        let of = |took: &[FrameTime], ms: fn(&FrameTime) -> f64, factor: f64| {
            Quartiles::of(&took.iter().map(|t| ms(t) * factor).collect::<Vec<_>>())
        };
        let mut report = PatternReport {
            pattern: p.name.clone(),
            clock: if by_wall { "wall" } else { "CPU" },
            samples_per_pixel: p.samples,
            ideal_reduction,
            samples: traced[i],
            sample_reduction: all / traced[i] as f64,
            time_reduction: None,
            share_of_ideal: None,
            share_of_saved: None,
            share_of_reduction: None,
            cpu_ms: of(&took[i], |t| t.cpu_ms, 1.0),
            uniform_cpu_ms: of(uniform, |t| t.cpu_ms, more),
            wall_ms: of(&took[i], |t| t.wall_ms, 1.0),
            uniform_wall_ms: of(uniform, |t| t.wall_ms, more),
        };
        report.time_reduction = report.times().map(|(uniform, foveated)| uniform.median / foveated.median);
        report.share_of_ideal = report.time_reduction.zip(ideal_reduction).map(|(time, ideal)| time / ideal);
        let saved = |reduction: f64| 1.0 - reduction.recip();
        report.share_of_saved = report.time_reduction.map(|time| saved(time) / saved(report.sample_reduction));
        report.share_of_reduction = report.time_reduction.map(|time| time / report.sample_reduction);
        report
    };
    patterns.iter().enumerate().map(report).collect()
}
