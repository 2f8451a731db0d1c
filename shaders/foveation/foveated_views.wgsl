//#use foveate
//#use view_uniforms
// Uniforms of the foveation simulators, and the angle of a pixel.

// src/simulator/gpu/uniforms.rs: FoveationUniforms, which documents the fields
struct FoveationUniforms {
    size: vec2u,
    coarsest: u32,
    fovea_radius_deg: f32,
    mid_radius_deg: f32,
    blend_deg: f32,
    lod_mid: f32,
    lod_far: f32,
    views: array<ViewUniforms, 4>,
}

@group(0) @binding(0) var<uniform> frame: FoveationUniforms;

// region_angle_deg of the ray through a position in pixels.
fn region_angle_at(px: vec2f, view: u32) -> f32 {
    let ray = vec3f(px * frame.views[view].ray_scale + frame.views[view].ray_offset, 1.0);
    return region_angle_deg(ray, frame.views[view].gaze_ray);
}

// Level of detail at an angle from the gaze, blended between the regions.
fn blended_lod(e_deg: f32) -> f32 {
    let radii = vec2f(frame.fovea_radius_deg, frame.mid_radius_deg);
    return region_lod(e_deg, radii.x, radii.y, frame.blend_deg, frame.lod_mid, frame.lod_far);
}
