//! Noise of candidates. A path-traced pixel is the mean of a few random samples: their number sets the weight of
//! history, their variance the difference from history that noise explains.
//!
//! History is weighted by numbers of samples alone. Weighting by the samples' own variance would favour pixels whose
//! samples all missed a lamp (dark, and of low variance), and the mean would be biased towards black.

use super::approx::smooth_step;
use super::color::DARK;
use super::pack::{half_bits, half_value};
use super::sanitize::MAX_HALF;

/// Noise confidence: standard error up to which it is 1, and width over which it falls to 0, in units of
/// `root_difference`. Both are below the just noticeable difference.
const CONFIDENCE_FALLOFF: [f32; 2] = [0.5, 1.0];
/// Number of samples of history with which a pixel's own noisy sample and the mean around it count alike.
const BORROWED_SAMPLES: f32 = 16.0;
/// Largest standard error, linear; larger ones are clamped to it. Its square fits into a half.
const MAX_ERROR: f32 = 255.0;
/// Largest number of samples; larger ones are clamped to it. A half stores it to a thousandth.
const MAX_SAMPLES: f32 = 32768.0;
/// Keeps quotients of sums finite.
const LEAST_SPREAD: f32 = 1e-30;

/// Noise of a color: number of samples, and variance of one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Noise {
    /// Samples that the color is a mean of, at least 1; 0 for empty history.
    pub samples: f32,
    /// Variance of one sample's luma, linear.
    pub variance: f32,
}

/// Noise of a candidate from the frame's input: standard error of its luma, linear, and number of samples. NaN or
/// negative numbers count as an error of 0, and as one sample.
#[inline]
pub fn candidate_noise(input: [f32; 2]) -> Noise {
    let error = positive(input[0]).min(MAX_ERROR);
    let samples = positive(input[1]).clamp(1.0, MAX_SAMPLES);
    Noise { samples, variance: ((error * error) * samples).min(MAX_HALF) }
}

/// `x` if it is positive, infinity included, else 0. The test is on the bits, because shading languages may assume that
/// NaN does not exist.
#[inline]
fn positive(x: f32) -> f32 {
    if x.to_bits() <= 0x7f80_0000 { x } else { 0.0 }
}

/// Packs a noise into one word of two halves: samples low, variance high.
#[inline]
pub fn pack_noise(n: Noise) -> u32 {
    half_bits(n.samples) | half_bits(n.variance) << 16
}

/// Unpacks a noise. The result is finite and not negative for any word.
#[inline]
pub fn unpack_noise(word: u32) -> Noise {
    Noise { samples: half_value(word & 0x7fff), variance: half_value((word >> 16) & 0x7fff) }
}

/// Share of an equally coarse history in the mean of history and candidate, by numbers of samples; at most `most`.
#[inline]
pub fn history_share(history: Noise, candidate: Noise, most: f32) -> f32 {
    (history.samples / (history.samples + candidate.samples)).min(most)
}

/// Pooled variance of one sample's luma, from history and from the candidate's neighbourhood.
#[inline]
pub fn pooled_variance(history: Noise, candidate: Noise) -> f32 {
    let all = history.samples + candidate.samples;
    (history.samples * history.variance + candidate.samples * candidate.variance) / all
}

/// Derivative of [`root_difference`](super::color::root_difference) by linear luma, at a luma: 50 over its square
/// root, limited for dark colors.
#[inline]
pub fn root_slope(luma: f32) -> f32 {
    50.0 / (luma.max(0.0) + DARK).sqrt()
}

/// Degree to which the noise of a color at a luma is visible, in \[0, 1\].
#[inline]
pub fn noise_visibility(history: Noise, luma: f32) -> f32 {
    let error = root_slope(luma) * (history.variance / history.samples.max(1.0)).sqrt();
    smooth_step(CONFIDENCE_FALLOFF[0], CONFIDENCE_FALLOFF[1], error)
}

