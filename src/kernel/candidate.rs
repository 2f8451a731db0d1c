//! Candidate of a pixel of a planned frame: the samples around it, weighted by their distance, and the
//! rectification of history at them.
//! As in checkerboard rendering, where a missing pixel is interpolated from those that were shaded around it; here they
//! lie at any distance.

use super::approx;
use super::color::luma;
use super::noise::{Noise, borrowed, noisy_share};
use super::pack::codes_between;
use super::reconstruction::Rectification;
use super::sanitize::MAX_HALF;
use glam::{Vec3, Vec4};
use std::f32::consts::LOG2_E;

/// Relative difference of disparity within which a sample is interpolated for a pixel.
const SAMPLE_RELATIVE: f32 = 0.05;
/// Weight of a sample of another surface. It is so small that such a sample counts only where no sample near the pixel
/// shows the pixel's own surface.
const OTHER_SURFACE: f32 = 1e-3;
/// Factor on the weight of a sample's gain and fit if they come from its neighbours only, because the sample itself was
/// not compared with history.
const BY_NEIGHBOURS: f32 = 1e-3;
/// Squared distance in pixels that stands for a missing sample.
const NO_PX2: f32 = 1e30;
/// Largest squared distance in pixels of a sample beside a pixel: the eight pixels around.
const BESIDE_PX2: f32 = 2.0;

/// [`codes_between`] of the samples that are interpolated for a pixel with the disparity `disparity`.
#[inline(always)]
pub fn sample_codes(disparity: f32) -> [u32; 2] {
    codes_between(disparity, 1.0 - SAMPLE_RELATIVE, 1.0 / (1.0 - SAMPLE_RELATIVE))
}

/// Weight of a sample at a squared distance in pixels from a pixel: 1 for the pixel's own.
#[inline(always)]
pub fn distance_weight(px2: f32) -> f32 {
    1.0 / px2.max(1.0)
}

/// Weight of a sample at a squared distance in pixels. `same`: whether it shows the pixel's surface.
#[inline(always)]
pub fn sample_weight(px2: f32, same: bool) -> f32 {
    distance_weight(px2) * if same { 1.0 } else { OTHER_SURFACE }
}

/// Level of detail of a candidate at distance `px` from the nearest sample of a pattern of level `coarsest`: 0 at the
/// sample's own pixel.
#[inline]
pub fn candidate_level(px: f32, coarsest: f32) -> f32 {
    (approx::ln_approx(1.0 + 2.0 * px) * LOG2_E).min(coarsest)
}

/// Sums over the samples around a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SampleSums {
    /// Colors, times weights.
    pub color: Vec3,
    /// Alphas, times weights.
    pub alpha: f32,
    /// Weights.
    pub weight: f32,
    /// Gains of history at the samples, times known weights.
    pub gain: Vec3,
    /// Fits of history at the samples, times known weights.
    pub fit: f32,
    /// Weights of gains and fits.
    pub known: f32,
    /// Smallest channels of the colors.
    pub lowest: Vec3,
    /// Largest channels.
    pub highest: Vec3,
    /// Color of the nearest sample of the pixel's surface, the first of equally near ones.
    pub beside: Vec3,
    /// Its squared distance in pixels.
    pub nearest_px2: f32,
}

/// Sums over no sample.
#[inline(always)]
pub fn no_samples() -> SampleSums {
    SampleSums {
        color: Vec3::ZERO,
        alpha: 0.0,
        weight: 0.0,
        gain: Vec3::ZERO,
        fit: 0.0,
        known: 0.0,
        lowest: Vec3::splat(MAX_HALF),
        highest: Vec3::ZERO,
        beside: Vec3::ZERO,
        nearest_px2: NO_PX2,
    }
}

/// Adds a sample at a squared distance in pixels, with its [`sample_weight`] and the rectification at it. `same`:
/// whether it shows the pixel's surface.
#[inline(always)]
pub fn add_sample(
    s: SampleSums,
    color: Vec3,
    alpha: f32,
    r: Rectification,
    weight: f32,
    px2: f32,
    same: bool,
) -> SampleSums {
    let known = weight * if r.is_own { 1.0 } else { BY_NEIGHBOURS };
    let is_nearer = same && px2 < s.nearest_px2;
    SampleSums {
        color: s.color + color * weight,
        alpha: s.alpha + alpha * weight,
        weight: s.weight + weight,
        gain: s.gain + r.gain * known,
        fit: s.fit + r.fit * known,
        known: s.known + known,
        lowest: s.lowest.min(color),
        highest: s.highest.max(color),
        beside: if is_nearer { color } else { s.beside },
        nearest_px2: if is_nearer { px2 } else { s.nearest_px2 },
    }
}

/// Whether a sample shows the pixel's surface.
#[inline(always)]
pub fn has_surface(s: SampleSums) -> bool {
    s.nearest_px2 < NO_PX2
}

/// Whether a sample of the pixel's surface is beside the pixel.
#[inline(always)]
pub fn is_beside(s: SampleSums) -> bool {
    s.nearest_px2 <= BESIDE_PX2
}

/// Mean of the samples around a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SampleMean {
    /// Linear color.
    pub color: Vec3,
    /// Alpha.
    pub alpha: f32,
    /// Level of detail of the mean, in log2 pixels.
    pub lod: f32,
    /// Factor on history's color.
    pub gain: Vec3,
    /// Fit of history after the gain: 0 to 1.
    pub fit: f32,
}

/// Mean of at least one sample, of a pattern of level `coarsest`.
#[inline(always)]
pub fn sample_mean(s: SampleSums, coarsest: f32) -> SampleMean {
    let inverse = 1.0 / s.weight;
    let known = 1.0 / s.known;
    let lod = if has_surface(s) { candidate_level(s.nearest_px2.sqrt(), coarsest) } else { coarsest + 1.0 };
    SampleMean { color: s.color * inverse, alpha: s.alpha * inverse, lod, gain: s.gain * known, fit: s.fit * known }
}

/// Sums over the noisy samples around a pixel, its own included.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct NoisySums {
    /// Colors and variances of one sample, times weights.
    pub sum: Vec4,
    /// Weights.
    pub weight: f32,
}

/// Adds a noisy sample at a squared distance in pixels.
#[inline(always)]
pub fn add_noisy(s: NoisySums, color: Vec3, noise: Noise, px2: f32) -> NoisySums {
    let weight = noisy_share(noise.samples, px2);
    NoisySums { sum: s.sum + color.extend(noise.variance) * weight, weight: s.weight + weight }
}

/// Mean color, and mean variance of one sample.
#[inline(always)]
pub fn noisy_mean(s: NoisySums) -> Vec4 {
    s.sum * (1.0 / s.weight)
}

/// A noisy sample with its share of the mean around it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Borrowed {
    /// Linear color.
    pub color: Vec3,
    /// Its noise.
    pub noise: Noise,
}

/// The noisy sample of a pixel whose history is a mean of `past` samples, with its share of the mean `around` it
/// ([`noisy_mean`]). Its variance takes its share, too: a pixel whose samples all missed a lamp would call its
/// neighbours' light a change.
#[inline(always)]
pub fn borrow_around(color: Vec3, noise: Noise, around: Vec4, past: f32) -> Borrowed {
    let mean = around.truncate();
    let share = borrowed(past, Noise { variance: around.w, ..noise }, luma(mean));
    let variance = noise.variance + (around.w - noise.variance) * share;
    Borrowed { color: color + (mean - color) * share, noise: Noise { variance, ..noise } }
}
