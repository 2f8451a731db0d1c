//#use sanitize
// Twin of src/kernel/color.rs.

const LAB_EPSILON: f32 = 216.0f / 24389.0f;
const LAB_KAPPA: f32 = 24389.0f / 27.0f;

// color::cbrt: initial guess from the bits, then two Halley steps.
fn cbrt(x: f32) -> f32 {
    let size = abs(x);
    if size < 1e-30 {
        return 0.0;
    }
    // Software Vulkan runs the loop for 0, too, where the cube of the guess is denormal. Arithmetic on denormals alone
    // would double the time of the pass.
    let a = select(size, 1.0, size < 1e-30);
    var r = bitcast<f32>(bitcast<u32>(a) / 3u + 0x2a514067u);
    for (var i = 0u; i < 2u; i++) {
        let r3 = r * r * r;
        r = r - r * ((r3 - a) / (2.0 * r3 + a));
    }
    return select(r, -r, x < 0.0);
}

// color::fifth_root: initial guess from the bits, then three Newton steps.
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

// color::srgb_encode (IEC 61966-2-1)
fn srgb_encode(linear_value: f32) -> f32 {
    let a = abs(linear_value);
    var encoded = 12.92 * a;
    if a > 0.0031308 {
        let c = cbrt(a);
        encoded = (1.055 * c) * sqrt(sqrt(c)) - 0.055;
    }
    return select(encoded, -encoded, linear_value < 0.0);
}

// color::srgb_decode
fn srgb_decode(encoded: f32) -> f32 {
    let a = abs(encoded);
    var decoded = a / 12.92;
    if a > 0.04045 {
        let t = (a + 0.055) / 1.055;
        let r = fifth_root(t);
        decoded = (t * t) * (r * r);
    }
    return select(decoded, -decoded, encoded < 0.0);
}

// color::luma (Rec. 709)
fn luma(c: vec3<f32>) -> f32 {
    return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z;
}

// color::lab_f
fn lab_f(t: f32) -> f32 {
    if t > LAB_EPSILON {
        return cbrt(t);
    }
    return (LAB_KAPPA * t + 16.0) / 116.0;
}

// color::lab
fn lab(linear_color: vec3<f32>) -> vec3<f32> {
    let c = clamp(linear_color, vec3<f32>(-MAX_HALF), vec3<f32>(MAX_HALF));
    let fx = lab_f(0.43388735 * c.x + 0.376224 * c.y + 0.18988865 * c.z);
    let fy = lab_f(0.212639 * c.x + 0.7151687 * c.y + 0.0721923 * c.z);
    let fz = lab_f(0.01775004 * c.x + 0.10944762 * c.y + 0.8728023 * c.z);
    return vec3<f32>(116.0 * fy - 16.0, 500.0 * (fx - fy), 200.0 * (fy - fz));
}

// color::delta_e94 (CIE 116): `reference` sets the weights.
fn delta_e94(reference: vec3<f32>, stored: vec3<f32>) -> f32 {
    let d = reference - stored;
    let c1 = sqrt(reference.y * reference.y + reference.z * reference.z);
    let c2 = sqrt(stored.y * stored.y + stored.z * stored.z);
    let dc = c1 - c2;
    let dh2 = max(d.y * d.y + d.z * d.z - dc * dc, 0.0);
    let sc = 1.0 + 0.045 * c1;
    let sh = 1.0 + 0.015 * c1;
    return sqrt(d.x * d.x + (dc * dc) / (sc * sc) + dh2 / (sh * sh));
}