/// Noise confidence of a color at a luma, in \[0, 1\]: 1 where its standard error is invisible. Only then does a finer
/// sample replace a coarser one.
#[inline]
pub fn noise_confidence(history: Noise, luma: f32) -> f32 {
    1.0 - noise_visibility(history, luma)
}

/// Expected difference, due to noise, of a sample and of history at its pixel: the standard deviation at a luma, in
/// units of [`root_difference`](super::color::root_difference).
#[inline]
pub fn expected_noise(history: Noise, candidate: Noise, luma: f32) -> f32 {
    let inverse_samples = 1.0 / candidate.samples + 1.0 / history.samples.max(1.0);
    root_slope(luma) * (pooled_variance(history, candidate) * inverse_samples).sqrt()
}

/// Reduction of the squared error, due to noise, of history at a luma that one more sample is expected to bring: of its
/// variance over n samples, less that over n + 1; in squared units of
/// [`root_difference`](super::color::root_difference).
#[inline]
pub fn noise_need(history: Noise, luma: f32) -> f32 {
    let samples = history.samples.max(1.0);
    let slope = root_slope(luma);
    (slope * slope) * (history.variance / (samples * (samples + 1.0)))
}

/// Weight of a sample of `samples` paths at a squared distance in pixels, in a mean of samples around a pixel: its
/// number of paths, less with distance.
#[inline]
pub fn noisy_share(samples: f32, px2: f32) -> f32 {
    samples / px2.max(1.0).sqrt()
}

/// Share that the mean of the samples around a pixel has in its own noisy sample, if its history is a mean of `past`
/// samples. Without history nearly all: error by blur is less than error by noise then. None where the noise is not
/// visible. `own`: as many samples as the pixel's own, with the variance around it; `luma`: of the mean. A share by the
/// pixel's own variance would favour pixels whose samples all missed a lamp.
#[inline]
pub fn borrowed(past: f32, own: Noise, luma: f32) -> f32 {
    (BORROWED_SAMPLES / (BORROWED_SAMPLES + past)) * noise_visibility(own, luma)
}

/// Running sums for the noise of a weighted mean of samples.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct NoiseSum {
    /// Weights.
    pub weight: f32,
    /// Squared weights over numbers of samples.
    pub spread: f32,
    /// Variances times weights.
    pub variance: f32,
}

/// The sums after one more color.
#[inline]
pub fn add_noise(sum: NoiseSum, n: Noise, weight: f32) -> NoiseSum {
    NoiseSum {
        weight: sum.weight + weight,
        spread: sum.spread + (weight * weight) / n.samples,
        variance: sum.variance + n.variance * weight,
    }
}

/// Noise of the mean. Its number of samples, at least one, follows from its variance.
#[inline]
pub fn mean_noise(sum: NoiseSum) -> Noise {
    let samples = (sum.weight * sum.weight) / sum.spread.max(LEAST_SPREAD);
    Noise { samples: samples.clamp(1.0, MAX_SAMPLES), variance: sum.variance * (1.0 / sum.weight.max(LEAST_SPREAD)) }
}

/// Noise of the output color. `share`: history's share in it; `finer`: degree to which history replaced the candidate
/// as the finer sample, in which case the candidate's samples do not count.
#[inline]
pub fn noise_after(history: Noise, candidate: Noise, share: f32, finer: f32) -> Noise {
    // A mean with weights 1 - share and share of n and N samples has the weight of n / (1 - share) samples.
    let together = candidate.samples / (1.0 - share).max(1.0 / MAX_SAMPLES);
    let samples = (together + (history.samples - together) * finer).clamp(1.0, MAX_SAMPLES);
    let variance = candidate.variance + (history.variance - candidate.variance) * share;
    Noise { samples, variance: variance.clamp(0.0, MAX_HALF) }
}

/// Stored noise scaled to this frame's exposure; `ratio` is this frame's exposure divided by the previous frame's.
#[inline]
pub fn expose_noise(stored: Noise, ratio: f32) -> Noise {
    Noise { samples: stored.samples, variance: (stored.variance * ratio * ratio).min(MAX_HALF) }
}
