//! From texture coordinates to texels: wrapping, the four texels around a point, their bytes.

use glam::Vec4;

/// The image again beyond its edge.
pub const WRAP_REPEAT: u32 = 0;
/// The image again, every second time reversed.
pub const WRAP_MIRROR: u32 = 1;
/// The texel at the edge.
pub const WRAP_CLAMP: u32 = 2;

/// `u` within one period of its wrapping: \[0, 1\], of mirrored images \[0, 2\].
#[inline]
pub fn wrap_coordinate(u: f32, wrap: u32) -> f32 {
    match wrap {
        WRAP_REPEAT => u - u.floor(),
        WRAP_MIRROR => u - 2.0 * (u * 0.5).floor(),
        _ => u.clamp(0.0, 1.0),
    }
}

/// The texel that place `i` of one period shows, `i` from -1 (the neighbour on the left) to one past the period.
#[inline]
pub fn wrap_texel(i: i32, size: u32, wrap: u32) -> u32 {
    let n = size as i32;
    let j = match wrap {
        WRAP_REPEAT => (i + n) % n,
        WRAP_MIRROR if i < 0 || i >= 2 * n => 0,
        WRAP_MIRROR if i >= n => 2 * n - 1 - i,
        WRAP_MIRROR => i,
        _ => i.clamp(0, n - 1),
    };
    j as u32
}

/// Red, green, blue and alpha in \[0, 1\] of a texel's bytes, red lowest.
#[inline]
pub fn texel_value(bits: u32) -> Vec4 {
    let byte = |shift: u32| ((bits >> shift) & 255) as f32;
    Vec4::new(byte(0), byte(8), byte(16), byte(24)) / 255.0
}
