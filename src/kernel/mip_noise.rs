//! Noise of whole frames: the mip chain of noisy candidates, and what noise alone explains of their differences from
//! history.

use super::lod::COARSER_WIDTH;
use super::noise::{Noise, pooled_variance, root_slope};
use glam::{Vec3, Vec4};

/// Levels of detail beyond the candidate's own at which noisy candidates are compared: means of 8x8 samples have an
/// eighth of the noise.
pub const NOISY_LEVELS: f32 = 3.0;
/// Number of candidates in the mean of 8x8 that is compared.
const COMPARED_CANDIDATES: f32 = 64.0;
/// Standard deviations up to which a difference is attributed to noise.
const SIGMAS: f32 = 3.0;
/// Limit on the samples of a coarser history, in frames.
const COARSER_FRAMES: f32 = 4.0;
/// Alpha of a texel without usable candidates.
const UNKNOWN: f32 = -1.0;

/// Texel of level 0 of the candidates' mip chain: color, and variance of the pixel's luma. A negative alpha marks an
/// unusable candidate.
#[inline]
pub fn candidate_texel(color: Vec3, usable: bool, n: Noise) -> Vec4 {
    if usable { color.extend(n.variance / n.samples) } else { Vec3::ZERO.extend(UNKNOWN) }
}

/// Mean of four texels of the candidates' mip chain, without unusable ones.
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

/// Bilinear interpolation of color and variance of four texels of the candidates' mip chain, without unusable ones.
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

/// Largest difference of the compared means of candidates and of history that noise alone explains: three standard
/// deviations at a luma, in units of [`root_difference`](super::color::root_difference). `luma` is in units of
/// [`brightness_unit`](super::smr::brightness_unit), whose inverse is `inverse_unit`.
#[inline]
pub fn noise_difference(history: Noise, candidate: Noise, luma: f32, inverse_unit: f32) -> f32 {
    let sample_variance = pooled_variance(history, candidate);
    let inverse_samples = 1.0 / candidate.samples + 1.0 / history.samples.max(1.0);
    let deviations = ((sample_variance * (SIGMAS * SIGMAS / COMPARED_CANDIDATES)) * inverse_samples).sqrt();
    root_slope(luma) * (deviations * inverse_unit)
}

/// Noise of a history that is coarser than the candidate by `levels` of detail, with its number of samples limited to a
/// few frames: such history is blurred, and new samples should soon outweigh it.
#[inline]
pub fn discount_coarser(history: Noise, candidate: Noise, levels: f32) -> Noise {
    let limited = history.samples.min(COARSER_FRAMES * candidate.samples);
    let t = (levels / COARSER_WIDTH).clamp(0.0, 1.0);
    Noise { samples: history.samples + (limited - history.samples) * t, variance: history.variance }
}

/// Largest difference of a candidate and a sample of equal noise that noise alone explains: three standard deviations
/// at a luma, in units of [`root_difference`](super::color::root_difference).
#[inline]
pub fn sample_difference(candidate: Noise, luma: f32) -> f32 {
    root_slope(luma) * (candidate.variance * ((2.0 * SIGMAS * SIGMAS) / candidate.samples)).sqrt()
}
