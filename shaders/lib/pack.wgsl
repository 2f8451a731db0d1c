//#use sanitize
// Twin of src/kernel/pack.rs: codes of numbers in stored words.

// Bits of the half nearest to `x` (ties to even), clamped to +-65504.
fn half_bits(x: f32) -> u32 {
    let sign_bit = (bitcast<u32>(x) >> 16u) & 0x8000u;
    let a = min(bitcast<u32>(x) & 0x7fffffffu, bitcast<u32>(MAX_HALF));
    let small = bitcast<u32>(bitcast<f32>(a) + 0.5) - bitcast<u32>(0.5f);
    let rounded = (a - (112u << 23u) + 0xfffu + ((a >> 13u) & 1u)) >> 13u;
    return sign_bit | select(rounded, small, a < (113u << 23u));
}

// Value of the finite half in the low 16 bits of `bits`.
fn half_value(bits: u32) -> f32 {
    let magnitude = (bits & 0x7fffu) << 13u;
    let sign_bit = (bits & 0x8000u) << 16u;
    let normal = bitcast<f32>(magnitude + (112u << 23u));
    return bitcast<f32>(bitcast<u32>(min(normal, 2.0 * normal - 0x1p-14)) | sign_bit);
}

// 16-bit code of a disparity: 6 bits of exponent (2^-32 to 2^32) and 10 of mantissa, a relative error of at most 2^-11.
fn disparity_code(disparity: f32) -> u32 {
    if disparity < 0.0 {
        return 0xffffu;
    }
    let bits = bitcast<u32>(disparity) & 0x7fffffffu;
    if bits < (95u << 23u) {
        return 0u;
    }
    let rounded = (bits + 0x1000u) >> 13u;
    return clamp(rounded - min(rounded, 95u << 10u), 1u, 0xfffeu);
}

// Disparity of a 16-bit code; -1 for 0xffff, the unknown disparity.
fn disparity_value(code: u32) -> f32 {
    if code == 0u {
        return 0.0;
    }
    if code == 0xffffu {
        return -1.0;
    }
    return bitcast<f32>((code + (95u << 10u)) << 13u);
}

const TAP_RELATIVE: f32 = 0.1;
const LARGEST_DISPARITY: f32 = 1e30;

// The first of the `disparity_code`s from `low` to `high` times the disparity `expected`, and their number: 0 if the
// expected disparity is negative.
fn codes_between(expected: f32, low: f32, high: f32) -> vec2u {
    // The limit keeps compilers from merging these factors with those of the disparity.
    let limited = min(expected, LARGEST_DISPARITY);
    let first = disparity_code(limited * low);
    let last = disparity_code(limited * high);
    return vec2u(first, select(last - first + 1u, 0u, expected < 0.0));
}

// `codes_between` of the surface that has the disparity `expected`, within `TAP_RELATIVE`.
fn tap_codes(expected: f32) -> vec2u {
    return codes_between(expected, 1.0f - TAP_RELATIVE, 1.0f / (1.0f - TAP_RELATIVE));
}

// `tap_codes` for surfaces that have the disparities from `farthest` to `nearest`, both of them at least 0.
fn tap_codes_between(farthest: f32, nearest: f32) -> vec2u {
    let first = tap_codes(farthest);
    let last = tap_codes(nearest);
    return vec2u(first.x, max(last.x, first.x) - first.x + last.y);
}

// Whether the disparity in the high half of `word` is one of `codes_between`.
fn has_code(word: u32, codes: vec2u) -> bool {
    return (word >> 16u) - codes.x < codes.y;
}
