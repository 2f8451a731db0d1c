//! Levels of detail, and their codes in stored words.

/// Code of the level of detail of an empty texel.
pub const EMPTY_LOD: u32 = 0;

/// Stored steps a level of detail.
pub const LOD_STEPS: f32 = 7.0;

/// Largest stored level of detail.
pub const MAX_LOD: f32 = 62.0 * (1.0 / LOD_STEPS);
/// Levels of detail by which history may be coarser than the candidate and still be accumulated.
pub(super) const COARSER_WIDTH: f32 = 0.25;

/// Level of detail of a code. That of an empty texel is finite and has no meaning.
#[inline]
pub fn lod_value(code: u32) -> f32 {
    code.wrapping_sub(1) as f32 * (1.0 / LOD_STEPS)
}
