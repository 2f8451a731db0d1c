struct Uniforms {
    // Clip space with jitter, of the world and of the view.
    clip_from_world: mat4x4f,
    clip_from_view: mat4x4f,
    // Clip space of the world without jitter: now and in the last frame.
    now: mat4x4f,
    before: mat4x4f,
    // Poses of what moves: world, left hand, right hand.
    moved: array<mat4x4f, 3>,
    moved_before: array<mat4x4f, 3>,
    // Size of the view in pixels; bias of textures' level of detail.
    size: vec4f,
}
@group(0) @binding(0) var<uniform> u: Uniforms;
@group(0) @binding(1) var maps: texture_2d_array<f32>;
@group(0) @binding(2) var map_sampler: sampler;

struct Vertex {
    @location(0) position: vec3f,
    @location(1) uv: vec2f,
    @location(2) tint: vec3f,
    // Texture, and which pose moves the vertex.
    @location(3) map_pose: vec2u,
}
struct Varying {
    // Invariant: both passes must find the same depth.
    @invariant @builtin(position) position: vec4f,
    @location(0) uv: vec2f,
    @location(1) tint: vec3f,
    @location(2) now: vec4f,
    @location(3) before: vec4f,
    @location(4) @interpolate(flat) map: u32,
}

@vertex fn vertex(v: Vertex) -> Varying {
    let world = u.moved[v.map_pose.y] * vec4f(v.position, 1.0);
    let world_before = u.moved_before[v.map_pose.y] * vec4f(v.position, 1.0);
    return Varying(u.clip_from_world * world, v.uv, v.tint, u.now * world, u.before * world_before, v.map_pose.x);
}

@fragment fn motion(in: Varying) -> @location(0) vec2f {
    let ndc = in.before.xy / in.before.w - in.now.xy / in.now.w;
    return ndc * vec2f(0.5, -0.5) * u.size.xy;
}

@fragment fn color(in: Varying) -> @location(0) vec4f {
    return vec4f(textureSampleBias(maps, map_sampler, in.uv, in.map, u.size.z).rgb * in.tint, 1.0);
}

// What the lens hides, at the near plane: nothing behind it is shaded. Vertices are in view space.
@vertex fn hidden(@location(0) position: vec2f) -> @builtin(position) vec4f {
    let clip = u.clip_from_view * vec4f(position, -1.0, 1.0);
    return vec4f(clip.xy, clip.w, clip.w);
}
@fragment fn still() -> @location(0) vec2f {
    return vec2f(0.0);
}
