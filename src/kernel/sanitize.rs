//! Sanitizing of inputs. Non-finite numbers are found by their bits, because shading languages may assume that NaN does
//! not exist.

use glam::Vec3;

/// Largest finite half. Colors are clamped to it.
pub const MAX_HALF: f32 = 65504.0;

/// Smallest magnitude of a color channel, 2^-32: 1/256 of the smallest half. Products and squares of smaller ones would
/// be denormal, which devices may flush to zero.
pub const LEAST_COLOR: f32 = 1.0 / 4_294_967_296.0;

/// Whether a number is neither NaN nor infinite.
#[inline]
pub fn is_finite(x: f32) -> bool {
    x.to_bits() & 0x7f80_0000 != 0x7f80_0000
}

/// Color clamped to +-65504, with channels below [`LEAST_COLOR`] as 0, and whether it is usable; black and `false` if
/// any component is NaN or infinite.
#[inline]
pub fn color(c: Vec3) -> (Vec3, bool) {
    if is_finite(c.x) && is_finite(c.y) && is_finite(c.z) {
        let channel = |x: f32| if x.abs() >= LEAST_COLOR { x.clamp(-MAX_HALF, MAX_HALF) } else { 0.0 };
        (Vec3::new(channel(c.x), channel(c.y), channel(c.z)), true)
    } else {
        (Vec3::ZERO, false)
    }
}

/// Trust clamped to \[0, 1\]. NaN, negative numbers and denormals (which devices may flush to zero) count as 0.
#[inline]
pub fn trust(t: f32) -> f32 {
    // The bits of positive floats are ordered as the floats, infinity last and NaN beyond it.
    match t.to_bits() {
        0x0080_0000..0x3f80_0000 => t,
        0x3f80_0000..=0x7f80_0000 => 1.0,
        _ => 0.0,
    }
}

/// Weight or weight sum. NaN, infinity, negative numbers and denormals (which devices may flush to zero) count as 0.
#[inline]
pub fn weight(w: f32) -> f32 {
    if is_finite(w) && w >= f32::MIN_POSITIVE { w } else { 0.0 }
}
