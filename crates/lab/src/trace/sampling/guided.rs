//! Guided sampling: distributes a plan's samples by the noise of the history.
//!
//! Taking `n` new samples of standard deviation `deviation` at a point that already holds `known` samples leaves the
//! variance deviation^2 / (known + n). For a fixed budget, the sum of variances over the points is smallest (Lagrange;
//! Neyman 1934 for known = 0) at
//!
//! n = clamp(deviation t - known, least, most)
//!
//! with the one t that spends the budget. Each ring has a budget of its own, so the fovea keeps its samples. `floor(n +
//! draw)` rounds n stochastically; its mean is n.
//!
//! n depends on past frames and on a draw that no path uses, never on this frame's samples, so every point's mean is
//! unbiased given the guide. A caller that weights frames by their sample counts, and derives the guide from the same
//! frames, gets a biased *sum* (Kirk and Arvo 1991): points whose first samples happen to agree receive fewer later
//! samples to correct them.

use super::lattice::Lattice;
use super::{Part, Plan};
use crate::frame::Guide;
use crate::trace::cpu::path_key;
use crate::trace::film::{Film, Moments};
use crate::trace::work::Spans;
use afterimage::kernel::color::luma;
use afterimage::kernel::rng::path_draws;
use afterimage::{Image, SettingsError};
use rayon::prelude::*;

/// Samples that every sampled point gets at least, so that changes are seen.
const MIN_SAMPLES: u32 = 1;

/// Largest number of samples of a point, as a multiple of its ring's. Further samples gain more elsewhere, and the
/// deviation estimate may be wrong.
const MAX_FACTOR: u32 = 8;

/// Sample number reserved for the draws that round counts; no path has it.
const ROUNDING_SAMPLE: u32 = u32::MAX;

impl Film {
    /// Guide from the frames accumulated here, displayed without reprojection: sample counts, and standard deviations
    /// of luma after the tone curve x / (1 + x). Deviations are pooled over 3x3 pixels, as a few samples may agree by
    /// chance.
    pub fn guide(&self) -> Guide {
        let moments = &self.moments;
        let [width, height] = moments.size().map(|s| s as i64);
        let deviation = Image::from_fn_parallel(moments.size(), |[x, y]| {
            let (mut squares, mut freedom, mut mean, mut count) = (0.0, 0.0, 0.0, 0.0);
            for (dx, dy) in (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| (dx, dy))) {
                let (x, y) = (i64::from(x) + dx, i64::from(y) + dy);
                if x < 0 || y < 0 || x >= width || y >= height {
                    continue;
                }
                let m: Moments = moments.at(x as usize, y as usize);
                // Channels of a path are correlated, so their deviations add up.
                squares += luma(m.squares.map(f32::sqrt)).powi(2);
                freedom += m.count.saturating_sub(1) as f32;
                mean += luma(m.mean) * m.count as f32;
                count += m.count as f32;
            }
            // Derivative of x / (1 + x) at the mean.
            (squares / freedom).sqrt() / (1.0 + mean / count).powi(2)
        });
        Guide { known: moments.map(|m| m.count as f32), deviation }
    }
}

