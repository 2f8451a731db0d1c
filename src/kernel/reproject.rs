//! Reprojection: where a pixel was in the previous frame, and verdicts on its history.

use super::sanitize::is_finite;

/// Largest motion in pixels; beyond it a vector is invalid.
pub const MAX_MOTION_PX: f32 = 65536.0;

/// Verdict on a pixel's history: valid, or the reason why it is missing or rejected. The discriminants are the codes of debug views.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
#[non_exhaustive]
pub enum Verdict {
    /// History is valid: it belongs to this surface.
    Valid = 0,
    /// All history was reset: first frame, cut, resize.
    Reset = 1,
    /// The motion vector is NaN, infinite or longer than 65536 pixels.
    BadMotion = 2,
    /// The surface point was outside the previous frame.
    OffScreen = 3,
    /// Nothing usable was stored there.
    Empty = 4,
    /// Another surface was there: the depth differs.
    Disoccluded = 5,
    /// The frame's trust mask is 0 here.
    Distrusted = 6,
}

impl Verdict {
    /// Number of verdicts; codes are below it.
    pub const COUNT: usize = 7;

    /// Verdicts that reject a history that may have existed.
    pub const REJECTED: [Self; 4] = [Self::BadMotion, Self::OffScreen, Self::Disoccluded, Self::Distrusted];
}

/// The texel that holds the history of pixel (`x`, `y`): nearest to where it was. A position is inside the previous frame
/// from half a pixel before the first centre to just under half a pixel after the last.
///
/// # Errors
/// [`Verdict::BadMotion`] or [`Verdict::OffScreen`].
#[inline]
pub fn nearest(x: u32, y: u32, motion: [f32; 2], size: [u32; 2]) -> Result<[u32; 2], Verdict> {
    let [mx, my] = motion;
    if !(is_finite(mx) && is_finite(my)) || mx.abs() > MAX_MOTION_PX || my.abs() > MAX_MOTION_PX {
        return Err(Verdict::BadMotion);
    }
    let qx = (x as f32 + mx + 0.5).floor();
    let qy = (y as f32 + my + 0.5).floor();
    if qx >= 0.0 && qy >= 0.0 && qx < size[0] as f32 && qy < size[1] as f32 {
        Ok([qx as u32, qy as u32])
    } else {
        Err(Verdict::OffScreen)
    }
}
