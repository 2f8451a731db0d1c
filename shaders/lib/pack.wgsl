//#use sanitize
// Twin of src/kernel/pack.rs: storage of a reservoir in three words, whose layout is documented there.

const MAX_W_SUM: f32 = 0x1p100;
const MAX_AGE: u32 = 255u;
const EMPTY_WORDS: vec3u = vec3u(0x7c00u, 0xffff0000u, 0u);

struct Stored {
    color: vec3f,
    disparity: f32,
    w_sum: f32,
    age: u32,
}

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

// Packs a reservoir.
fn pack(s: Stored) -> vec3u {
    let w = bitcast<u32>(select(0.0, min(s.w_sum, MAX_W_SUM), s.w_sum > 0.0));
    let w_upper = w + 0x7fu + ((w >> 8u) & 1u);
    return vec3u(
        half_bits(s.color.x) | (half_bits(s.color.y) << 16u),
        half_bits(s.color.z) | (disparity_code(s.disparity) << 16u),
        (w_upper & 0xffffff00u) | min(s.age, MAX_AGE),
    );
}

struct StoredColor {
    color: vec3f,
    disparity: f32,
    valid: bool,
}

// Color and disparity from the first two words of a reservoir, and whether the color is valid.
fn unpack_sample(words: vec2u) -> StoredColor {
    let stored_color = vec3f(half_value(words.x), half_value(words.x >> 16u), half_value(words.y));
    // Infinity and NaN decode to numbers above the largest half.
    let largest = max(max(abs(stored_color.x), abs(stored_color.y)), abs(stored_color.z));
    return StoredColor(stored_color, disparity_value(words.y >> 16u), largest <= MAX_HALF);
}

// Unpacks a reservoir.
fn unpack(words: vec3u) -> Stored {
    let stored = unpack_sample(words.xy);
    let w_sum = weight(bitcast<f32>(words.z & 0xffffff00u));
    if !stored.valid || w_sum > MAX_W_SUM {
        return Stored(vec3f(0.0), -1.0, 0.0, 0u);
    }
    return Stored(stored.color, stored.disparity, w_sum, words.z & 0xffu);
}
