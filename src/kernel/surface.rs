//! Storage of a surface sample in two words, by integer arithmetic, so that rounding is the same on every device.
//!
//! | word | bits | |
//! |---|---|---|
//! | 0 | 0-13 | red, [`half14_bits`] |
//! | 0 | 14-27 | green |
//! | 0 | 28-31 | level of detail, low 4 bits of its code |
//! | 1 | 0-13 | blue |
//! | 1 | 14-15 | level of detail, high 2 bits |
//! | 1 | 16-31 | disparity, [`disparity_code`] |
//!
//! Packing an unpacked sample gives the same words.

use super::pack::{disparity_code, disparity_value, half_bits, half_value};
use glam::{Vec3, Vec4};

/// Code of the level of detail of an empty texel.
const EMPTY: u32 = 63;

/// Stored steps a level of detail.
const LOD_STEPS: f32 = 7.0;

/// Largest stored level of detail.
pub const MAX_LOD: f32 = 62.0 / LOD_STEPS;

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

/// 14-bit float: a half without sign and without the last bit of its mantissa, that is 5 bits of exponent and 9 of
/// mantissa. Rounded twice (first to a half), so the relative error is at most 1.5 * 2^-10. Negative values become 0.
#[inline]
pub fn half14_bits(x: f32) -> u32 {
    let positive = if x > 0.0 { x } else { 0.0 };
    let h = half_bits(positive);
    ((h + ((h >> 1) & 1)) >> 1).min(0x3dff)
}

/// Value of the 14-bit float in the low bits of `bits`.
#[inline]
pub fn half14_value(bits: u32) -> f32 {
    half_value((bits & 0x3fff) << 1)
}

/// Packs a sample. The color must be finite.
#[inline]
pub fn pack_surface(s: Surface) -> [u32; 2] {
    let lod = if s.lod < 0.0 { EMPTY } else { (s.lod.min(MAX_LOD) * LOD_STEPS + 0.5) as u32 };
    [
        half14_bits(s.color.x) | half14_bits(s.color.y) << 14 | lod << 28,
        half14_bits(s.color.z) | (lod >> 4) << 14 | disparity_code(s.disparity) << 16,
    ]
}

/// Unpacks a sample. The result is finite for any words.
#[inline]
pub fn unpack_surface(words: [u32; 2]) -> Surface {
    let lod = words[0] >> 28 | ((words[1] >> 14) & 3) << 4;
    if lod == EMPTY {
        return Surface::EMPTY;
    }
    let channel = |bits: u32| half14_value((bits & 0x3fff).min(0x3dff));
    Surface {
        color: Vec3::new(channel(words[0]), channel(words[0] >> 14), channel(words[1])),
        lod: lod as f32 / LOD_STEPS,
        disparity: disparity_value(words[1] >> 16),
    }
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
