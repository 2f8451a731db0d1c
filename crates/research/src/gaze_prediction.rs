//! What predicting the gaze of a late tracker gains over holding its last sample:
//! `cargo research gaze-prediction SCANPATH.csv ...`.
//!
//! The predictor is ballistic: while the last samples are of a saccade, it fits a displacement with the least jerk and
//! the duration of the main sequence to the samples since the saccade's begin, and predicts where that ends. Held gaze
//! is what `run --gaze-latency` uses. The bound knows the true gaze whenever the last samples are of a saccade: no
//! predictor that begins at a saccade's begin errs less.
//!
//! Makes the figures of predictors in `docs/equal-time.md`, "Late gaze"; a second.

use crate::error::AnyError;
use afterimage_lab::scanpath::{Scanpath, read_csv};
use clap::Args;
use std::path::Path;

const FRAMES_PER_S: f64 = 90.0;
const LATENCIES_MS: [f64; 5] = [20.0, 40.0, 60.0, 80.0, 120.0];
/// A fovea of 5 degrees misses the eye beyond this.
const MISS_DEG: f64 = 2.5;
/// A saccade is faster, over [`WINDOW_S`]; its begin is where the speed falls below half of that.
const SACCADE_DEG_PER_S: f64 = 60.0;
const WINDOW_S: f64 = 0.008;
/// Longer than any saccade.
const LONGEST_S: f64 = 0.12;
/// Duration of a saccade: so many seconds, and so many more for each degree (Carpenter 1988).
const MAIN_SEQUENCE_S: [f64; 2] = [0.021, 0.0022];
/// Weight of the square of an amplitude's logarithm over [`USUAL_DEG`], against squares of degrees: a few samples at a
/// saccade's begin fit amplitudes of 2 and of 30 degrees alike.
const PRIOR: f64 = 0.05;
const USUAL_DEG: f64 = 6.0;

/// Seconds, and degrees to the right and downwards.
type Sample = (f64, [f64; 2]);

/// What predicting the gaze of a late tracker gains over holding its last sample
#[derive(Args, Clone, Debug)]
pub struct GazePredictionArgs {
    /// Scanpaths that say their screen's size and distance
    #[arg(required = true, value_name = "SCANPATH.csv")]
    pub scanpaths: Vec<String>,
}

pub fn bench(args: &GazePredictionArgs) -> Result<(), AnyError> {
    say!("| scanpath | latency, ms | held: mean error, missed | predicted | bound |");
    say!("|---|---|---|---|---|");
    for file in &args.scanpaths {
        let path = read_csv(Path::new(file))?;
        let samples = angles(&path).ok_or_else(|| format!("{file}: the screen's size and distance are unknown"))?;
        for latency_ms in LATENCIES_MS {
            let errors = errors_deg(&samples, 1e-3 * latency_ms);
            let cells = [0, 1, 2].map(|i| {
                let mean = errors.iter().map(|e| e[i]).sum::<f64>() / errors.len() as f64;
                let missed = errors.iter().filter(|e| e[i] > MISS_DEG).count() as f64 / errors.len() as f64;
                format!("{mean:.2}, {:.1} %", 100.0 * missed)
            });
            say!("| `{file}` | {latency_ms} | {} |", cells.join(" | "));
        }
    }
    Ok(())
}

fn angles(path: &Scanpath) -> Option<Vec<Sample>> {
    let slope = path.screen().tangent_per_px()?;
    let size = path.screen().size_px;
    let angle = |px: [f32; 2]| {
        let [x, y] = [0, 1].map(|i| (f64::from(px[i]) - 0.5 * f64::from(size[i])) * slope[i]);
        [x.atan().to_degrees(), y.atan2(x.hypot(1.0)).to_degrees()]
    };
    Some(path.samples().iter().filter_map(|s| Some((s.t_s, angle(s.px?)))).collect())
}

/// Errors in degrees of the held gaze, the predicted gaze and the bound, in every frame whose gaze is known.
fn errors_deg(samples: &[Sample], latency_s: f64) -> Vec<[f64; 3]> {
    let until = |t_s: f64| &samples[..samples.partition_point(|s| s.0 <= t_s + 1e-9)];
    let frames = (0..).map(|i| samples[0].0 + LONGEST_S + latency_s + f64::from(i) / FRAMES_PER_S);
    frames
        .take_while(|t_s| *t_s <= samples[samples.len() - 1].0)
        .filter_map(|t_s| {
            let &(seen_s, truth) = until(t_s).last()?;
            let known = until(t_s - latency_s);
            let &(_, held) = known.last()?;
            let landing = landing(known);
            // Lost gaze has no error.
            let is_known = t_s - seen_s < WINDOW_S;
            let bound = if landing.is_some() { 0.0 } else { distance(held, truth) };
            is_known.then(|| [distance(held, truth), distance(landing.unwrap_or(held), truth), bound])
        })
        .collect()
}

/// Where the saccade ends to which the last samples belong; `None` without one.
fn landing(known: &[Sample]) -> Option<[f64; 2]> {
    let last = known.len() - 1;
    let speed = |i: usize| {
        let from = known[..i].iter().rposition(|s| known[i].0 - s.0 >= WINDOW_S - 1e-9)?;
        Some(distance(known[i].1, known[from].1) / (known[i].0 - known[from].0))
    };
    speed(last).filter(|v| *v > SACCADE_DEG_PER_S)?;
    let is_before =
        |i: &usize| known[last].0 - known[*i].0 > LONGEST_S || speed(*i).is_none_or(|v| v < 0.5 * SACCADE_DEG_PER_S);
    let begin = (0..last).rev().find(is_before)?;
    let (begin_s, from) = known[begin];
    let done = distance(known[last].1, from);
    let direction = [0, 1].map(|i| (known[last].1[i] - from[i]) / done);
    let along = |s: &Sample| (0..2).map(|i| (s.1[i] - from[i]) * direction[i]).sum::<f64>();
    // Amplitudes from half a degree to 30 degrees in steps of 12 %; the begin is known to a few milliseconds.
    let amplitudes = (0..37).map(|i| 0.5 * 1.12f64.powi(i)).filter(|a| *a >= done);
    let fits = amplitudes.flat_map(|amplitude| (-4..=2).map(move |shift| (amplitude, 0.002 * f64::from(shift))));
    let misfit = |&(amplitude, shift_s): &(f64, f64)| {
        let duration_s = MAIN_SEQUENCE_S[0] + MAIN_SEQUENCE_S[1] * amplitude;
        let square = |s: &Sample| {
            let expected = amplitude * minimum_jerk((s.0 - begin_s - shift_s) / duration_s);
            (along(s) - expected).powi(2)
        };
        let samples = &known[begin..];
        let mean = samples.iter().map(square).sum::<f64>() / samples.len() as f64;
        mean + PRIOR * (amplitude / USUAL_DEG).ln().powi(2) / samples.len() as f64
    };
    let (amplitude, _) = fits.min_by(|a, b| misfit(a).total_cmp(&misfit(b)))?;
    Some([0, 1].map(|i| from[i] + amplitude * direction[i]))
}

/// Flash & Hogan 1985.
fn minimum_jerk(share: f64) -> f64 {
    let u = share.clamp(0.0, 1.0);
    u * u * u * (10.0 + u * (6.0 * u - 15.0))
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}
