//! Evidence on the inputs of a renderer, tile by tile: the prediction errors of hypotheses on its motion vectors and
//! distances, and the fineness of the frame's detail. Words of a tile are integers, so that their sums do not depend on
//! the order of the pixels.

use super::sanitize;

/// Side of a tile in pixels.
pub const TILE_PX: u32 = 16;
/// Number of hypotheses on motion vectors.
pub const HYPOTHESES: u32 = 25;
/// Number of hypotheses on distances.
pub const DISTANCES: u32 = 7;
/// Classes of boundaries between pixels: multiples of 1, 2, 4, 8, and 16 or more.
pub const BOUNDARIES: u32 = 5;
/// Classes of kinks: those of boundaries without the first.
pub const KINKS: u32 = 4;
/// Second differences over 2, 4 and 8 pixels.
pub const WIDE: u32 = 3;
/// Depths of a tile: its middle, and left, right, above and below of it.
pub const DEPTHS: u32 = 5;
/// Distance in pixels of the other depths from the middle one.
pub const DEPTH_STEP_PX: u32 = 6;

/// Word of a tile: number of samples with a motion vector.
pub const MATCHED: u32 = 0;
/// Word of a tile: errors of the hypotheses.
pub const ERRORS: u32 = 1;
/// Word of a tile: number of samples at a known, finite distance.
pub const PLACED: u32 = ERRORS + HYPOTHESES;
/// Word of a tile: errors of the hypotheses on distances.
pub const DISTANCE_ERRORS: u32 = PLACED + 1;
/// Word of a tile: differences of neighbouring pixels, by class of the boundary between them.
pub const STEPS: u32 = DISTANCE_ERRORS + DISTANCES;
/// Word of a tile: second differences of neighbouring pixels, by class of the kink that they may straddle.
pub const BENDS: u32 = STEPS + BOUNDARIES;
/// Word of a tile: the same, of the sRGB-decoded frame.
pub const DECODED_BENDS: u32 = BENDS + KINKS;
/// Word of a tile: second differences over 2, 4 and 8 pixels.
pub const WIDE_BENDS: u32 = DECODED_BENDS + KINKS;
/// Word of a tile: sum of the signal, each at most 1.
pub const SIGNAL: u32 = WIDE_BENDS + WIDE;
/// Word of a tile: number of pixels whose value is an 8-bit code.
pub const CODES: u32 = SIGNAL + 1;
/// Word of a tile: number of pixels that are not finite.
pub const BROKEN: u32 = CODES + 1;
/// Number of words that are sums over a tile.
pub const SUMS: u32 = BROKEN + 1;
/// Word of a tile: stored depths, as bits.
pub const DEPTH: u32 = SUMS;
/// Word of a tile: stored motion vector in the middle, as bits.
pub const MOTION: u32 = DEPTH + DEPTHS;
/// Number of words of a tile.
pub const WORDS: u32 = MOTION + 2;

/// Largest signal; brighter pixels are clamped to it.
pub const MAX_SIGNAL: f32 = 64.0;
/// Largest component of a stored motion vector; larger ones are clamped to it.
pub const MAX_STORED_MOTION: f32 = 65536.0;

/// Signal of a pixel: its green channel, which is most of its luma. Unlike luma, a single channel can be averaged and
/// decoded by itself. 0, or from 1e-30 to 64; 0 for numbers that are not finite.
#[inline]
pub fn signal(green: f32) -> f32 {
    if sanitize::is_finite(green) && green >= 1e-30 { green.min(MAX_SIGNAL) } else { 0.0 }
}

/// Root of the mean signal of 2x2 pixels, which is about perceived brightness.
#[inline]
pub fn root_mean(a: f32, b: f32, c: f32, d: f32) -> f32 {
    ((a + b + c + d) * 0.25).sqrt()
}

/// First texel along an axis at which a lattice of spacing 2^level is sampled: the middle of its block.
#[inline]
pub fn lattice_offset(level: u32) -> u32 {
    (1 << level) >> 1
}

