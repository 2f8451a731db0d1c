//#use lens
// Uniforms of a view; shared by methods and simulators.

// src/uniforms.rs: ViewUniforms, which documents the fields
struct ViewUniforms {
    ray_scale: vec2f,
    ray_offset: vec2f,
    gaze_ray: vec4f,
    depth_row: vec4f,
    key: u32,
    disparity_a: f32,
    disparity_b: f32,
    disparity_flags: u32,
    motion_offset: vec2f,
    jitter_px: vec2f,
    origins: array<vec4u, 4>,
    lowest_px: vec4f,
    highest_px: vec4f,
}

// Foveation::region_angle_deg of a ray: angle in degrees from the gaze by which its region and level of detail are
// chosen. CPU twin: ViewUniforms::region_angle_deg in src/uniforms.rs.
fn region_angle_deg(ray: vec3f, gaze_ray: vec4f) -> f32 {
    return eccentricity_deg(ray, gaze_ray.xyz);
}
