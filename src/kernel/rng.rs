//! Counter-based random numbers: a hash of (x, y, frame, stream), without state.

/// Purpose of a random stream. Streams of different purposes are independent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum Purpose {
    /// Choice between a reservoir's sample and the candidate (A-Chao).
    Select = 0,
    /// Key of a candidate (A-ES).
    Key = 1,
    /// Path tracing.
    Path = 2,
}

/// PCG-4D (Jarzynski and Olano, "Hash Functions for GPU Rendering", JCGT 9(3), 2020): a bijection of four words in
/// which every output bit depends on every input bit.
#[inline]
pub fn pcg4d(mut v: [u32; 4]) -> [u32; 4] {
    for x in &mut v {
        *x = x.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
    }
    mix(&mut v);
    for x in &mut v {
        *x ^= *x >> 16;
    }
    mix(&mut v);
    v
}

#[inline]
fn mix(v: &mut [u32; 4]) {
    v[0] = v[0].wrapping_add(v[1].wrapping_mul(v[3]));
    v[1] = v[1].wrapping_add(v[2].wrapping_mul(v[0]));
    v[2] = v[2].wrapping_add(v[0].wrapping_mul(v[1]));
    v[3] = v[3].wrapping_add(v[1].wrapping_mul(v[2]));
}

/// Key of a random stream: a hash of everything that is constant over one view of a frame, except the low word of the
/// 64-bit frame counter. When that word wraps, the key changes.
#[inline]
pub fn stream_key(seed: u64, view: u32, purpose: Purpose, frame: u64) -> u32 {
    let context = [seed as u32, (seed >> 32) as u32, (frame >> 32) as u32, (purpose as u32) << 16 ^ view];
    pcg4d(context)[0]
}

/// 32 random bits for pixel (`x`, `y`) of the frame whose counter's low word is `frame`.
#[inline]
pub fn bits(x: u32, y: u32, frame: u32, key: u32) -> u32 {
    pcg4d([x, y, frame, key])[0]
}

/// Uniform number in \[0, 1) on the grid of 2^-24. Dropping 8 bits first matters: `u32 as f32 * 2^-32` rounds its top
/// 128 values to 1.
#[inline]
pub fn unit_draw(bits: u32) -> f32 {
    (bits >> 8) as f32 * (1.0 / 16_777_216.0)
}

/// Four uniform numbers in \[0, 1) for dimension `dimension` of path `sample` of a pixel (x in the low, y in the high
/// 16 bits).
#[inline]
pub fn path_draws(pixel: u32, sample: u32, dimension: u32, key: u32) -> [f32; 4] {
    pcg4d([pixel, sample, dimension, key]).map(unit_draw)
}
