//! Size of the room.

/// Half the room's width along x, metres.
pub(super) const HALF_WIDTH_M: f32 = 2.6;
/// Half the room's depth along z, metres. The window is in the wall at -z.
pub(super) const HALF_DEPTH_M: f32 = 3.2;
/// Height of the ceiling, metres.
pub(super) const HEIGHT_M: f32 = 2.6;
