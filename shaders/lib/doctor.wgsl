//#use sanitize
// Twin of src/kernel/doctor.rs, which explains the words.

const TILE_PX: u32 = 16u;
const HYPOTHESES: u32 = 25u;
const DISTANCES: u32 = 7u;
const BOUNDARIES: u32 = 5u;
const KINKS: u32 = 4u;
const WIDE: u32 = 3u;
const DEPTHS: u32 = 5u;
const DEPTH_STEP_PX: u32 = 6u;

const MATCHED: u32 = 0u;
const ERRORS: u32 = 1u;
const PLACED: u32 = ERRORS + HYPOTHESES;
const DISTANCE_ERRORS: u32 = PLACED + 1u;
const STEPS: u32 = DISTANCE_ERRORS + DISTANCES;
const BENDS: u32 = STEPS + BOUNDARIES;
const DECODED_BENDS: u32 = BENDS + KINKS;
const WIDE_BENDS: u32 = DECODED_BENDS + KINKS;
const SIGNAL: u32 = WIDE_BENDS + WIDE;
const CODES: u32 = SIGNAL + 1u;
const BROKEN: u32 = CODES + 1u;
const SUMS: u32 = BROKEN + 1u;
const DEPTH: u32 = SUMS;
const MOTION: u32 = DEPTH + DEPTHS;
const WORDS: u32 = MOTION + 2u;

const MAX_SIGNAL: f32 = 64.0;
const MAX_STORED_MOTION: f32 = 65536.0;

// Signal of a pixel: its green channel, which is most of its luma.
fn signal(green: f32) -> f32 {
    if is_finite(green) && green >= 1e-30 {
        return min(green, MAX_SIGNAL);
    }
    return 0.0;
}

// Root of the mean signal of 2x2 pixels, which is about perceived brightness.
fn root_mean(a: f32, b: f32, c: f32, d: f32) -> f32 {
    return sqrt((a + b + c + d) * 0.25);
}

// First texel along an axis at which a lattice of spacing 2^level is sampled: the middle of its block.
fn lattice_offset(level: u32) -> u32 {
    return (1u << level) >> 1u;
}

// Number of lattice points along `len` texels, at least 1.
fn lattice_len(len: u32, level: u32) -> u32 {
    return ((max(max(len, 1u) - 1u, lattice_offset(level)) - lattice_offset(level)) >> level) + 1u;
}

// Coordinate `x` in texels, in lattice points of `level`.
fn lattice_coordinate(x: f32, level: u32) -> f32 {
    let points_per_texel = bitcast<f32>((127u - level) << 23u);
    return (x - f32(lattice_offset(level))) * points_per_texel;
}

// Texel of lattice point `point` along `len` texels.
fn lattice_texel(point: u32, level: u32, len: u32) -> u32 {
    return min((point << level) + lattice_offset(level), max(len, 1u) - 1u);
}

// Linear interpolation: `a` for `t` = 0, `b` for 1.
fn interpolate(a: f32, b: f32, t: f32) -> f32 {
    return a + (b - a) * t;
}

// Uniform cubic B-spline of four values at equal distances, at fraction `t` from the second to the third, by de Boor's
// algorithm.
fn spline(values: vec4f, t: f32) -> f32 {
    let first = interpolate(values.x, values.y, (t + 2.0) * (1.0f / 3.0f));
    let second = interpolate(values.y, values.z, (t + 1.0) * (1.0f / 3.0f));
    let third = interpolate(values.z, values.w, t * (1.0f / 3.0f));
    return interpolate(interpolate(first, second, (t + 1.0) * 0.5), interpolate(second, third, t * 0.5), t);
}

// Factor on the disparities as described, of hypothesis `index` on distances: 1/8, 1/4, 1/2, 1, 2, 4 and 8.
fn disparity_factor(index: u32) -> f32 {
    return f32(1u << index) * 0.125;
}

// Component of a stored motion vector, limited in length.
fn stored_motion(component: f32) -> f32 {
    return clamp(component, -MAX_STORED_MOTION, MAX_STORED_MOTION);
}

// A difference, at least 0, as an integer that can be summed: multiples of 2^-20, at most 2^20.
fn fixed(difference: f32) -> u32 {
    return u32(min(difference, 1.0) * 1048576.0 + 0.5);
}

// Class of the boundary between the pixels `at - 1` and `at`: the largest power of two that divides `at`, as its
// logarithm, at most 4.
fn boundary_class(at: u32) -> u32 {
    return min(countTrailingZeros(at), BOUNDARIES - 1u);
}

// Class of the kink that the pixels `at - 1` to `at + 1` may straddle: one less than the class of that boundary of
// pixel `at` whose position is even.
fn kink_class(at: u32) -> u32 {
    return boundary_class(at + (at & 1u)) - 1u;
}

// Second difference of three values at equal distances, at least 0.
fn bend(before: f32, at: f32, after: f32) -> f32 {
    return abs((after - at) - (at - before));
}

// Whether a signal is an 8-bit code from 1 to 254.
fn is_code(signal: f32) -> bool {
    let code = signal * 255.0;
    let whole = floor(code + 0.5);
    return abs(code - whole) <= 0.015625 && whole >= 1.0 && whole <= 254.0;
}

// Bits of a stored number for the rules.
fn kept_bits(stored: f32) -> u32 {
    let bits = bitcast<u32>(stored);
    let size = bits & 0x7fffffffu;
    if size > 0x7f800000u {
        return 0x7fc00000u;
    }
    return select(bits, 0u, size < 0x00800000u);
}
