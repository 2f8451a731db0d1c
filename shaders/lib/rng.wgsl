// Twin of src/kernel/rng.rs.

const PURPOSE_SELECT: u32 = 0u;
const PURPOSE_KEY: u32 = 1u;
const PURPOSE_PATH: u32 = 2u;

// Jarzynski and Olano, JCGT 9(3), 2020.
fn pcg4d(input: vec4u) -> vec4u {
    var v = input * 1664525u + 1013904223u;
    v = pcg4d_mix(v);
    v = v ^ (v >> vec4u(16u));
    return pcg4d_mix(v);
}

// `mix` in Rust, which is a builtin of WGSL.
fn pcg4d_mix(input: vec4u) -> vec4u {
    var v = input;
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    return v;
}

// 64-bit numbers are pairs of low and high word.
fn stream_key(seed: vec2u, view: u32, purpose: u32, frame: vec2u) -> u32 {
    return pcg4d(vec4u(seed.x, seed.y, frame.y, (purpose << 16u) ^ view)).x;
}

// 32 random bits for pixel (`x`, `y`) of the frame whose counter's low word is `frame`.
fn bits(x: u32, y: u32, frame: u32, key: u32) -> u32 {
    return pcg4d(vec4u(x, y, frame, key)).x;
}

// In [0, 1) on the grid of 2^-24.
fn unit_draw(bits: u32) -> f32 {
    return f32(bits >> 8u) * (1.0 / 16777216.0);
}

// Four uniform numbers in [0, 1) for dimension `dimension` of path `sample` of a pixel (x in the low, y in the high 16
// bits).
fn path_draws(pixel: u32, sample: u32, dimension: u32, key: u32) -> vec4f {
    let words = pcg4d(vec4u(pixel, sample, dimension, key));
    return vec4f(unit_draw(words.x), unit_draw(words.y), unit_draw(words.z), unit_draw(words.w));
}
