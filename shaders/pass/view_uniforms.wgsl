//#use acuity
// Uniforms of a view; shared by methods and simulators.

// src/uniforms.rs: ViewUniforms, which documents the fields
struct ViewUniforms {
    ray_scale: vec2<f32>,
    ray_offset: vec2<f32>,
    gaze_ray: vec4<f32>,
    depth_row: vec4<f32>,
    key: u32,
    disparity_a: f32,
    disparity_b: f32,
    disparity_flags: u32,
    motion_offset: vec2<f32>,
    jitter_px: vec2<f32>,
    origins: array<vec4<u32>, 3>,
    lowest_px: vec4<f32>,
    highest_px: vec4<f32>,
}

// src/uniforms.rs: CameraUniforms, which documents the fields
struct CameraUniforms {
    x: vec4<f32>,
    y: vec4<f32>,
    z: vec4<f32>,
    per_tangent: vec2<f32>,
    zoom: vec2<f32>,
    shift_px: vec2<f32>,
    ahead: f32,
    sky: f32,
    no_vector: vec2<f32>,
    unused_0: u32,
    unused_1: u32,
}

// Foveation::region_angle_deg of a ray: angle in degrees from the gaze by which its region and level of detail are
// chosen. CPU twin: ViewUniforms::region_angle_deg in src/uniforms.rs.
fn region_angle_deg(ray: vec3<f32>, gaze_ray: vec4<f32>) -> f32 {
    return eccentricity_deg(ray, gaze_ray.xyz);
}
