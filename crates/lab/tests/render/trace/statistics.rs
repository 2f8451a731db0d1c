//! Statistical tests of whether two films show the same image.

use afterimage_lab::trace::film::{Film, Moments};
use afterimage_testing::p_of_z;
use statrs::distribution::{ContinuousCDF, StudentsT};

/// Relative rounding error of means in f32: allowed difference of films without noise.
const ROUNDING: f64 = 2e-6;

fn mean(m: &Moments, channel: usize) -> f64 {
    f64::from(m.mean[channel])
}

fn variance(m: &Moments, channel: usize) -> f64 {
    f64::from(m.variance_of_mean()[channel])
}

/// Smallest p-value over pixels and channels (Welch's t-test, as variances are estimated), corrected for the number of
/// tests.
pub fn p_of_pixels(a: &Film, b: &Film) -> f64 {
    let pairs = a.moments.pixels().iter().zip(b.moments.pixels());
    let mut lowest: f64 = 1.0;
    for (a, b) in pairs {
        for k in 0..3 {
            let [va, vb] = [variance(a, k), variance(b, k)];
            let rounding = ROUNDING * mean(a, k).abs();
            let se = (va + vb).sqrt().max(rounding);
            let off = (mean(a, k) - mean(b, k)).abs();
            if off == 0.0 {
                continue;
            }
            let squares = va * va / f64::from(a.count - 1) + vb * vb / f64::from(b.count - 1);
            let freedom = if squares > 0.0 { (va + vb).powi(2) / squares } else { 1e6 };
            let t = StudentsT::new(0.0, 1.0, freedom.max(1.0)).unwrap();
            lowest = lowest.min(2.0 * t.sf(off / se));
        }
    }
    (lowest * 3.0 * a.moments.pixels().len() as f64).min(1.0)
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