/// Number of lattice points along `len` texels, at least 1.
#[inline]
pub fn lattice_len(len: u32, level: u32) -> u32 {
    (((len.max(1) - 1).max(lattice_offset(level)) - lattice_offset(level)) >> level) + 1
}

/// Coordinate `x` in texels, in lattice points of `level`.
#[inline]
pub fn lattice_coordinate(x: f32, level: u32) -> f32 {
    let points_per_texel = f32::from_bits((127 - level) << 23);
    (x - lattice_offset(level) as f32) * points_per_texel
}

/// Texel of lattice point `point` along `len` texels.
#[inline]
pub fn lattice_texel(point: u32, level: u32, len: u32) -> u32 {
    ((point << level) + lattice_offset(level)).min(len.max(1) - 1)
}

/// Linear interpolation: `a` for `t` = 0, `b` for 1.
#[inline]
pub fn interpolate(a: f32, b: f32, t: f32) -> f32 {
    a + (b - a) * t
}

/// Uniform cubic B-spline of four values at equal distances, at fraction `t` from the second to the third, by de Boor's
/// algorithm. It consists of interpolations only, whose order no compiler changes. The spline smooths: plain
/// interpolation of point samples would favor short vectors, because it follows aliasing on the lattice.
#[inline]
pub fn spline(values: [f32; 4], t: f32) -> f32 {
    let [a, b, c, d] = values;
    let first = interpolate(a, b, (t + 2.0) * (1.0 / 3.0));
    let second = interpolate(b, c, (t + 1.0) * (1.0 / 3.0));
    let third = interpolate(c, d, t * (1.0 / 3.0));
    interpolate(interpolate(first, second, (t + 1.0) * 0.5), interpolate(second, third, t * 0.5), t)
}

/// Factor on the disparities as described, of hypothesis `index` on distances: 1/8, 1/4, 1/2, 1, 2, 4 and 8.
#[inline]
pub fn disparity_factor(index: u32) -> f32 {
    (1_u32 << index) as f32 * 0.125
}

/// Component of a stored motion vector, limited in length.
#[inline]
pub fn stored_motion(component: f32) -> f32 {
    component.clamp(-MAX_STORED_MOTION, MAX_STORED_MOTION)
}

/// A difference, at least 0, as an integer that can be summed: multiples of 2^-20, at most 2^20.
#[inline]
pub fn fixed(difference: f32) -> u32 {
    (difference.min(1.0) * 1_048_576.0 + 0.5) as u32
}

/// Class of the boundary between the pixels `at - 1` and `at`: the largest power of two that divides `at`, as its
/// logarithm, at most 4. In a frame of blocks of 2^l, pixels differ only across boundaries of class l and above.
#[inline]
pub fn boundary_class(at: u32) -> u32 {
    at.trailing_zeros().min(BOUNDARIES - 1)
}

/// Class of the kink that the pixels `at - 1` to `at + 1` may straddle: one less than the class of that boundary of
/// pixel `at` whose position is even. A frame that interpolates between the middles of blocks of 2^l (l >= 2) has kinks
/// of class l - 2 only.
#[inline]
pub fn kink_class(at: u32) -> u32 {
    boundary_class(at + (at & 1)) - 1
}

/// Second difference of three values at equal distances, at least 0.
#[inline]
pub fn bend(before: f32, at: f32, after: f32) -> f32 {
    ((after - at) - (at - before)).abs()
}

/// Whether a signal is an 8-bit code from 1 to 254.
#[inline]
pub fn is_code(signal: f32) -> bool {
    let code = signal * 255.0;
    let whole = (code + 0.5).floor();
    (code - whole).abs() <= 0.015625 && (1.0..=254.0).contains(&whole)
}

/// Bits of a stored number for the rules. Every NaN becomes the same NaN, both infinities become one, and numbers below
/// the normal range (which devices may flush to zero) become zero.
#[inline]
pub fn kept_bits(stored: f32) -> u32 {
    let bits = stored.to_bits();
    let size = bits & 0x7fff_ffff;
    if size > 0x7f80_0000 {
        0x7fc0_0000
    } else if size < 0x0080_0000 {
        0
    } else {
        bits
    }
}
