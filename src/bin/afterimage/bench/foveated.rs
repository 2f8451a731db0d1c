//! What foveated sampling saves of the time of uniform sampling, against what it saves of the samples.

use super::subject::Subject;
use afterimage::report::clock::Quartiles;
use afterimage::trace::Tracer;
use afterimage::trace::sampling::{Layers, Regions, Sampling};
use serde::Serialize;

/// Rounds over all patterns; each is timed once a round, so that drift meets all alike.
const ROUNDS: u64 = 3;

/// A pattern of a scene, with the gaze in the middle.
#[derive(Clone, Debug, Serialize)]
pub struct PatternReport {
    pub pattern: String,
    /// Samples of a pixel where it is sampled most; the uniform frame has as many everywhere.
    pub samples_per_pixel: u32,
    /// Samples of the uniform frame over those that the pattern's regions have, without blends and borders.
    pub ideal_reduction: Option<f64>,
    /// Samples of the uniform frame over those traced.
    pub sample_reduction: f64,
    /// CPU time of the uniform frame over that of the foveated one, plan and filling in included.
    pub time_reduction: Option<f64>,
    /// Time reduction over ideal reduction.
    pub share_of_ideal: Option<f64>,
    pub cpu_ms: Option<Quartiles>,
    pub uniform_cpu_ms: Option<Quartiles>,
}

/// The papers' patterns, with a quarter of their samples where all are divisible: the ratio is what counts.
fn patterns() -> Vec<(String, Sampling, u32)> {
    let regions = |samples: [u32; 3], of: &str| {
        (format!("regions {of}"), Sampling::Regions(Regions { samples, ..Regions::default() }), samples[0])
    };
    vec![
        regions([8, 4, 2], "32,16,8 at a quarter"),
        regions([8, 2, 1], "32,8,4 at a quarter"),
        regions([32, 2, 1], "32,2,1"),
        ("layers 6,10,20 degrees, steps 1,2,3,4".into(), Sampling::Layers(Layers::default()), 4),
    ]
}

/// Times every pattern with `tracer`, and uniform frames of 4 samples, whose time is taken to grow in proportion.
pub fn measure(subject: &Subject, tracer: &Tracer) -> Vec<PatternReport> {
    const UNIFORM: u32 = 4;
    let geometry = *subject.geometry();
    let size = geometry.size_px();
    let gaze = size.map(|s| 0.5 * (s as f32 - 1.0));
    let mut uniform = vec![];
    let patterns = patterns();
    let mut took = vec![vec![]; patterns.len()];
    let mut traced = vec![0; patterns.len()];
    for round in 0..=ROUNDS {
        // The first round is for warming up.
        let (frame, ms) = subject.foveated(tracer, &Sampling::Uniform, gaze, UNIFORM, round);
        if round > 0 {
            uniform.push(ms / frame.samples.iter().sum::<u64>() as f64);
        }
        for (i, (_, sampling, samples)) in patterns.iter().enumerate() {
            let (frame, ms) = subject.foveated(tracer, sampling, gaze, *samples, round);
            traced[i] = frame.samples.iter().sum::<u64>();
            if round > 0 {
                took[i].push(ms);
            }
        }
    }
    let report = |(i, (name, sampling, samples)): (usize, &(String, Sampling, u32))| {
        let all = f64::from(size[0]) * f64::from(size[1]) * f64::from(*samples);
        let ideal_reduction = match sampling {
            Sampling::Regions(regions) => Some(all / regions.ideal_samples(&geometry)),
            _ => None,
        };
        let uniform_ms: Vec<f64> = uniform.iter().map(|ms| ms * all).collect();
        let (cpu_ms, uniform_cpu_ms) = (Quartiles::of(&took[i]), Quartiles::of(&uniform_ms));
        let time_reduction = uniform_cpu_ms.zip(cpu_ms).map(|(u, f)| u.median / f.median);
        PatternReport {
            pattern: name.clone(),
            samples_per_pixel: *samples,
            ideal_reduction,
            sample_reduction: all / traced[i] as f64,
            time_reduction,
            share_of_ideal: time_reduction.zip(ideal_reduction).map(|(time, ideal)| time / ideal),
            cpu_ms,
            uniform_cpu_ms,
        }
    };
    patterns.iter().enumerate().map(report).collect()
}

/// A table.
pub fn print(patterns: &[PatternReport]) {
    say!("    foveated ms  uniform ms  ideal  samples  time  share of ideal  pattern");
    for p in patterns {
        let (Some(ms), Some(uniform), Some(time)) = (p.cpu_ms, p.uniform_cpu_ms, p.time_reduction) else { continue };
        let or_dash =
            |v: Option<f64>, factor: f64, unit: &str| v.map_or("-".into(), |v| format!("{:.1}{unit}", v * factor));
        say!(
            "{:>15.0} {:>11.0} {:>6} {:>7.1}x {:>4.1}x {:>15}  {}",
            ms.median,
            uniform.median,
            or_dash(p.ideal_reduction, 1.0, "x"),
            p.sample_reduction,
            time,
            or_dash(p.share_of_ideal, 100.0, " %"),
            p.pattern,
        );
    }
}
