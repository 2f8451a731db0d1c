//! Noise of candidates: a path-traced pixel is the mean of a few random samples. How many they are decides how much history counts,
//! and how much they scatter decides which difference from history is no change.
//!
//! History is weighted by numbers of samples alone. Weights that followed the samples' own scatter would favour pixels that
//! happened to miss a lamp, whose samples are dark and alike, and the mean would come out too dark.

use super::matched::{COARSER_WIDTH, DARK, smooth_step};
use super::pack::{half_bits, half_value};
use super::sanitize::MAX_HALF;
use glam::{Vec3, Vec4};

/// Levels of detail beyond the candidate's own at which noisy candidates are compared: means of 8x8 samples have an eighth of the
/// noise.
pub const NOISY_LEVELS: f32 = 3.0;
/// Samples in such a mean.
const COMPARED: f32 = 64.0;
/// Standard deviations of noise that are no change.
const SIGMAS: f32 = 3.0;
/// Noise up to which confidence in a color is 1, and over how much more it falls to 0, as differences: below what the
/// eye just sees.
const SURE: [f32; 2] = [0.5, 1.0];
/// Frames that a coarser history counts for at the most.
const COARSER_FRAMES: f32 = 4.0;
/// Largest standard error that is told apart, linear: its square is still a half.
const MAX_ERROR: f32 = 255.0;
/// Largest number of samples, a half that is still exact to a thousandth.
const MAX_SAMPLES: f32 = 32768.0;
/// Alpha of a texel of which nothing is known.
const UNKNOWN: f32 = -1.0;

/// Samples and variance of a color.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Noise {
    /// Samples it is a mean of, at least 1 (0 for a history that holds none).
    pub samples: f32,
    /// Variance of one sample's luma, linear.
    pub variance: f32,
}

/// A candidate's noise as told: the standard error of its luma, linear, and the number of samples. What is NaN or below 0 counts as an
/// error of 0, and as one sample.
#[inline]
pub fn candidate_noise(told: [f32; 2]) -> Noise {
    let error = positive(told[0]).min(MAX_ERROR);
    let samples = positive(told[1]).clamp(1.0, MAX_SAMPLES);
    Noise { samples, variance: ((error * error) * samples).min(MAX_HALF) }
}

/// `x` if it is above 0, infinity included, else 0; by bits, because shading languages may assume that NaN does not exist.
#[inline]
fn positive(x: f32) -> f32 {
    if x.to_bits() <= 0x7f80_0000 { x } else { 0.0 }
}

/// One word.
#[inline]
pub fn pack_noise(n: Noise) -> u32 {
    half_bits(n.samples) | half_bits(n.variance) << 16
}

/// What a word holds. Whatever it holds, the result is finite and not negative.
#[inline]
pub fn unpack_noise(word: u32) -> Noise {
    Noise { samples: half_value(word & 0x7fff), variance: half_value((word >> 16) & 0x7fff) }
}

/// Texel of level 0 of the candidates' chain: color, and variance of the pixel's luma; alpha below 0 where the candidate must not be
/// used.
#[inline]
pub fn candidate_texel(color: Vec3, usable: bool, n: Noise) -> Vec4 {
    if usable { color.extend(n.variance / n.samples) } else { Vec3::ZERO.extend(UNKNOWN) }
}

/// Mean of those of four texels of the candidates' chain of which something is known.
#[inline]
pub fn candidate_mean(a: Vec4, b: Vec4, c: Vec4, d: Vec4) -> Vec4 {
    let known = |t: Vec4| if t.w >= 0.0 { 1.0 } else { 0.0 };
    let (wa, wb, wc, wd) = (known(a), known(b), known(c), known(d));
    let weight = ((wa + wb) + wc) + wd;
    if weight == 0.0 {
        return Vec3::ZERO.extend(UNKNOWN);
    }
    (((a * wa + b * wb) + c * wc) + d * wd) * (1.0 / weight)
}

