//#use color
//#use reproject
//#use sanitize
// Twin of src/kernel/debug_view.rs: the decision at a pixel as a color.

// debug_view::DebugView
const VIEW_QUALITY: u32 = 1u;
const VIEW_AGE: u32 = 2u;
const VIEW_HISTORY_SHARE: u32 = 3u;
const VIEW_REJECTION: u32 = 4u;
const VIEW_AGREEMENT: u32 = 5u;
const VIEW_MOTION: u32 = 6u;

struct PixelTrace {
    verdict: u32,
    weight: f32,
    quality: f32,
    age: u32,
    history_share: f32,
    agreement: f32,
    is_replaced: bool,
    motion: vec2f,
}

const NONFINITE = vec3f(0.0, 1.0, 0.0);

// sRGB-encoded.
fn heat(value: f32) -> vec3f {
    if !is_finite(value) {
        return NONFINITE;
    }
    var stops = array<vec3f, 6>(
        vec3f(0.0, 0.0, 0.0),
        vec3f(0.23, 0.04, 0.42),
        vec3f(0.62, 0.13, 0.40),
        vec3f(0.93, 0.38, 0.18),
        vec3f(0.98, 0.75, 0.25),
        vec3f(1.0, 1.0, 0.95),
    );
    let position = 5.0 * clamp(value, 0.0, 1.0);
    let i = min(u32(position), 4u);
    let t = position - f32(i);
    return stops[i] + (stops[i + 1u] - stops[i]) * t;
}

// sRGB-encoded.
fn motion_color(motion: vec2f) -> vec3f {
    if !(is_finite(motion.x) && is_finite(motion.y)) {
        return NONFINITE;
    }
    let x = clamp(-motion.x / 16.0, -1.0, 1.0);
    let y = clamp(-motion.y / 16.0, -1.0, 1.0);
    let towards = 0.5 - 0.25 * x;
    let shown = vec3f(0.5 + 0.5 * x, towards + 0.43 * y, towards - 0.43 * y);
    return clamp(shown, vec3f(0.0), vec3f(1.0));
}

// Linear.
fn view_color(view: u32, traced: PixelTrace) -> vec3f {
    var encoded = vec3f(traced.agreement);
    switch view {
        case VIEW_QUALITY: { encoded = heat(traced.quality); }
        case VIEW_AGE: { encoded = heat(sqrt(f32(traced.age) * (1.0f / 255.0))); }
        case VIEW_HISTORY_SHARE: { encoded = heat(traced.history_share); }
        case VIEW_REJECTION: { encoded = verdict_color(traced.verdict); }
        case VIEW_MOTION: { encoded = motion_color(traced.motion); }
        default: {}
    }
    return vec3f(srgb_decode(encoded.x), srgb_decode(encoded.y), srgb_decode(encoded.z));
}
