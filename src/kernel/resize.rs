//! History resampled to another size, for renderers that change their resolution from frame to frame.

use super::lod::MAX_LOD;

/// Position, in a row or column of `old_len` pixels, of pixel `x` of a row or column of the new length. `ratio`: old
/// length over new length.
#[inline]
pub fn old_position(x: u32, ratio: f32, old_len: u32) -> f32 {
    ((x as f32 + 0.5) * ratio - 0.5).clamp(0.0, (old_len - 1) as f32)
}

/// Level of detail after resizing: log2 of the block edge in new pixels. `shift`: log2 of new length over old length.
#[inline]
pub fn resized_lod(lod: f32, shift: f32) -> f32 {
    (lod + shift).clamp(0.0, MAX_LOD)
}
