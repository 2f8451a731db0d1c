//! Statistical tests of whether two films show the same image.

use afterimage_testing::p_of_z;
use afterimage_trace::film::{Film, Moments};

/// Relative rounding error of means in f32: allowed difference of films without noise.
const ROUNDING: f64 = 2e-6;

fn mean(m: &Moments, channel: usize) -> f64 {
    f64::from(m.mean[channel])
}

fn variance(m: &Moments, channel: usize) -> f64 {
    f64::from(m.variance_of_mean()[channel])
}

/// p-value for the difference of sums over the pixels selected by `is_in`, channels together.
pub fn p_of_means(a: &Film, b: &Film, is_in: impl Fn(usize) -> bool) -> f64 {
    let (mut off, mut var, mut size) = (0.0, 0.0, 0.0);
    let pairs = a.moments.pixels().iter().zip(b.moments.pixels()).enumerate();
    for (a, b) in pairs.filter(|(i, _)| is_in(*i)).map(|(_, pair)| pair) {
        let at = |m: &Moments| (0..3).map(|k| mean(m, k)).sum::<f64>();
        // Channels of a path are correlated, so their errors add up.
        let sd = |m: &Moments| (0..3).map(|k| variance(m, k).sqrt()).sum::<f64>();
        off += at(a) - at(b);
        var += sd(a).powi(2) + sd(b).powi(2);
        size += at(a).abs();
    }
    if off == 0.0 { 1.0 } else { p_of_z(off / var.sqrt().max(ROUNDING * size)) }
}

/// Smallest p-value over the means of 4x4 regions, corrected for the number of tests.
pub fn p_of_regions(a: &Film, b: &Film) -> f64 {
    let [w, h] = a.moments.size().map(|n| n as usize);
    let region = |i: usize| (i % w * 4 / w, i / w * 4 / h);
    let all = (0..16).map(|r| p_of_means(a, b, |i| region(i) == (r % 4, r / 4)));
    (all.fold(1.0, f64::min) * 16.0).min(1.0)
}

/// Mean of a film in one channel and its standard error, over the pixels selected by `is_in`.
pub fn mean_of(film: &Film, channel: usize, is_in: impl Fn(usize) -> bool) -> (f64, f64) {
    let (mut sum, mut var, mut count) = (0.0, 0.0, 0.0);
    for (_, m) in film.moments.pixels().iter().enumerate().filter(|(i, _)| is_in(*i)) {
        sum += mean(m, channel);
        var += variance(m, channel);
        count += 1.0;
    }
    (sum / count, var.sqrt() / count)
}
