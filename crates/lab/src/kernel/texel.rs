//! Texture addressing: wrap modes and texel decoding.

use glam::Vec4;

/// Wrap mode: repeat.
pub const WRAP_REPEAT: u32 = 0;
/// Wrap mode: mirrored repeat.
pub const WRAP_MIRROR: u32 = 1;
/// Wrap mode: clamp to edge.
pub const WRAP_CLAMP: u32 = 2;

/// Texture coordinate reduced to one period: \[0, 1\], or \[0, 2\] for mirrored repeat.
#[inline]
pub fn wrap_coordinate(u: f32, wrap: u32) -> f32 {
    match wrap {
        WRAP_REPEAT => u - u.floor(),
        WRAP_MIRROR => u - 2.0 * (u * 0.5).floor(),
        _ => u.clamp(0.0, 1.0),
    }
}

/// Texel index at position `i`, which ranges from -1 to one past the period.
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

/// Red, green, blue and alpha in \[0, 1\] of a packed texel, red in the lowest byte.
#[inline]
pub fn texel_value(bits: u32) -> Vec4 {
    let byte = |shift: u32| ((bits >> shift) & 255) as f32;
    Vec4::new(byte(0), byte(8), byte(16), byte(24)) * (1.0 / 255.0)
}
