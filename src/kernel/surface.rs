//! Storage of a surface sample in two words, by integer arithmetic, so that rounding is the same on every device.
//!
//! | word | bits | |
//! |---|---|---|
//! | 0 | 0-13 | red, [`float14_bits`] |
//! | 0 | 14-27 | green |
//! | 0 | 28-31 | level of detail, low 4 bits of its code: 0 for an empty texel, otherwise 1 + 7 x level |
//! | 1 | 0-13 | blue |
//! | 1 | 14-15 | level of detail, high 2 bits |
//! | 1 | 16-31 | disparity, [`disparity_code`] |
//!
//! Packing an unpacked sample gives the same words. All zeros are an empty texel, as textures are before anything is
//! written to them.

use super::lod::{EMPTY_LOD, LOD_STEPS, MAX_LOD, lod_value};
use super::pack::{disparity_code, disparity_value, half_bits, half_value};
use glam::{Vec3, Vec4};

/// Words of an empty texel, with the code of an unknown disparity.
const EMPTY_SURFACE: [u32; 2] = [0, 0xffff_0000];

/// Largest 14-bit float.
pub const MAX_FLOAT14: f32 = 65472.0;

/// Stored sample of a surface point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// Linear color, at least 0.
    pub color: Vec3,
    /// Level of detail that the sample was shaded at: log2 of the block edge in pixels. Negative: the texel is empty.
    pub lod: f32,
    /// Disparity in the frame that stored it; negative: unknown.
    pub disparity: f32,
}

impl Surface {
    /// Empty texel.
    pub const EMPTY: Self = Self { color: Vec3::ZERO, lod: -1.0, disparity: -1.0 };
}

/// 14-bit float nearest to `x` (ties to even), at most [`MAX_FLOAT14`]: 5 bits of exponent and 9 of mantissa, without
/// sign, infinity and NaN. The codes of infinity and NaN represent one more octave of numbers. The relative error is at
/// most 2^-10 down to 2^-15, and below that the error is at most 2^-25. Negative values become 0.
#[inline]
pub fn float14_bits(x: f32) -> u32 {
    let a = if x > 0.0 { x.min(MAX_FLOAT14) } else { 0.0 }.to_bits();
    if a < 112 << 23 {
        // Adding 0.5 shifts the mantissa to the grid of denormal numbers and rounds it.
        return (f32::from_bits(a) + 0.5).to_bits() - 0.5_f32.to_bits();
    }
    (a - (111 << 23) + 0x1fff + ((a >> 14) & 1)) >> 14
}

/// Value of a 14-bit float, which is a half, too.
#[inline]
pub fn float14_value(code: u32) -> f32 {
    let normal = f32::from_bits((code << 14) + (111 << 23));
    // Denormal numbers have no leading one bit: their value is the second operand, which is then the smaller one.
    // Neither operand is a 32-bit denormal, which devices may flush to zero.
    normal.min(2.0 * normal - f32::from_bits(112 << 23))
}

/// Packs a sample. The color must be finite. All empty texels are stored alike, with an unknown disparity.
#[inline]
pub fn pack_surface(s: Surface) -> [u32; 2] {
    if s.lod < 0.0 {
        return EMPTY_SURFACE;
    }
    let lod = (s.lod.min(MAX_LOD) * LOD_STEPS + 1.5) as u32;
    [
        float14_bits(s.color.x) | float14_bits(s.color.y) << 14 | lod << 28,
        float14_bits(s.color.z) | (lod >> 4) << 14 | disparity_code(s.disparity) << 16,
    ]
}

/// Code of the level of detail; [`EMPTY_LOD`] for an empty texel.
#[inline]
pub fn lod_code(words: [u32; 2]) -> u32 {
    words[0] >> 28 | ((words[1] >> 10) & 0x30)
}

/// Color of a sample.
#[inline]
pub fn surface_color(words: [u32; 2]) -> Vec3 {
    let channel = |bits: u32| float14_value(bits & 0x3fff);
    Vec3::new(channel(words[0]), channel(words[0] >> 14), channel(words[1]))
}

/// Unpacks a sample. The result is finite for any words.
#[inline]
pub fn unpack_surface(words: [u32; 2]) -> Surface {
    let lod = lod_code(words);
    if lod == EMPTY_LOD {
        return Surface::EMPTY;
    }
    Surface { color: surface_color(words), lod: lod_value(lod), disparity: disparity_value(words[1] >> 16) }
}

/// Texel of level 0 of the mip chain: the color and a coverage of 1; zeros for an empty texel.
#[inline]
pub fn mip_texel(words: [u32; 2]) -> Vec4 {
    let s = unpack_surface(words);
    if s.lod < 0.0 { Vec4::ZERO } else { s.color.extend(1.0) }
}

/// Rounds a texel of the mip chain to halves before it is stored, so that rounding is the same on every device.
#[inline]
pub fn round_mip(v: Vec4) -> Vec4 {
    let round = |x: f32| half_value(half_bits(x));
    Vec4::new(round(v.x), round(v.y), round(v.z), round(v.w))
}
