//! Storage of a reservoir in three words, by integer arithmetic, so that rounding is the same on every device.
//!
//! | word | low 16 bits | high 16 bits |
//! |---|---|---|
//! | 0 | red, half | green, half |
//! | 1 | blue, half | disparity, [`disparity_code`] |
//! | 2 | bits 0-7: age in frames, stays at 255 | bits 8-31: weight sum, the upper 24 bits of its float |
//!
//! All zeros are an empty reservoir. The weight sum keeps 16 significant bits: for a stream of constant weight w under
//! Bernoulli survival it stops growing between 256 w and 363 w, so that the probability of replacement never falls
//! below 1/364 a frame. A half would stop at 63 w, and at 33 w with half arithmetic.

use super::pack::{disparity_code, disparity_value, half_bits, half_value};
use super::sanitize::{self, MAX_HALF};
use glam::Vec3;

/// Largest stored weight sum: 2^100, exact in the stored bits.
pub const MAX_W_SUM: f32 = f32::from_bits((127 + 100) << 23);

/// Largest stored age, in frames.
pub const MAX_AGE: u32 = 255;

/// Contents of a stored reservoir.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stored {
    /// The sample: linear color.
    pub color: Vec3,
    /// Disparity of the sample's surface in the frame that stored it; negative: unknown.
    pub disparity: f32,
    /// Weight sum of the reservoir; 0: empty.
    pub w_sum: f32,
    /// Frames since the sample was shaded.
    pub age: u32,
}

/// Packs a reservoir. The color must be finite.
#[inline]
pub fn pack(s: Stored) -> [u32; 3] {
    // Not clamp(): devices differ on the sign of clamp(-0).
    let w_sum = if s.w_sum > 0.0 { s.w_sum.min(MAX_W_SUM) } else { 0.0 };
    let w = w_sum.to_bits();
    let w_upper = w + 0x7f + ((w >> 8) & 1);
    [
        half_bits(s.color.x) | half_bits(s.color.y) << 16,
        half_bits(s.color.z) | disparity_code(s.disparity) << 16,
        (w_upper & 0xffff_ff00) | s.age.min(MAX_AGE),
    ]
}

/// Words of an empty reservoir whose color is an infinite half, so that passes that read colors alone recognise it as
/// empty.
pub const EMPTY_WORDS: [u32; 3] = [0x7c00, 0xffff_0000, 0];

/// Color and disparity from the first two words of a reservoir, and whether the color is valid.
#[inline]
pub fn unpack_sample(words: [u32; 2]) -> (Vec3, f32, bool) {
    let color = Vec3::new(half_value(words[0]), half_value(words[0] >> 16), half_value(words[1]));
    // Infinity and NaN decode to numbers above the largest half.
    let largest = color.x.abs().max(color.y.abs()).max(color.z.abs());
    (color, disparity_value(words[1] >> 16), largest <= MAX_HALF)
}

/// Unpacks a reservoir. The result is finite for any words; a corrupt color or weight sum gives an empty reservoir.
#[inline]
pub fn unpack(words: [u32; 3]) -> Stored {
    let (color, disparity, valid) = unpack_sample([words[0], words[1]]);
    let w_sum = sanitize::weight(f32::from_bits(words[2] & 0xffff_ff00));
    if !valid || w_sum > MAX_W_SUM {
        return Stored { color: Vec3::ZERO, disparity: -1.0, w_sum: 0.0, age: 0 };
    }
    Stored { color, disparity, w_sum, age: words[2] & 0xff }
}
