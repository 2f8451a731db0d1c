// Twin of src/kernel/sanitize.rs. Numbers are tested by their bits, because WGSL may assume that NaN and infinity do
// not exist.

const MAX_HALF: f32 = 65504.0;
const LEAST_COLOR: f32 = 0x1p-32;

// Whether a number is neither NaN nor infinite.
fn is_finite(x: f32) -> bool {
    return (bitcast<u32>(x) & 0x7f800000u) != 0x7f800000u;
}

struct Sanitized {
    color: vec3f,
    usable: bool,
}

// Color clamped to +-65504, with channels below `LEAST_COLOR` as 0, and whether it is usable; black and `false` if any
// component is NaN or infinite.
fn color(c: vec3f) -> Sanitized {
    let size = bitcast<vec3u>(c) & vec3u(0x7fffffffu);
    if max(max(size.x, size.y), size.z) < 0x7f800000u {
        let limited = clamp(c, vec3f(-MAX_HALF), vec3f(MAX_HALF));
        return Sanitized(select(vec3f(0.0), limited, size >= vec3u(bitcast<u32>(LEAST_COLOR))), true);
    }
    return Sanitized(vec3f(0.0), false);
}

// The bits of positive floats are ordered as the floats, infinity last and NaN beyond it.
fn trust(t: f32) -> f32 {
    let bits = bitcast<u32>(t);
    if bits >= 0x3f800000u && bits <= 0x7f800000u {
        return 1.0;
    }
    return select(0.0, t, bits >= 0x00800000u && bits < 0x3f800000u);
}

// Unchanged from the smallest normal float to the largest finite one, otherwise 0.
fn weight(w: f32) -> f32 {
    let bits = bitcast<u32>(w);
    return select(0.0, w, bits >= 0x00800000u && bits < 0x7f800000u);
}