/// Color and variance between four texels of the candidates' chain, rows first; of those of which something is known.
#[inline]
pub fn candidate_bilinear(top: [Vec4; 2], bottom: [Vec4; 2], fraction: [f32; 2]) -> Vec4 {
    let [fx, fy] = fraction;
    let known = |t: Vec4, w: f32| if t.w >= 0.0 { w } else { 0.0 };
    let wa = known(top[0], (1.0 - fx) * (1.0 - fy));
    let wb = known(top[1], fx * (1.0 - fy));
    let wc = known(bottom[0], (1.0 - fx) * fy);
    let wd = known(bottom[1], fx * fy);
    let sum = ((top[0] * wa + top[1] * wb) + bottom[0] * wc) + bottom[1] * wd;
    sum * (1.0 / (((wa + wb) + wc) + wd).max(1e-3))
}

/// Share of a history of as coarse samples in the mean of both: as many as it holds, at most `most`.
#[inline]
pub fn history_share(history: Noise, candidate: Noise, most: f32) -> f32 {
    (history.samples / (history.samples + candidate.samples)).min(most)
}

/// Variance of one sample's luma as history and candidate know it together; the candidate's from around it.
#[inline]
pub fn pooled_variance(history: Noise, candidate: Noise) -> f32 {
    let all = history.samples + candidate.samples;
    (history.samples * history.variance + candidate.samples * candidate.variance) / all
}

/// How many of [`root_difference`](super::matched::root_difference)'s units a linear unit is around a luma: the derivative of 100 times its
/// square root, kept finite.
#[inline]
pub fn root_slope(luma: f32) -> f32 {
    50.0 / (luma.max(0.0) + DARK).sqrt()
}

/// Difference of a compared mean of candidates and one of history that noise alone makes, in
/// [`root_difference`](super::matched::root_difference)'s units around a luma: three standard deviations.
#[inline]
pub fn noise_difference(history: Noise, candidate: Noise, luma: f32) -> f32 {
    let of_one = pooled_variance(history, candidate);
    let numbers = 1.0 / candidate.samples + 1.0 / history.samples.max(1.0);
    (SIGMAS * root_slope(luma)) * (of_one * numbers * (1.0 / COMPARED)).sqrt()
}

/// How far what history holds around a luma is free of noise, in \[0, 1\]: only then is a finer sample the better one.
#[inline]
pub fn noise_confidence(history: Noise, luma: f32) -> f32 {
    let off = root_slope(luma) * (history.variance / history.samples.max(1.0)).sqrt();
    1.0 - smooth_step(SURE[0], SURE[1], off)
}

/// What a history is worth whose samples are coarser by `levels` of detail: it is blurred, so soon outweighed.
#[inline]
pub fn coarser_worth(history: Noise, candidate: Noise, levels: f32) -> Noise {
    let limited = history.samples.min(COARSER_FRAMES * candidate.samples);
    let t = (levels / COARSER_WIDTH).clamp(0.0, 1.0);
    Noise { samples: history.samples + (limited - history.samples) * t, variance: history.variance }
}

/// Difference of a single candidate and a sample as noisy that noise alone makes.
#[inline]
pub fn sample_difference(candidate: Noise, luma: f32) -> f32 {
    (SIGMAS * root_slope(luma)) * (candidate.variance * (2.0 / candidate.samples)).sqrt()
}

/// What is known of the shown color: `share` is the history's in it, `finer` how far it was shown as the better sample, in which
/// case the candidate added nothing.
#[inline]
pub fn noise_after(history: Noise, candidate: Noise, share: f32, finer: f32) -> Noise {
    // A mean with weights 1 - share and share of n and N samples has the weight of n / (1 - share) samples.
    let together = candidate.samples / (1.0 - share).max(1.0 / MAX_SAMPLES);
    let samples = (together + (history.samples - together) * finer).clamp(1.0, MAX_SAMPLES);
    let variance = candidate.variance + (history.variance - candidate.variance) * share;
    Noise { samples, variance: variance.clamp(0.0, MAX_HALF) }
}

/// A stored noise under this frame's exposure.
#[inline]
pub fn expose_noise(stored: Noise, ratio: f32) -> Noise {
    Noise { samples: stored.samples, variance: (stored.variance * ratio * ratio).min(MAX_HALF) }
}
