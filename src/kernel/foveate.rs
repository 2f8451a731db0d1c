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
