//! Which pixels a headset's lens shows: an octagon around the visible area, by bounds along both axes and both
//! diagonals.

use super::approx;
use glam::{Vec3, Vec4};

/// Whether pixel (`x`, `y`) lies in the octagon: x, y, x + y and x - y are within `lowest` and `highest`, in pixels.
#[inline]
pub fn is_visible(x: u32, y: u32, lowest: Vec4, highest: Vec4) -> bool {
    let (x, y) = (x as f32, y as f32);
    let along = Vec4::new(x, y, x + y, x - y);
    along.cmpge(lowest).all() && along.cmple(highest).all()
}

/// True visual angle in degrees, in \[0, 180\], between two rays of any non-zero length.
///
/// atan2 of cross and dot product: `acos(dot)` is 0 below 0.006 degrees in f32. Error below 1e-6 rad.
#[inline]
pub fn eccentricity_deg(ray: Vec3, gaze: Vec3) -> f32 {
    let cx = ray.y * gaze.z - ray.z * gaze.y;
    let cy = ray.z * gaze.x - ray.x * gaze.z;
    let cz = ray.x * gaze.y - ray.y * gaze.x;
    let cross = (cx * cx + cy * cy + cz * cz).sqrt();
    // The z product comes first: it is often a constant, and compilers may move a constant that comes last.
    let dot = ray.z * gaze.z + ray.x * gaze.x + ray.y * gaze.y;
    // The limit also keeps compilers from merging this factor with those of the functions that the angle is passed to.
    (approx::atan2_upper(cross, dot) * (180.0 / std::f32::consts::PI)).min(180.0)
}
