//! Lattices of samples: the order in which a block's pixels are sampled, and the samples around a pixel.
//! `docs/method.md` explains sparse frames.

use super::depth::{distance_of, same_surface};
use super::sanitize::is_finite;
use glam::{Vec2, Vec3, Vec4};

/// Smallest weight of a sample at a pixel that has one: the coarsest lattice has 256 steps along each axis.
const LEAST_WEIGHT: f32 = 1.0 / 65536.0;

/// Position of the sample in a block of `step` x `step` pixels (a power of two) in frame `index`: each pixel once in
/// `step * step` frames, in the order of Bayer's matrix, so that every prefix is spread evenly (Bayer 1973).
#[inline]
pub fn offset_px(index: u64, step: u32) -> [u32; 2] {
    let mut rest = index;
    let mut half = step / 2;
    let mut offset = [0, 0];
    while half > 0 {
        // Corners of a square in the order of diagonals: (0, 0), (1, 1), (1, 0), (0, 1).
        let corner = (rest & 3) as u32;
        offset[0] += half * ((corner & 1) ^ (corner >> 1));
        offset[1] += half * (corner & 1);
        rest >>= 2;
        half /= 2;
    }
    offset
}

/// Jitter of the projection in frame `index`, in pixels, each in \[-0.5, 0.5): Halton's sequence of bases 3 and 5. A
/// pixel of a lattice is sampled every `step * step` frames, a power of two. The sequence has low discrepancy over
/// these frames, too, because its bases are odd. The common base 2 would place all of these samples in the same half of
/// the pixel.
pub fn jitter_px(index: u64) -> [f32; 2] {
    [3, 5].map(|base| {
        let (mut rest, mut digit, mut value) = (index, 1.0, 0.0);
        while rest > 0 {
            digit /= base as f64;
            value += (rest % base) as f64 * digit;
            rest /= base;
        }
        (value - 0.5) as f32
    })
}

/// The two samples around a pixel along one axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Between {
    /// Numbers of the samples; equal at the lattice's ends.
    pub points: [u32; 2],
    /// Distance from the first sample, in steps: in \[0, 1).
    pub fraction: f32,
}

/// Samples around pixel `px`, out of `count` samples at `first + i * 2^level`; `count` is at least 1.
#[inline]
pub fn between(px: u32, first: u32, level: u32, count: u32) -> Between {
    let last = count as i32 - 1;
    // The shift of a signed number rounds down.
    let offset = px as i32 - first as i32;
    let low = offset >> level;
    let fraction = (offset - (low << level)) as f32 * f32::from_bits((127 - level) << 23);
    Between { points: [low.clamp(0, last) as u32, (low + 1).clamp(0, last) as u32], fraction }
}

/// Number of the sample nearest to pixel `px` along an axis, of samples at `first + i * 2^level`; it may lie outside.
#[inline]
pub fn nearest_point(px: u32, first: u32, level: u32) -> i32 {
    // The shift of a signed number rounds down.
    (px as i32 - first as i32 + ((1 << level) >> 1)) >> level
}

/// Distance in pixels from pixel `px` to sample `point` along an axis.
#[inline]
pub fn point_offset_px(px: u32, first: u32, level: u32, point: i32) -> f32 {
    ((point << level) - (px as i32 - first as i32)) as f32
}

/// Largest exponent of [`place_weight`], so that products with weights of the eccentricity stay normal.
const LEAST_PLACE_EXPONENT: u32 = 40;

/// Weight of a pixel's candidate by the offset of its nearest sample in whole pixels: 1 at the sample's own pixel,
/// 2^-12 beside it, and about `(1 + 8 d^2)^-4` at `d` pixels. A reservoir then keeps the sample that fell on its own
/// pixel. Weights are powers of two, so that products are exact in any order.
#[inline]
pub fn place_weight(offset_px: Vec2) -> f32 {
    let inverse = 1.0 + 8.0 * (offset_px.x * offset_px.x + offset_px.y * offset_px.y);
    let exponent = 4 * ((inverse.to_bits() >> 23) - 127);
    f32::from_bits((127 - exponent.min(LEAST_PLACE_EXPONENT)) << 23)
}

/// Weight along one axis of the first (`point` 0) or the second sample around a pixel.
#[inline]
pub fn point_weight(fraction: f32, point: u32) -> f32 {
    if point == 0 { 1.0 - fraction } else { fraction }
}

/// Running sums of a mean of samples. Weights are multiples of 1/65536, so that their sums are exact.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SampleMean {
    /// Sum of weighted colors and alphas.
    pub sum: Vec4,
    /// Sum of the weights; 0 without usable samples.
    pub weight: f32,
}

/// The mean after one more sample. An unusable sample does not change it.
#[inline]
pub fn add_sample(mean: SampleMean, color: Vec4, usable: bool, weight: f32) -> SampleMean {
    if !usable {
        return mean;
    }
    SampleMean { sum: mean.sum + color * weight, weight: mean.weight + weight }
}

/// The mean color of the samples added; 0 without any.
#[inline]
pub fn sample_mean(mean: SampleMean) -> Vec4 {
    mean.sum * (1.0 / mean.weight.max(LEAST_WEIGHT))
}

/// Relative difference of disparity within which neighbouring samples belong to one surface: large, because the
/// disparity of a floor changes much from sample to sample.
const GEOMETRY_RELATIVE: f32 = 0.35;

/// Running sums of a mean of depth and motion at the samples of a surface.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GeometryMean {
    /// Sum of weighted disparities.
    pub disparity: f32,
    /// Sum of weighted motion vectors.
    pub motion: Vec2,
    /// Sum of the weights; 0 without samples.
    pub weight: f32,
}

/// The mean after one more sample. A sample of another surface than that of disparity `own` does not change it.
#[inline]
pub fn add_geometry(mean: GeometryMean, own: f32, disparity: f32, motion: Vec2, weight: f32) -> GeometryMean {
    let usable = is_finite(motion.x) && is_finite(motion.y);
    if weight == 0.0 || !usable || !same_surface(own, disparity, GEOMETRY_RELATIVE, 0.0) {
        return mean;
    }
    GeometryMean {
        disparity: mean.disparity + disparity * weight,
        motion: mean.motion + motion * weight,
        weight: mean.weight + weight,
    }
}

/// Distance and motion vector of a pixel: the mean, or those of its `own` sample if the mean is empty.
#[inline]
pub fn filled_geometry(mean: GeometryMean, own: f32, own_motion: Vec2) -> Vec3 {
    if mean.weight == 0.0 {
        return Vec3::new(distance_of(own), own_motion.x, own_motion.y);
    }
    let inverse = 1.0 / mean.weight;
    Vec3::new(distance_of(mean.disparity * inverse), mean.motion.x * inverse, mean.motion.y * inverse)
}
