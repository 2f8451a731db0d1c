// Twin of src/kernel/foveate.rs.

// foveate::ramp
fn ramp(x: f32, start: f32, width: f32) -> f32 {
    if x <= start {
        return 0.0;
    }
    if x >= start + width {
        return 1.0;
    }
    return (x - start) / width;
}

// foveate::region_lod
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
