//! Reprojection: a pixel's position in the previous frame, and verdicts on its history.

/// Largest valid component of a motion vector, in pixels.
pub const MAX_MOTION_PX: f32 = 65536.0;

/// Verdict on a pixel's history: valid, or the reason why it is missing or rejected.
///
/// [`FrameStats::verdicts`](crate::FrameStats::verdicts) counts pixels by verdict, with the discriminant as index (an
/// example is at [`FrameStats`](crate::FrameStats)); [`DebugView::Rejection`](crate::DebugView::Rejection) draws them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
#[non_exhaustive]
pub enum Verdict {
    /// History is valid: it belongs to this surface.
    Valid = 0,
    /// History is empty: first frame, [`Reset::All`](crate::Reset::All), resize.
    Reset = 1,
    /// The motion vector is NaN, infinite, or has a component beyond 65536 pixels.
    BadMotion = 2,
    /// The surface point was outside the previous frame.
    OffScreen = 3,
    /// Nothing usable was stored at the previous position.
    Empty = 4,
    /// Disocclusion: another surface was at the previous position (depth differs), or motion vectors of two surfaces
    /// are mixed.
    Disoccluded = 5,
    /// The frame's trust mask is 0 at this pixel.
    Distrusted = 6,
}

impl Verdict {
    /// Number of verdicts; every discriminant is below it.
    pub const COUNT: usize = 7;

    /// Verdicts that reject existing history.
    pub const REJECTED: [Self; 4] = [Self::BadMotion, Self::OffScreen, Self::Disoccluded, Self::Distrusted];
}

/// Texel of the previous frame nearest to the previous position of pixel (`x`, `y`). A position is inside the previous
/// frame from half a pixel before the first centre (inclusive) to half a pixel after the last (exclusive).
///
/// # Errors
/// [`Verdict::BadMotion`] or [`Verdict::OffScreen`].
#[inline]
pub fn nearest(x: u32, y: u32, motion: [f32; 2], size: [u32; 2]) -> Result<[u32; 2], Verdict> {
    let [mx, my] = motion;
    // Bits of sizes are ordered as the sizes are, infinity and NaN last.
    let size_bits = |v: f32| v.to_bits() & 0x7fff_ffff;
    if size_bits(mx).max(size_bits(my)) > MAX_MOTION_PX.to_bits() {
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
