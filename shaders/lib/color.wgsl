//#use sanitize
// Twin of src/kernel/color.rs.

const DARK: f32 = 0.002;
const ROUNDING: f32 = 5e-4;

// Guess of the inverse root from the bits, then a polynomial.
fn cbrt(x: f32) -> f32 {
    let size = abs(x);
    if size < 1e-30 {
        return 0.0;
    }
    let y = bitcast<f32>(0x54a1f800 - i32(f32(bitcast<i32>(size)) * (1.0f / 3.0)));
    let d = (size * y) * y;
    let e = 1.0 - d * y;
    let p = (((0.42722866 * e + 0.4579193) * e + 0.49381617) * e + 0.5555419) * e + 0.6666667;
    let r = d + d * (e * p);
    return select(r, -r, x < 0.0);
}

// Initial guess from the bits, then three Newton steps.
fn fifth_root(x: f32) -> f32 {
    if x < 1e-25 {
        return 0.0;
    }
    var r = bitcast<f32>(bitcast<u32>(x) / 5u + 0x32c9af22u);
    for (var i = 0u; i < 3u; i++) {
        let r4 = (r * r) * (r * r);
        r = r - (r4 * r - x) / (5.0 * r4);
    }
    return r;
}

// IEC 61966-2-1.
fn srgb_encode(linear_value: f32) -> f32 {
    let a = abs(linear_value);
    var encoded = 12.92 * a;
    if a > 0.0031308 {
        let c = cbrt(a);
        encoded = (1.055 * c) * sqrt(sqrt(c)) - 0.055;
    }
    return select(encoded, -encoded, linear_value < 0.0);
}

// Linear value of one sRGB-encoded channel.
fn srgb_decode(encoded: f32) -> f32 {
    let a = abs(encoded);
    var decoded = a * (1.0f / 12.92);
    if a > 0.04045 {
        let t = (a + 0.055) * (1.0f / 1.055);
        let r = fifth_root(t);
        decoded = (t * t) * (r * r);
    }
    return select(decoded, -decoded, encoded < 0.0);
}

// Rec. 709.
fn luma(c: vec3f) -> f32 {
    return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z;
}

// Stored color scaled to this frame's exposure: times `ratio`, clamped to halves.
fn expose(stored_color: vec3f, ratio: f32) -> vec3f {
    return clamp(stored_color * ratio, vec3f(-MAX_HALF), vec3f(MAX_HALF));
}

// Difference of two linear colors: distance of their square roots in YCoCg, 100 between black and white.
fn root_difference(x: vec3f, y: vec3f) -> f32 {
    return distance_of_roots(roots(x), roots(y));
}

// `root_difference` from the square roots of two colors.
fn distance_of_roots(x: vec3f, y: vec3f) -> f32 {
    let d = x - y;
    let outer = 0.25 * (d.x + d.z);
    let inner = 0.5 * d.y;
    let luma = outer + inner;
    let orange = 0.5 * (d.x - d.z);
    let green = inner - outer;
    let chroma = orange * orange + green * green;
    return 100.0 * sqrt(luma * luma + 0.5 * chroma);
}

// Square roots of a color's channels; 0 for negative ones.
fn roots(c: vec3f) -> vec3f {
    return past_roots(max(c, vec3f(0.0)));
}

// Square roots of the channels of history, which is at least 0.
fn past_roots(c: vec3f) -> vec3f {
    return sqrt(c);
}

// YCoCg of the square roots of a linear color.
fn to_ycocg(c: vec3f) -> vec3f {
    let r = roots(c);
    let outer = 0.25 * (r.x + r.z);
    let inner = 0.5 * r.y;
    return vec3f(outer + inner, 0.5 * (r.x - r.z), inner - outer);
}

// Square roots of RGB from YCoCg, at least 0.
fn roots_of_ycocg(y: vec3f) -> vec3f {
    let outer = y.x - y.z;
    return max(vec3f(outer + y.y, y.x + y.z, outer - y.y), vec3f(0.0));
}

// Clips `history` along the line to `mean` to the box of half width `extent` around `mean`.
fn clip_to_box(history: vec3f, mean: vec3f, extent: vec3f) -> vec3f {
    let d = history - mean;
    let ratio = extent / max(abs(d), vec3f(1e-6));
    let inside = min(min(ratio.x, ratio.y), ratio.z);
    if inside < 1.0 {
        return mean + d * inside;
    }
    return history;
}
