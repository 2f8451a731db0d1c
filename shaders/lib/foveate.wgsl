//#use approx
// Twin of src/kernel/foveate.rs, which explains the constants.

const SHARPEST_BLUR_PX: f32 = 0.125;
const SAMPLE_LEVEL_BIAS: u32 = 2u;

// Linear ramp: 0 up to `start`, 1 from `start + width` on.
fn ramp(x: f32, start: f32, width: f32) -> f32 {
    if x <= start {
        return 0.0;
    }
    if x >= start + width {
        return 1.0;
    }
    return (x - start) / width;
}

// Level of detail (log2 of the block edge in pixels) at eccentricity `e_deg`, from region to region.
fn region_lod(
    e_deg: f32,
    fovea_radius_deg: f32,
    mid_radius_deg: f32,
    blend_deg: f32,
    lod_mid: f32,
    lod_far: f32,
) -> f32 {
    return lod_mid * ramp(e_deg, fovea_radius_deg, blend_deg)
        + (lod_far - lod_mid) * ramp(e_deg, mid_radius_deg, blend_deg);
}

// Level of detail of a blur at eccentricity `e_deg`.
fn blur_lod(e_deg: f32, start_deg: f32, end_deg: f32, lod_mid: f32, lod_far: f32) -> f32 {
    let slope = blur_sigma_px(lod_mid) / max(end_deg - start_deg, 1e-3);
    let sigma = clamp(slope * (e_deg - start_deg), 0.0, blur_sigma_px(lod_far));
    return ln_approx(1.0 + 2.0 * sigma) * LOG2_E;
}

// Standard deviation in pixels of the blur of level of detail `lod` in [0, 8].
fn blur_sigma_px(lod: f32) -> f32 {
    return 0.5 * (exp2_approx(lod) - 1.0);
}

struct GaussTap {
    weight: f32,
    ratio: f32,
    ratio_step: f32,
}

// Centre tap of a Gaussian of standard deviation `sigma_px`.
fn gauss_center(sigma_px: f32) -> GaussTap {
    let s = max(sigma_px, SHARPEST_BLUR_PX);
    let ratio = exp_approx(-0.5 / (s * s));
    return GaussTap(1.0, ratio, ratio * ratio);
}

// Tap one pixel further out.
fn gauss_next(tap: GaussTap) -> GaussTap {
    return GaussTap(tap.weight * tap.ratio, tap.ratio * tap.ratio_step, tap.ratio_step);
}

// Number of taps on each side of a Gaussian's centre: it is cut at 3 standard deviations.
fn gauss_radius(sigma_px: f32) -> u32 {
    if sigma_px < SHARPEST_BLUR_PX {
        return 0u;
    }
    return u32(3.0 * sigma_px) + 1u;
}

// Texels a side of mip `level`, for `len` pixels: `len / 2^level`, rounded up.
fn level_len(len: u32, level: u32) -> u32 {
    return (len + (1u << level) - 1u) >> level;
}

// Pixel coordinate `px` in texels of mip `level`; centres are integers in both.
fn level_coordinate(px: f32, level: u32) -> f32 {
    let texels_per_px = bitcast<f32>((127u - level) << 23u);
    return (px + 0.5) * texels_per_px - 0.5;
}

struct Split {
    whole: u32,
    fraction: f32,
}

// Whole part and fraction of a coordinate along `len` texels, clamped to the centres of the first and the last.
fn split(coordinate: f32, len: u32) -> Split {
    let v = clamp(coordinate, 0.0, f32(len - 1u));
    let whole = floor(v);
    return Split(u32(whole), v - whole);
}

// Linear interpolation: `a` for `t` = 0, `b` for 1.
fn blend(a: vec3f, b: vec3f, t: f32) -> vec3f {
    return a + (b - a) * t;
}

// Bilinear interpolation of four texels; `top` and `bottom` are left and right texel.
fn bilinear(top_left: vec3f, top_right: vec3f, bottom_left: vec3f, bottom_right: vec3f, fraction: vec2f) -> vec3f {
    let top = blend(top_left, top_right, fraction.x);
    let bottom = blend(bottom_left, bottom_right, fraction.x);
    return blend(top, bottom, fraction.y);
}

// Mean of four texels.
fn mean_of_four(a: vec3f, b: vec3f, c: vec3f, d: vec3f) -> vec3f {
    return (a + b + c + d) * 0.25;
}

// Pixel coordinate of the centre of block number `block` of 2^level pixels along `len`; clamped to the last pixel for
// blocks that the border cuts.
fn block_center_px(block: u32, level: u32, len: u32) -> f32 {
    let edge_px = f32(1u << level);
    return min((f32(block) + 0.5) * edge_px - 0.5, f32(len - 1u));
}

// Mip level that the sample of a block of `level` reads.
fn block_sample_level(level: u32) -> u32 {
    return max(level, SAMPLE_LEVEL_BIAS) - SAMPLE_LEVEL_BIAS;
}

// Texel of `block_sample_level`, along one axis, that block number `block` reads.
fn block_sample(block: u32, level: u32, len: u32) -> u32 {
    return u32(block_center_px(block, level, len)) >> block_sample_level(level);
}
