//#use color
// What the window shows: a picture, or that of one side of the divider, where the eye looks, and the panel. One
// invocation a pixel of the window. What branches hang on is constant when the pipeline is made: software devices
// compute all branches of a shader, and lavapipe compiles it anew at every bind if they hang on a uniform.

// src/commands/view/screen.rs: ScreenConstants, which explains them
struct ScreenConstants {
    gaze_direction: vec4f,
    corner: vec2f,
    size: vec2f,
    ray_scale: vec2f,
    ray_offset: vec2f,
    gaze_px: vec2f,
    ring_cosines: vec2f,
    panel: vec2f,
    scale: f32,
    divider: f32,
    panel_scale: f32,
    ring_reach_px: f32,
    gain: f32,
}

// Texels a side that are averaged for a pixel of the window; 0: the picture is enlarged, between texels.
override TAPS: u32 = 1u;
// Whether the target takes sRGB-encoded numbers as they are.
override SHADER_ENCODES: bool = false;

@group(0) @binding(0) var<uniform> screen: ScreenConstants;
@group(0) @binding(1) var picture: texture_2d<f32>;
@group(0) @binding(2) var panel: texture_2d<f32>;

// Linear.
const MARK = vec3f(1.0, 0.69, 0.01);
const BACKDROP = vec3f(0.013, 0.013, 0.015);
// Share of the panel in what is shown where it lies.
const PANEL_OPACITY: f32 = 0.97;
// Half width of the divider and of the light in its middle, and radius of the gaze point, in pixels of the window.
const DIVIDER_PX: f32 = 2.0;
const DIVIDER_LIGHT_PX: f32 = 1.0;
const POINT_PX: f32 = 3.0;

@vertex
fn corner(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    // One triangle over everything.
    return vec4f(f32(index & 1u) * 4.0 - 1.0, f32(index >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

fn nearest(at: vec2f) -> vec3f {
    return textureLoad(picture, vec2u(clamp(at, vec2f(0.0), screen.size - 1.0)), 0).xyz;
}

// The picture at a position from its top left corner, in its own pixels.
fn picture_at(at: vec2f) -> vec3f {
    if TAPS == 0u {
        let base = floor(at - 0.5);
        let share = at - 0.5 - base;
        let above = mix(nearest(base), nearest(base + vec2f(1.0, 0.0)), share.x);
        let below = mix(nearest(base + vec2f(0.0, 1.0)), nearest(base + 1.0), share.x);
        return mix(above, below, share.y);
    }
    let taps = f32(TAPS);
    let stride = 1.0 / (screen.scale * taps);
    var sum = vec3f(0.0);
    for (var y = 0u; y < TAPS; y += 1u) {
        for (var x = 0u; x < TAPS; x += 1u) {
            sum += nearest(at + (vec2f(f32(x), f32(y)) - 0.5 * (taps - 1.0)) * stride);
        }
    }
    return sum / (taps * taps);
}

// A ring around the fovea and a point in its middle.
fn marked(color: vec3f, at: vec2f) -> vec3f {
    let offset = (at - 0.5 - screen.gaze_px) * screen.scale;
    let squared = dot(offset, offset);
    if squared < POINT_PX * POINT_PX {
        return MARK;
    }
    if squared > screen.ring_reach_px * screen.ring_reach_px {
        return color;
    }
    let ray = vec3f((at - 0.5) * screen.ray_scale + screen.ray_offset, 1.0);
    let cosine = dot(ray, screen.gaze_direction.xyz) * inverseSqrt(dot(ray, ray));
    if cosine > screen.ring_cosines.x && cosine < screen.ring_cosines.y {
        return mix(color, MARK, 0.8);
    }
    return color;
}

fn composed(at_window: vec2f) -> vec3f {
    let at = (at_window - screen.corner) / screen.scale;
    var shown = BACKDROP;
    if all(at >= vec2f(0.0)) && all(at < screen.size) {
        let from_divider = (at.x - screen.divider) * screen.scale;
        if abs(from_divider) < DIVIDER_PX {
            shown = select(BACKDROP, vec3f(1.0), abs(from_divider) < DIVIDER_LIGHT_PX);
        } else {
            shown = marked(picture_at(at) * screen.gain, at);
        }
    }
    let on_panel = at_window / screen.panel_scale;
    if all(on_panel < screen.panel) {
        shown = mix(shown, textureLoad(panel, vec2u(on_panel), 0).xyz, PANEL_OPACITY);
    }
    return shown;
}

@fragment
fn main(@builtin(position) at: vec4f) -> @location(0) vec4f {
    // What a screen shows. NaN fails the comparison.
    let sum = composed(at.xy);
    let shown = select(vec3f(0.0), min(sum, vec3f(1.0)), sum > vec3f(0.0));
    if !SHADER_ENCODES {
        return vec4f(shown, 1.0);
    }
    return vec4f(srgb_encode(shown.x), srgb_encode(shown.y), srgb_encode(shown.z), 1.0);
}
