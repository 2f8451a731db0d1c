//! How coarse a foveated frame is where: level of detail by eccentricity.

/// 0 up to `start`, 1 from `start + width` on, linear in between (a step for width 0).
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

/// Level of detail (log2 of the block edge in pixels) at eccentricity `e_deg`: 0 inside the fovea, `lod_mid` to the edge of
/// the middle region, `lod_far` beyond, each step spread linearly over `blend_deg` outside its radius.
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

/// Level of detail of a blur that is 0 up to `start_deg` and whose standard deviation grows linearly from there, to
/// `sigma_at_end` pixels at `end_deg`, up to `largest_sigma`: `2^lod = 1 + 2 sigma`, so that block edges and blurs of one level
/// look equally coarse.
#[inline]
pub fn blur_lod(e_deg: f32, start_deg: f32, end_deg: f32, sigma_at_end: f32, largest_sigma: f32) -> f32 {
    let slope = sigma_at_end / (end_deg - start_deg).max(1e-3);
    let sigma = (slope * (e_deg - start_deg)).clamp(0.0, largest_sigma);
    (1.0 + 2.0 * sigma).log2()
}

/// Standard deviation in pixels of the blur of level of detail `lod`.
#[inline]
pub fn blur_sigma_px(lod: f32) -> f32 {
    0.5 * (lod.exp2() - 1.0)
}
