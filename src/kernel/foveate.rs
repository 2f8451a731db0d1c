//! Foveation: level of detail by eccentricity, and the arithmetic of the foveation filters (mip levels, Gaussian taps,
//! blocks).

use super::approx;
use glam::Vec3;
use std::f32::consts::LOG2_E;

/// Standard deviation in pixels below which nothing is blurred: the weight of the next pixel is e^-32, far below the
/// last bit of any color.
const SHARPEST_BLUR_PX: f32 = 0.125;
/// Mip bias of block samples: the sample of a block of level l reads level l - 2. Renderers filter textures for a finer
/// level than the shading rate (anisotropic filtering, mip bias), so that block samples alias. The block filter
/// reproduces this aliasing.
const SAMPLE_LEVEL_BIAS: u32 = 2;

/// Linear ramp: 0 up to `start`, 1 from `start + width` on. A width of 0 makes it a step.
#[inline]
pub fn ramp(x: f32, start: f32, width: f32) -> f32 {
    if x <= start {
        0.0
    } else if x >= start + width {
        1.0
    } else {
        (x - start) / width
    }
}

/// Level of detail (log2 of the block edge in pixels) at eccentricity `e_deg`: 0 inside the fovea, `lod_mid` to the
/// edge of the middle region, `lod_far` beyond, each step spread linearly over `blend_deg` outside its radius.
#[inline]
pub fn region_lod(
    e_deg: f32,
    fovea_radius_deg: f32,
    mid_radius_deg: f32,
    blend_deg: f32,
    lod_mid: f32,
    lod_far: f32,
) -> f32 {
    lod_mid * ramp(e_deg, fovea_radius_deg, blend_deg) + (lod_far - lod_mid) * ramp(e_deg, mid_radius_deg, blend_deg)
}

/// Level of detail of a blur at eccentricity `e_deg`. Its standard deviation is 0 up to `start_deg`, grows linearly to
/// that of `lod_mid` at `end_deg` and beyond, and is limited to that of `lod_far`. Blocks and blurs of one level look
/// equally coarse: `2^lod = 1 + 2 sigma`. Error below 1e-6.
#[inline]
pub fn blur_lod(e_deg: f32, start_deg: f32, end_deg: f32, lod_mid: f32, lod_far: f32) -> f32 {
    let slope = blur_sigma_px(lod_mid) / (end_deg - start_deg).max(1e-3);
    let sigma = (slope * (e_deg - start_deg)).clamp(0.0, blur_sigma_px(lod_far));
    approx::ln_approx(1.0 + 2.0 * sigma) * LOG2_E
}

/// Standard deviation in pixels of the blur of level of detail `lod` in \[0, 8\]. Exact for whole
/// levels, otherwise with an error below 5e-7 times 2^lod.
#[inline]
pub fn blur_sigma_px(lod: f32) -> f32 {
    0.5 * (approx::exp2_approx(lod) - 1.0)
}

/// Tap of a Gaussian whose centre has weight 1, with the state of the recurrence that gives the next tap.
#[derive(Clone, Copy, Debug)]
pub struct GaussTap {
    /// Weight of this tap.
    pub weight: f32,
    /// Weight of the next tap divided by this one's.
    pub ratio: f32,
    /// Next ratio divided by this one; constant.
    pub ratio_step: f32,
}

/// Centre tap of a Gaussian of standard deviation `sigma_px`.
///
/// Weights follow from forward differences of their logarithm: two products a tap instead of an exponential (Turkowski,
/// "Incremental Computation of the Gaussian", GPU Gems 3, 2007). Error of a weight below `1e-7 (1 + sigma_px^2)`: 6e-6
/// at 7.5 pixels.
#[inline]
pub fn gauss_center(sigma_px: f32) -> GaussTap {
    let s = sigma_px.max(SHARPEST_BLUR_PX);
    let ratio = approx::exp_approx(-0.5 / (s * s));
    GaussTap { weight: 1.0, ratio, ratio_step: ratio * ratio }
}

/// Tap one pixel further out.
#[inline]
pub fn gauss_next(tap: GaussTap) -> GaussTap {
    GaussTap { weight: tap.weight * tap.ratio, ratio: tap.ratio * tap.ratio_step, ratio_step: tap.ratio_step }
}

/// Number of taps on each side of a Gaussian's centre: it is cut at 3 standard deviations.
#[inline]
pub fn gauss_radius(sigma_px: f32) -> u32 {
    if sigma_px < SHARPEST_BLUR_PX { 0 } else { (3.0 * sigma_px) as u32 + 1 }
}

/// Texels a side of mip `level`, for `len` pixels: `len / 2^level`, rounded up.
#[inline]
pub fn level_len(len: u32, level: u32) -> u32 {
    (len + (1 << level) - 1) >> level
}

/// Pixel coordinate `px` in texels of mip `level`; centres are integers in both. Exact up to 2^15 pixels and level 8.
#[inline]
pub fn level_coordinate(px: f32, level: u32) -> f32 {
    let texels_per_px = f32::from_bits((127 - level) << 23);
    (px + 0.5) * texels_per_px - 0.5
}

/// Whole part and fraction of a coordinate along `len` texels, clamped to the centres of the first and the last.
#[inline]
pub fn split(v: f32, len: u32) -> (u32, f32) {
    let v = v.clamp(0.0, (len - 1) as f32);
    let whole = v.floor();
    (whole as u32, v - whole)
}

/// Linear interpolation: `a` for `t` = 0, `b` for 1.
#[inline]
pub fn blend(a: Vec3, b: Vec3, t: f32) -> Vec3 {
    a + (b - a) * t
}

/// Bilinear interpolation of four texels; `top` and `bottom` are left and right texel.
#[inline]
pub fn bilinear(top: [Vec3; 2], bottom: [Vec3; 2], fraction: [f32; 2]) -> Vec3 {
    blend(blend(top[0], top[1], fraction[0]), blend(bottom[0], bottom[1], fraction[0]), fraction[1])
}

/// Mean of four texels.
#[inline]
pub fn mean_of_four(a: Vec3, b: Vec3, c: Vec3, d: Vec3) -> Vec3 {
    (a + b + c + d) * 0.25
}

/// Pixel coordinate of the centre of block number `block` of 2^level pixels along `len`; clamped to the last pixel for
/// blocks that the border cuts. Exact.
#[inline]
pub fn block_center_px(block: u32, level: u32, len: u32) -> f32 {
    let edge_px = (1_u32 << level) as f32;
    ((block as f32 + 0.5) * edge_px - 0.5).min((len - 1) as f32)
}

/// Mip level that the sample of a block of `level` reads.
#[inline]
pub fn block_sample_level(level: u32) -> u32 {
    level.max(SAMPLE_LEVEL_BIAS) - SAMPLE_LEVEL_BIAS
}

/// Texel of [`block_sample_level`], along one axis, that block number `block` reads.
#[inline]
pub fn block_sample(block: u32, level: u32, len: u32) -> u32 {
    block_center_px(block, level, len) as u32 >> block_sample_level(level)
}
