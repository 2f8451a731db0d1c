// Uniforms of a view, shared by the passes of the methods and of the simulators.

// src/uniforms.rs: ViewUniforms, which documents the fields
struct ViewUniforms {
    ray_scale: vec2<f32>,
    ray_offset: vec2<f32>,
    gaze_ray: vec4<f32>,
    depth_row: vec4<f32>,
    key: u32,
    unused_0: u32,
    unused_1: u32,
    unused_2: u32,
}
