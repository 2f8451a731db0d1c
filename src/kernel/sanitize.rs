//! Non-finite numbers, found by their bits: shading languages may assume that NaN does not exist.

use glam::Vec3;

/// Largest finite half-float. Colors are kept within it.
pub const MAX_HALF: f32 = 65504.0;

/// Neither NaN nor infinite.
#[inline]
pub fn is_finite(x: f32) -> bool {
    x.to_bits() & 0x7f80_0000 != 0x7f80_0000
}

/// A color clamped to +-65504, and whether it may be used: false, and black, if any component is NaN or infinite.
#[inline]
pub fn color(c: Vec3) -> (Vec3, bool) {
    if is_finite(c.x) && is_finite(c.y) && is_finite(c.z) {
        let limit = Vec3::splat(MAX_HALF);
        (c.clamp(-limit, limit), true)
    } else {
        (Vec3::ZERO, false)
    }
}

/// A trust: at least 0 and at most 1. What is NaN, below 0 or so small that hardware may flush it to zero counts as 0.
#[inline]
pub fn trust(t: f32) -> f32 {
    // Positive floats are in the order of their bits, infinity last and NaNs beyond it.
    match t.to_bits() {
        0x0080_0000..0x3f80_0000 => t,
        0x3f80_0000..=0x7f80_0000 => 1.0,
        _ => 0.0,
    }
}

/// A weight or weight sum: what is NaN, infinite, negative or so small that hardware may flush it to zero counts as 0.
#[inline]
pub fn weight(w: f32) -> f32 {
    if is_finite(w) && w >= f32::MIN_POSITIVE { w } else { 0.0 }
}
