// What is on the screen: one image left of the divider, another one right of it, and a ring around the gaze.

struct Show {
    size_px: vec2<f32>,
    gaze_px: vec2<f32>,
    divider_px: f32,
    ring_px: f32,
    unused_0: f32,
    unused_1: f32,
}

@group(0) @binding(0) var<uniform> show: Show;
@group(0) @binding(1) var left: texture_2d<f32>;
@group(0) @binding(2) var right: texture_2d<f32>;

@vertex
fn vertex(@builtin(vertex_index) i: u32) -> @builtin(position) vec4<f32> {
    return vec4<f32>(f32(i & 1u) * 4.0 - 1.0, f32(i >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

fn encoded(c: vec3<f32>) -> vec3<f32> {
    let x = clamp(c, vec3<f32>(0.0), vec3<f32>(1.0));
    return select(1.055 * pow(x, vec3<f32>(1.0 / 2.4)) - 0.055, 12.92 * x, x <= vec3<f32>(0.0031308));
}

@fragment
fn fragment(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let at = position.xy;
    let px = min(vec2<u32>(at), vec2<u32>(show.size_px) - 1u);
    var shown = encoded(textureLoad(right, px, 0).xyz);
    if at.x < show.divider_px {
        shown = encoded(textureLoad(left, px, 0).xyz);
    }
    let line = abs(at.x - show.divider_px);
    let ring = abs(distance(at - 0.5, show.gaze_px) - show.ring_px);
    let mark = max(1.0 - smoothstep(0.5, 1.5, line), 0.7 * (1.0 - smoothstep(0.5, 1.5, ring)));
    return vec4<f32>(mix(shown, vec3<f32>(1.0, 0.72, 0.1), mark), 1.0);
}
