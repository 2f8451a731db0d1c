// What is on the screen: one image left of the divider, another one right of it, and a ring around the gaze.

struct Show {
    size_px: vec2f,
    gaze_px: vec2f,
    divider_px: f32,
    ring_px: f32,
    line_px: f32,
    unused: f32,
}

@group(0) @binding(0) var<uniform> show: Show;
@group(0) @binding(1) var left: texture_2d<f32>;
@group(0) @binding(2) var right: texture_2d<f32>;

@vertex
fn vertex(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
    return vec4f(f32(i & 1u) * 4.0 - 1.0, f32(i >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

fn encoded(c: vec3f) -> vec3f {
    let x = clamp(c, vec3f(0.0), vec3f(1.0));
    return select(1.055 * pow(x, vec3f(1.0 / 2.4)) - 0.055, 12.92 * x, x <= vec3f(0.0031308));
}

@fragment
fn fragment(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let at = position.xy;
    let px = min(vec2u(at), vec2u(show.size_px) - 1u);
    var shown = encoded(textureLoad(right, px, 0).xyz);
    if at.x < show.divider_px {
        shown = encoded(textureLoad(left, px, 0).xyz);
    }
    // A dark rim keeps the lines visible on light pictures.
    let half = 0.5 * show.line_px;
    let distances = vec2f(abs(at.x - show.divider_px), abs(distance(at - 0.5, show.gaze_px) - show.ring_px));
    let rim = 0.35 * (1.0 - smoothstep(vec2f(half), vec2f(3.0 * half + 0.5), distances));
    let line = vec2f(1.0, 0.85) * (1.0 - smoothstep(vec2f(half - 0.5), vec2f(half + 0.5), distances));
    shown = mix(shown, vec3f(0.0), max(rim.x, rim.y));
    return vec4f(mix(shown, vec3f(1.0, 0.72, 0.1), max(line.x, line.y)), 1.0);
}
