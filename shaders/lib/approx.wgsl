// Twin of src/kernel/approx.rs, which states the accuracies (polynomials of Cephes).

const TAN_PI_8: f32 = 0.41421356;
const PI: f32 = 3.14159265358979323846;
const FRAC_PI_2: f32 = 1.57079632679489661923;
const FRAC_PI_4: f32 = 0.785398163397448309616;
const LOG2_E: f32 = 1.44269504088896340736;
const FRAC_1_SQRT_2: f32 = 0.707106781186547524401;

// y >= 0, result in [0, pi].
fn atan2_upper(y: f32, x: f32) -> f32 {
    let ax = abs(x);
    let small = select(y, ax, y > ax);
    let large = select(ax, y, y > ax);
    if large == 0.0 {
        return 0.0;
    }
    let steep = small > TAN_PI_8 * large;
    let base = select(0.0, FRAC_PI_4, steep);
    let t = select(small, small - large, steep) / select(large, small + large, steep);
    let z = t * t;
    let p = ((8.0537445e-2 * z - 1.3877686e-1) * z + 1.9977711e-1) * z - 3.333295e-1;
    var angle = base + (t + t * z * p);
    if y > ax {
        angle = FRAC_PI_2 - angle;
    }
    if x < 0.0 {
        angle = PI - angle;
    }
    return angle;
}

// 2^n times a polynomial of the remainder.
fn exp_approx(exponent: f32) -> f32 {
    let x = clamp(exponent, -87.0, 88.0);
    let n = floor(x * LOG2_E + 0.5);
    let r = (x - n * 0.6933594) - n * -2.1219444e-4;
    let p = ((((1.9875692e-4 * r + 1.3982e-3) * r + 8.333452e-3) * r + 4.1665796e-2) * r + 1.6666665e-1) * r + 0.5;
    let scale = bitcast<f32>(u32(i32(n) + 127) << 23u);
    // Not (p * r * r + r) + 1: compilers may move the constant.
    return ((p * r + 1.0) * r + 1.0) * scale;
}

// 2^n times a polynomial of the remainder.
fn exp2_approx(exponent: f32) -> f32 {
    let x = clamp(exponent, -126.0, 127.0);
    let n = floor(x + 0.5);
    let r = x - n;
    let p = ((((1.5353362e-4 * r + 1.3398874e-3) * r + 9.618437e-3) * r + 5.5503325e-2) * r + 2.4022648e-1) * r
        + 6.931472e-1;
    let scale = bitcast<f32>(u32(i32(n) + 127) << 23u);
    return (p * r + 1.0) * scale;
}

// Exponent and a polynomial of the mantissa.
fn ln_approx(x: f32) -> f32 {
    let bits = bitcast<u32>(x);
    var exponent = i32(bits >> 23u) - 126;
    var m = bitcast<f32>((bits & 0x007fffffu) | 0x3f000000u);
    if m < FRAC_1_SQRT_2 {
        exponent -= 1;
        m += m;
    }
    m -= 1.0;
    let z = m * m;
    var p = 7.0376836e-2 * m - 1.151461e-1;
    p = p * m + 1.1676999e-1;
    p = p * m - 1.2420141e-1;
    p = p * m + 1.4249323e-1;
    p = p * m - 1.6668058e-1;
    p = p * m + 2.0000715e-1;
    p = p * m - 2.4999994e-1;
    p = p * m + 3.333333e-1;
    p = p * m * z;
    let e = f32(exponent);
    let tail = p + e * -2.1219444e-4 - 0.5 * z;
    return m + tail + e * 0.6933594;
}

// (sin, cos) of 2 pi x.
fn sin_cos_turns(x: f32) -> vec2f {
    let n = floor(x * 4.0 + 0.5);
    let r = x - n * 0.25;
    let z = r * r;
    let s = (((-75.445656 * z + 81.593765) * z - 41.34167) * z + 6.2831855) * r;
    let c = (((59.3497 * z - 85.44714) * z + 64.93936) * z - 19.739208) * z + 1.0;
    let quarter = i32(n) & 3;
    if quarter == 0 {
        return vec2f(s, c);
    }
    if quarter == 1 {
        return vec2f(c, -s);
    }
    if quarter == 2 {
        return vec2f(-s, -c);
    }
    return vec2f(-c, s);
}

// Smooth step (3t^2 - 2t^3): 0 up to `low`, 1 from `low + width` on.
fn smooth_step(low: f32, width: f32, x: f32) -> f32 {
    let t = clamp((x - low) / width, 0.0, 1.0);
    return (t * t) * (3.0 - 2.0 * t);
}