/// What a guide says of a lattice point: the smallest sample count of the pixels it stands for, and their mean
/// deviation.
fn history(guide: &Guide, lattice: &Lattice, point: [u32; 2]) -> PointHistory {
    let [xs, ys] = lattice.cell(point, guide.known.size());
    let mut known = f32::INFINITY;
    let (mut sum, mut count) = (0.0, 0.0);
    for (x, y) in ys.flat_map(|y| xs.clone().map(move |x| (x as usize, y as usize))) {
        // NaN counts as 0.
        known = known.min(if guide.known.at(x, y) > 0.0 { guide.known.at(x, y) } else { 0.0 });
        let deviation = guide.deviation.at(x, y);
        if deviation >= 0.0 && deviation.is_finite() {
            sum += f64::from(deviation);
            count += 1.0;
        }
    }
    PointHistory { samples: f64::from(known), deviation: (count > 0.0).then(|| sum / count) }
}
impl Plan {
    /// A plan with the same points whose samples are distributed by `guide`. Each ring spends at most its former number
    /// of samples on average over frames; fewer only where further samples gain nothing. Every point gets at least one
    /// sample and at most eight times its ring's. `frame` and `seed` must be those used for tracing.
    ///
    /// # Errors
    /// If the guide's size differs from the frame's.
    pub fn guided(&self, guide: &Guide, frame: u64, seed: u64) -> Result<Self, SettingsError> {
        for (setting, size) in [("guide.known", guide.known.size()), ("guide.deviation", guide.deviation.size())] {
            if size != self.size_px {
                return Err(SettingsError {
                    setting,
                    found: format!("{} x {} pixels", size[0], size[1]),
                    expected: format!("the frame's {} x {}", self.size_px[0], self.size_px[1]),
                });
            }
        }
        let key = path_key(seed, frame);
        let work = self.parts().into_iter().zip(0..).map(|(part, ring)| {
            let known: Vec<PointHistory> = part.targets.par_iter().map(|&p| history(guide, &part.lattice, p)).collect();
            let rounded = |([x, y], share): (&[u32; 2], f64)| {
                (share + f64::from(path_draws(x | y << 16, ROUNDING_SAMPLE, ring, key)[0])).floor() as u32
            };
            let counts: Vec<u32> = part.targets.par_iter().zip(shares(&known, part.samples)).map(rounded).collect();
            spans(&part, &counts)
        });
        Ok(Self { guided: Some(work.collect()), ..self.clone() })
    }
}

/// Samples held at a point, and their standard deviation if known.
#[derive(Clone, Copy, Debug, PartialEq)]
struct PointHistory {
    samples: f64,
    deviation: Option<f64>,
}

/// Mean number of samples for each point, with a total of `samples` per point.
fn shares(points: &[PointHistory], samples: u32) -> Vec<f64> {
    let (least, most) = (f64::from(samples.min(MIN_SAMPLES)), f64::from(samples) * f64::from(MAX_FACTOR));
    let deviations = || points.iter().filter_map(|p| p.deviation);
    let mean = match deviations().count() {
        0 => 1.0,
        count => deviations().sum::<f64>() / count as f64,
    };
    let known: Vec<[f64; 2]> = points.iter().map(|p| [p.deviation.unwrap_or(mean), p.samples]).collect();
    let share = |[deviation, samples]: [f64; 2], t: f64| (deviation * t - samples).clamp(least, most);
    // Sum of all shares, and its derivative. Summed in chunks of fixed size, so that it does not depend on the number
    // of threads.
    let sum = |t: f64| {
        let of = |part: &[[f64; 2]]| {
            part.iter().fold([0.0; 2], |[sum, slope], &p| {
                let share = share(p, t);
                [sum + share, if share > least && share < most { slope + p[0] } else { slope }]
            })
        };
        let parts: Vec<[f64; 2]> = known.par_chunks(1 << 14).map(of).collect();
        parts.iter().fold([0.0; 2], |a, b| [a[0] + b[0], a[1] + b[1]])
    };
    let budget = points.len() as f64 * f64::from(samples);
    // Bounds that contain every quotient of two f32 values.
    let (mut low, mut high) = ((-300.0_f64).exp2(), 300.0_f64.exp2());
    let mut t = high;
    if sum(high)[0] > budget {
        // Start at the solution without bounds on n.
        let finite = || known.iter().filter(|p| p[1].is_finite());
        let sums = finite().fold([budget, 0.0], |[samples, deviation], p| [samples + p[1], deviation + p[0]]);
        t = (sums[0] / sums[1]).clamp(low, high);
        let mut last = f64::INFINITY;
        for _ in 0..100 {
            let [sum, slope] = sum(t);
            let off = (sum - budget).abs();
            if off <= 1e-9 * budget {
                break;
            }
            *(if sum > budget { &mut high } else { &mut low }) = t;
            // The sum is piecewise linear, and Newton's step is exact within a piece. Where it gains little, bisect (in
            // the logarithm).
            let newton = t + (budget - sum) / slope;
            t = if off < 0.5 * last && newton > low && newton < high { newton } else { (low * high).sqrt() };
            last = off;
        }
    }
    known.iter().map(|&p| share(p, t)).collect()
}

