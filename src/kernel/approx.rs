//! Elementary functions built from exactly rounded operations, so that CPU and GPU agree bit for bit. Tests check the
//! stated accuracies.
//!
//! Shader compilers may still reorder sums: Mesa turns `(product + x) + constant` into `(x + constant) + product`.
//! Horner's form has no sum that it can reorder.

use std::f32::consts::{FRAC_PI_2, FRAC_PI_4, PI};

/// tan(pi/8), where the arc tangent's reduction switches.
const TAN_PI_8: f32 = 0.414_213_56;

/// Angle in radians, in \[0, pi\], of the vector (`x`, `y`) with `y >= 0`; 0 for the zero vector.
///
/// Absolute error below 3e-7 rad. Cephes' `atanf` polynomial after a reduction to |t| <= tan(pi/8) with one division.
#[inline]
pub fn atan2_upper(y: f32, x: f32) -> f32 {
    let ax = x.abs();
    let (small, large) = if y > ax { (ax, y) } else { (y, ax) };
    if large == 0.0 {
        return 0.0;
    }
    let steep = small > TAN_PI_8 * large;
    let base = if steep { FRAC_PI_4 } else { 0.0 };
    let t = if steep { (small - large) / (small + large) } else { small / large };
    let z = t * t;
    let p = ((8.053_744_5e-2 * z - 1.387_768_6e-1) * z + 1.997_771_1e-1) * z - 3.333_295e-1;
    let mut angle = base + (t + t * z * p);
    if y > ax {
        angle = FRAC_PI_2 - angle;
    }
    if x < 0.0 {
        angle = PI - angle;
    }
    angle
}

/// e^x for `x` in \[-87, 88\]; clamped outside. Relative error below 2e-7.
///
/// Cephes' `expf`: 2^n times a polynomial of the remainder.
#[inline(always)]
pub fn exp_approx(x: f32) -> f32 {
    let x = x.clamp(-87.0, 88.0);
    let n = (x * std::f32::consts::LOG2_E + 0.5).floor();
    // ln 2 in two parts, so that the product with n is exact.
    let r = (x - n * 0.693_359_4) - n * -2.121_944_4e-4;
    let p =
        ((((1.987_569_2e-4 * r + 1.398_2e-3) * r + 8.333_452e-3) * r + 4.166_579_6e-2) * r + 1.666_666_5e-1) * r + 0.5;
    let scale = f32::from_bits(((n as i32 + 127) as u32) << 23);
    ((p * r + 1.0) * r + 1.0) * scale
}

/// 2^x for `x` in \[-126, 127\]; clamped outside. Relative error below 2e-7.
///
/// Cephes' `exp2f`. Not `exp(x * ln 2)`: compilers may multiply ln 2 into a constant factor of x.
#[inline]
pub fn exp2_approx(x: f32) -> f32 {
    let x = x.clamp(-126.0, 127.0);
    let n = (x + 0.5).floor();
    let r = x - n;
    let p = ((((1.535_336_2e-4 * r + 1.339_887_4e-3) * r + 9.618_437e-3) * r + 5.550_332_5e-2) * r + 2.402_264_8e-1)
        * r
        + 6.931_472e-1;
    let scale = f32::from_bits(((n as i32 + 127) as u32) << 23);
    (p * r + 1.0) * scale
}

/// Natural logarithm of `x` in \[1.2e-38, 3.4e38\]. Relative error below 2e-7, absolute below 1e-7 near 1.
///
/// Cephes' `logf`: exponent and a polynomial of the mantissa in \[sqrt(1/2), sqrt(2)).
#[inline(always)]
pub fn ln_approx(x: f32) -> f32 {
    let bits = x.to_bits();
    let mut exponent = (bits >> 23) as i32 - 126;
    let mut m = f32::from_bits((bits & 0x007f_ffff) | 0x3f00_0000);
    if m < std::f32::consts::FRAC_1_SQRT_2 {
        exponent -= 1;
        m += m;
    }
    m -= 1.0;
    let z = m * m;
    let p = ((((((((7.037_683_6e-2 * m - 1.151_461e-1) * m + 1.167_699_9e-1) * m - 1.242_014_1e-1) * m
        + 1.424_932_3e-1)
        * m
        - 1.666_805_8e-1)
        * m
        + 2.000_071_5e-1)
        * m
        - 2.499_999_4e-1)
        * m
        + 3.333_333e-1)
        * m
        * z;
    let e = exponent as f32;
    let tail = p + e * -2.121_944_4e-4 - 0.5 * z;
    m + tail + e * 0.693_359_4
}

/// (sin, cos) of `x` turns, that is of 2 pi x, for |x| up to 2^20. Absolute error below 2e-7; exact at quarter turns.
///
/// Cephes' polynomials after an exact reduction to an eighth of a turn; 2 pi is in the coefficients.
#[inline]
pub fn sin_cos_turns(x: f32) -> [f32; 2] {
    let n = (x * 4.0 + 0.5).floor();
    let r = x - n * 0.25;
    let z = r * r;
    let s = (((-75.445_656 * z + 81.593_765) * z - 41.341_67) * z + 6.283_185_5) * r;
    let c = (((59.349_7 * z - 85.447_14) * z + 64.939_36) * z - 19.739_208) * z + 1.0;
    match (n as i32) & 3 {
        0 => [s, c],
        1 => [c, -s],
        2 => [-s, -c],
        _ => [-c, s],
    }
}

/// Smooth step (3t^2 - 2t^3): 0 up to `from`, 1 from `from + width` on.
#[inline(always)]
pub fn smooth_step(from: f32, width: f32, x: f32) -> f32 {
    let t = ((x - from) / width).clamp(0.0, 1.0);
    (t * t) * (3.0 - 2.0 * t)
}
