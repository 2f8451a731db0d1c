//#use sanitize
// Twin of src/kernel/reproject.rs.

const MAX_MOTION_PX: f32 = 65536.0;

// reproject::Verdict
const VERDICT_VALID: u32 = 0u;
const VERDICT_RESET: u32 = 1u;
const VERDICT_BAD_MOTION: u32 = 2u;
const VERDICT_OFF_SCREEN: u32 = 3u;
const VERDICT_EMPTY: u32 = 4u;
const VERDICT_DISOCCLUDED: u32 = 5u;
const VERDICT_DISTRUSTED: u32 = 6u;
const VERDICT_COUNT: u32 = 7u;
const COHERENT: vec2f = vec2f(0.5, 0.1);

// sRGB-encoded.
fn verdict_color(verdict: u32) -> vec3f {
    switch verdict {
        case VERDICT_VALID: { return vec3f(0.35, 0.35, 0.35); }
        case VERDICT_RESET: { return vec3f(0.2, 0.4, 1.0); }
        case VERDICT_BAD_MOTION: { return vec3f(1.0, 0.2, 1.0); }
        case VERDICT_OFF_SCREEN: { return vec3f(1.0, 0.55, 0.1); }
        case VERDICT_EMPTY: { return vec3f(1.0, 1.0, 0.3); }
        case VERDICT_DISOCCLUDED: { return vec3f(1.0, 0.1, 0.1); }
        case VERDICT_DISTRUSTED: { return vec3f(0.1, 0.9, 0.9); }
        default: { return vec3f(0.0); }
    }
}

// Position in the previous frame; `at` is (0, 0) unless the verdict is VERDICT_VALID.
struct Reprojection {
    verdict: u32,
    at: vec2u,
}

// Texel of the previous frame nearest to the previous position of pixel (`x`, `y`).
fn nearest(x: u32, y: u32, motion: vec2f, size: vec2u) -> Reprojection {
    // Bits of sizes are ordered as the sizes are, infinity and NaN last.
    let size_bits = bitcast<vec2u>(motion) & vec2u(0x7fffffffu);
    if max(size_bits.x, size_bits.y) > bitcast<u32>(MAX_MOTION_PX) {
        return Reprojection(VERDICT_BAD_MOTION, vec2u(0u));
    }
    let qx = floor(f32(x) + motion.x + 0.5);
    let qy = floor(f32(y) + motion.y + 0.5);
    if qx >= 0.0 && qy >= 0.0 && qx < f32(size.x) && qy < f32(size.y) {
        return Reprojection(VERDICT_VALID, vec2u(u32(qx), u32(qy)));
    }
    return Reprojection(VERDICT_OFF_SCREEN, vec2u(0u));
}

const MAX_CAMERA_PX: f32 = 32768.0;

const UNKNOWN_VECTOR_PX: f32 = 131072.0;

struct ViewMotion {
    x: vec4f,
    y: vec4f,
    z: vec4f,
    per_tangent: vec2f,
    zoom: vec2f,
    shift_px: vec2f,
    ahead: f32,
    sky: f32,
}

// Motion vector in pixels of a surface that stands still in the world, at the ray (`ray`, 1): previous minus current.
fn camera_vector(ray: vec2f, disparity: f32, motion: ViewMotion) -> vec2f {
    if disparity < 0.0 {
        return vec2f(UNKNOWN_VECTOR_PX);
    }
    let x = motion.x;
    let y = motion.y;
    let z = motion.z;
    let d = select(disparity, 0.0, disparity <= motion.sky);
    let past_depth = z.x * ray.x + (z.y * ray.y + (z.w * d + motion.ahead));
    // The point was behind the previous camera.
    if past_depth <= 1e-6 {
        return vec2f(MAX_CAMERA_PX);
    }
    let change = vec3f(
        x.x * ray.x + (x.y * ray.y + (x.w * d + x.z)),
        y.x * ray.x + (y.y * ray.y + (y.w * d + y.z)),
        z.x * ray.x + (z.y * ray.y + (z.w * d + z.z)),
    );
    let tangent = (change.xy - ray * change.z) / past_depth;
    let vector = tangent * motion.per_tangent + (ray * motion.zoom + motion.shift_px);
    return clamp(vector, vec2f(-MAX_CAMERA_PX), vec2f(MAX_CAMERA_PX));
}

// Longest component of a surface's motion in the world, in pixels a frame: its `motion` without the `camera`'s.
fn world_motion_px(motion: vec2f, camera: vec2f) -> f32 {
    return max(abs(motion.x - camera.x), abs(motion.y - camera.y));
}

// Whether a pixel of a motion input has no vector: it is `none`, or not finite.
fn has_no_vector(given: vec2f, none: vec2f) -> bool {
    return !(is_finite(given.x) && is_finite(given.y)) || all(given == none);
}

// Whether two motion vectors, in pixels, can belong to one surface.
fn moves_alike(own: vec2f, other: vec2f) -> bool {
    let within = COHERENT.x + COHERENT.y * (abs(own.x) + abs(own.y));
    return abs(other.x - own.x) <= within && abs(other.y - own.y) <= within;
}