/// Spans with `counts` samples of each target. A count is a sum of powers of two: samples 2^b to 2^(b+1) - 1 are traced
/// for the targets whose count has bit b set. So a few spans cover any counts.
fn spans(part: &Part, counts: &[u32]) -> Vec<Spans> {
    let bits = u32::BITS - counts.iter().max().map_or(u32::BITS, |most| most.leading_zeros());
    let of_bit = |bit: u32| {
        let chosen = part.targets.iter().zip(counts).filter(|(_, n)| **n >> bit & 1 != 0);
        Spans::new(chosen.map(|(target, _)| *target), 1 << bit..2 << bit)
    };
    (0..bits).into_par_iter().map(of_bit).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use afterimage::kernel::rng::{pcg4d, unit_draw};

    /// Counts from 0 to 40, deviations from 1e-4 to 1, and some unknown deviations.
    fn points(count: u32, seed: u32) -> Vec<PointHistory> {
        let draws = |i| pcg4d([i, seed, 0, 0]).map(|bits| f64::from(unit_draw(bits)));
        (0..count)
            .map(|i| {
                let [samples, deviation, unknown, _] = draws(i);
                PointHistory { samples: 40.0 * samples, deviation: (unknown > 0.1).then(|| 1e-4_f64.powf(deviation)) }
            })
            .collect()
    }

    #[test]
    fn no_sample_would_do_more_elsewhere() {
        for (seed, samples) in [(1, 2), (2, 4), (3, 16), (4, 100)] {
            let points = points(5000, seed);
            let known: Vec<f64> = points.iter().filter_map(|p| p.deviation).collect();
            let mean = known.iter().sum::<f64>() / known.len() as f64;
            let shares = shares(&points, samples);
            let spent = shares.iter().sum::<f64>();
            assert!((spent / (5000.0 * f64::from(samples)) - 1.0).abs() < 1e-7, "{spent} spent");
            // Karush-Kuhn-Tucker conditions: the variance reduction of one more sample is equal at all points between
            // the bounds, smaller at those with the least samples, larger at those with the most.
            let gain = |(p, share): (&PointHistory, &f64)| (p.deviation.unwrap_or(mean) / (p.samples + share)).powi(2);
            let (mut least, mut between, mut most) = (0.0_f64, [f64::INFINITY, 0.0_f64], f64::INFINITY);
            for (p, share) in points.iter().zip(&shares) {
                let gain = gain((p, share));
                match *share {
                    1.0 => least = least.max(gain),
                    n if n == 8.0 * f64::from(samples) => most = most.min(gain),
                    _ => between = [between[0].min(gain), between[1].max(gain)],
                }
            }
            assert!(between[1] < between[0] * (1.0 + 1e-5), "{between:?}");
            assert!(least <= between[1] && most >= between[0], "{least} {between:?} {most}");
        }
    }

    #[test]
    fn extremes_of_a_float_stay_within_the_bounds() {
        let known = |samples: f32, deviation: f32| PointHistory {
            samples: f64::from(samples),
            deviation: Some(f64::from(deviation)),
        };
        let tiny = f32::from_bits(1);
        let points = [known(f32::MAX, tiny), known(0.0, f32::MAX), known(f32::INFINITY, f32::MAX), known(0.0, 0.0)];
        let all = shares(&points, 3);
        assert!(all[1] > 8.999_999 && all[1] <= 9.0, "{all:?}");
        assert_eq!([all[0], all[2], all[3]], [1.0; 3]);
        assert_eq!(shares(&points, 0), [0.0; 4]);
        assert!(shares(&[], 5).is_empty());
    }

    #[test]
    fn samples_of_a_number_are_its_bits() {
        let targets = vec![[3, 1], [4, 1], [9, 1], [0, 2]];
        let part = Part { lattice: Lattice::blocks(1, [16, 16]), targets, samples: 4 };
        let spans = spans(&part, &[5, 1, 0, 12]);
        let ranges: Vec<_> = spans.iter().map(|s| (s.samples(), s.pixels())).collect();
        assert_eq!(ranges, [(1..2, 2), (2..4, 0), (4..8, 2), (8..16, 1)]);
        assert_eq!(spans.iter().map(Spans::len).sum::<u64>(), 5 + 1 + 12);
    }
}
