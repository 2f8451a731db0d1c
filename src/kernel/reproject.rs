//! Reprojection: a pixel's position in the previous frame, and verdicts on its history.

use super::sanitize::is_finite;
use glam::{Vec2, Vec3, Vec4};

/// Largest valid component of a motion vector, in pixels.
pub const MAX_MOTION_PX: f32 = 65536.0;
/// Tolerance of motion coherence: in pixels, and as a share of the vector's length.
const COHERENT: [f32; 2] = [0.5, 0.1];

/// Verdict on a pixel's history: valid, or the reason why it is missing or rejected.
///
/// [`FrameStats::verdicts`](crate::FrameStats::verdicts) counts pixels by verdict, with the discriminant as index (an
/// example is at [`FrameStats`](crate::FrameStats)); [`DebugView::Rejection`](crate::DebugView::Rejection) draws them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
#[non_exhaustive]
pub enum Verdict {
    /// History is valid: it belongs to this surface. Grey.
    Valid = 0,
    /// History is empty: first frame, [`Reset::All`](crate::internal::Reset::All), resize. Blue.
    Reset = 1,
    /// The motion vector is NaN, infinite, or has a component beyond 65536 pixels. Magenta.
    BadMotion = 2,
    /// The surface point was outside the previous frame. Orange.
    OffScreen = 3,
    /// Nothing usable was stored at the previous position. Yellow.
    Empty = 4,
    /// Disocclusion: another surface was at the previous position (depth differs), or motion vectors of two surfaces
    /// are mixed. Red.
    Disoccluded = 5,
    /// The frame's trust mask is 0 at this pixel. Cyan.
    Distrusted = 6,
}

impl Verdict {
    /// Number of verdicts; every discriminant is below it.
    pub const COUNT: usize = 7;

    /// The verdict and its reason, for notes.
    #[cfg(feature = "cpu")]
    pub(crate) fn reason(self) -> &'static str {
        match self {
            Self::Valid => "kept: it belongs to this surface",
            Self::Reset => "none: first frame, reset, or outside the lens",
            Self::BadMotion => "rejected: the motion vector is NaN, infinite or longer than 65536 px",
            Self::OffScreen => "rejected: the surface was outside the previous frame",
            Self::Empty => "none: nothing is stored at the previous position",
            Self::Disoccluded => "rejected: another surface was there (depth), or motion vectors of two are mixed",
            Self::Distrusted => "rejected: the trust mask is 0",
        }
    }

    /// Verdicts that reject existing history.
    pub const REJECTED: [Self; 4] = [Self::BadMotion, Self::OffScreen, Self::Disoccluded, Self::Distrusted];
}

/// Color of a verdict, sRGB-encoded.
#[inline]
pub fn verdict_color(verdict: Verdict) -> Vec3 {
    match verdict {
        Verdict::Valid => Vec3::new(0.35, 0.35, 0.35),
        Verdict::Reset => Vec3::new(0.2, 0.4, 1.0),
        Verdict::BadMotion => Vec3::new(1.0, 0.2, 1.0),
        Verdict::OffScreen => Vec3::new(1.0, 0.55, 0.1),
        Verdict::Empty => Vec3::new(1.0, 1.0, 0.3),
        Verdict::Disoccluded => Vec3::new(1.0, 0.1, 0.1),
        Verdict::Distrusted => Vec3::new(0.1, 0.9, 0.9),
    }
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

/// Longest vector that [`camera_vector`] returns, along an axis. It leads out of every view.
pub const MAX_CAMERA_PX: f32 = 32768.0;

/// Vector of a pixel whose distance is not known. No such vector is valid.
pub const UNKNOWN_VECTOR_PX: f32 = 131072.0;

/// Motion of a view between two frames, for vectors of surfaces that stand still in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewMotion {
    /// First row of the current-to-previous view transform, less 1 on the diagonal.
    pub x: Vec4,
    /// The same of the second row.
    pub y: Vec4,
    /// The same of the third row.
    pub z: Vec4,
    /// Pixels of the previous frame for a change of a ray's x and y.
    pub per_tangent: Vec2,
    /// How many pixels more the previous frame has for a ray's x and y than this one. 0 unless the field of view
    /// changes.
    pub zoom: Vec2,
    /// How far the straight ray lies from where it was in the previous frame, in pixels. 0 unless the field of view
    /// changes.
    pub shift_px: Vec2,
    /// Third element of the third row.
    pub ahead: f32,
    /// Disparity of the far plane. What lies there is infinitely far away.
    pub sky: f32,
}

/// Motion vector of a surface that stands still in the world, at the ray (`ray`, 1): previous minus current position in
/// pixels. A surface of disparity 0, as the sky, follows the camera's turns alone. Exactly 0 while the camera is still.
#[inline]
pub fn camera_vector(ray: Vec2, disparity: f32, motion: ViewMotion) -> Vec2 {
    if disparity < 0.0 {
        return Vec2::splat(UNKNOWN_VECTOR_PX);
    }
    let ViewMotion { x, y, z, .. } = motion;
    let d = if disparity <= motion.sky { 0.0 } else { disparity };
    let past_depth = z.x * ray.x + (z.y * ray.y + (z.w * d + motion.ahead));
    // The point was behind the previous camera.
    if past_depth <= 1e-6 {
        return Vec2::splat(MAX_CAMERA_PX);
    }
    let change = Vec3::new(
        x.x * ray.x + (x.y * ray.y + (x.w * d + x.z)),
        y.x * ray.x + (y.y * ray.y + (y.w * d + y.z)),
        z.x * ray.x + (z.y * ray.y + (z.w * d + z.z)),
    );
    let tangent = (Vec2::new(change.x, change.y) - ray * change.z) / past_depth;
    let vector = tangent * motion.per_tangent + (ray * motion.zoom + motion.shift_px);
    vector.clamp(Vec2::splat(-MAX_CAMERA_PX), Vec2::splat(MAX_CAMERA_PX))
}

/// Longest component of a surface's motion in the world, in pixels a frame: its `motion` without the `camera`'s
/// ([`camera_vector`]).
#[inline]
pub fn world_motion_px(motion: Vec2, camera: Vec2) -> f32 {
    (motion.x - camera.x).abs().max((motion.y - camera.y).abs())
}

/// Whether a pixel of a motion input has no vector: it is `none`, or not finite.
#[inline]
pub fn has_no_vector(given: Vec2, none: Vec2) -> bool {
    !(is_finite(given.x) && is_finite(given.y)) || given == none
}

/// Whether two motion vectors, in pixels, can belong to one surface. A pixel that moves like neither neighbour in its
/// 2x2 block lies on a moving silhouette, where renderers mix the vectors of both sides: such a vector points at
/// neither surface.
#[inline]
pub fn moves_alike(own: [f32; 2], other: [f32; 2]) -> bool {
    let within = COHERENT[0] + COHERENT[1] * (own[0].abs() + own[1].abs());
    (other[0] - own[0]).abs() <= within && (other[1] - own[1]).abs() <= within
}
