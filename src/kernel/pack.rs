//! Codes of numbers in stored words, by integer arithmetic, so that rounding is the same on every device: halves, and
//! disparities in 16 bits.

use super::sanitize::MAX_HALF;

/// Bits of the half nearest to `x` (ties to even), clamped to +-65504. Denormal halves are rounded correctly, too.
#[inline]
pub fn half_bits(x: f32) -> u32 {
    let sign = (x.to_bits() >> 16) & 0x8000;
    let a = x.to_bits() & 0x7fff_ffff;
    if a >= MAX_HALF.to_bits() {
        return sign | 0x7bff;
    }
    if a < 113 << 23 {
        // Adding 0.5 shifts the mantissa to the grid of denormal halves and rounds it.
        return sign | ((f32::from_bits(a) + 0.5).to_bits() - 0.5_f32.to_bits());
    }
    let odd = (a >> 13) & 1;
    let rounded = (a - (112 << 23) + 0xfff + odd) >> 13;
    sign | rounded.min(0x7bff)
}

/// Value of the finite half in the low 16 bits of `bits`.
#[inline]
pub fn half_value(bits: u32) -> f32 {
    let magnitude = (bits & 0x7fff) << 13;
    let sign = (bits & 0x8000) << 16;
    let normal = f32::from_bits(magnitude + (112 << 23));
    // Denormal halves have no leading one bit: their value is the second operand, which is then the smaller one.
    // Neither operand is a 32-bit denormal, which devices may flush to zero.
    let value = normal.min(2.0 * normal - f32::from_bits(113 << 23));
    f32::from_bits(value.to_bits() | sign)
}

/// 16-bit code of a disparity: 6 bits of exponent (2^-32 to 2^32) and 10 of mantissa, a relative error of at most
/// 2^-11. Smaller disparities become 0, the sky; negative ones (unknown) 0xffff.
#[inline]
pub fn disparity_code(disparity: f32) -> u32 {
    if disparity < 0.0 {
        return 0xffff;
    }
    // Clears the sign of -0.
    let bits = disparity.to_bits() & 0x7fff_ffff;
    if bits < 95 << 23 {
        return 0;
    }
    let rounded = (bits + 0x1000) >> 13;
    rounded.saturating_sub(95 << 10).clamp(1, 0xfffe)
}

/// Disparity of a 16-bit code; -1 for 0xffff, the unknown disparity.
#[inline]
pub fn disparity_value(code: u32) -> f32 {
    match code {
        0 => 0.0,
        0xffff => -1.0,
        code => f32::from_bits((code + (95 << 10)) << 13),
    }
}

/// Relative difference of disparity within which texels are filtered together: wide enough for slopes, narrow enough
/// for silhouettes.
pub const TAP_RELATIVE: f32 = 0.1;

/// Largest disparity that [`disparity`](super::depth::disparity) gives.
const LARGEST_DISPARITY: f32 = 1e30;

/// The first of the [`disparity_code`]s from `low` to `high` times the disparity `expected`, and their number: 0 if the
/// expected disparity is negative.
#[inline]
pub fn codes_between(expected: f32, low: f32, high: f32) -> [u32; 2] {
    // The limit keeps compilers from merging these factors with those of the disparity.
    let limited = expected.min(LARGEST_DISPARITY);
    let first = disparity_code(limited * low);
    let last = disparity_code(limited * high);
    [first, if expected < 0.0 { 0 } else { last - first + 1 }]
}

/// [`codes_between`] of the surface that has the disparity `expected`, within [`TAP_RELATIVE`].
#[inline]
pub fn tap_codes(expected: f32) -> [u32; 2] {
    codes_between(expected, 1.0 - TAP_RELATIVE, 1.0 / (1.0 - TAP_RELATIVE))
}

/// [`tap_codes`] for surfaces that have the disparities from `farthest` to `nearest`, both of them at least 0.
#[inline]
pub fn tap_codes_between(farthest: f32, nearest: f32) -> [u32; 2] {
    let (first, last) = (tap_codes(farthest), tap_codes(nearest));
    [first[0], last[0].max(first[0]) - first[0] + last[1]]
}

/// Whether the disparity in the high half of `word` is one of [`codes_between`].
#[inline]
pub fn has_code(word: u32, codes: [u32; 2]) -> bool {
    (word >> 16).wrapping_sub(codes[0]) < codes[1]
}
