//#use pack
//#use sanitize
// Twin of src/kernel/stored_reservoir.rs: storage of a reservoir in three words, whose layout is documented there.

const MAX_W_SUM: f32 = 0x1p100;
const MAX_AGE: u32 = 255u;
const EMPTY_WORDS: vec3u = vec3u(0x7c00u, 0xffff0000u, 0u);

struct Stored {
    color: vec3f,
    disparity: f32,
    w_sum: f32,
    age: u32,
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
