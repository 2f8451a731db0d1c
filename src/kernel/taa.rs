//! One pixel of temporal antialiasing: the rival that knows nothing of gaze.

use glam::Vec3;

/// Gamma 2 and YCoCg of a linear colour.
#[inline]
pub fn to_ycocg(c: Vec3) -> Vec3 {
    let r = Vec3::new(c.x.max(0.0).sqrt(), c.y.max(0.0).sqrt(), c.z.max(0.0).sqrt());
    let outer = 0.25 * (r.x + r.z);
    Vec3::new(outer + 0.5 * r.y, 0.5 * (r.x - r.z), 0.5 * r.y - outer)
}

/// Back to linear.
#[inline]
pub fn from_ycocg(y: Vec3) -> Vec3 {
    let t = y.x - y.z;
    let r = Vec3::new(t + y.y, y.x + y.z, t - y.y).max(Vec3::ZERO);
    r * r
}

/// Pulls `history` towards `mean` until it lies in the box of half width `extent` around it.
#[inline]
pub fn clip(history: Vec3, mean: Vec3, extent: Vec3) -> Vec3 {
    let d = history - mean;
    let a = d.abs() / extent.max(Vec3::splat(1e-6));
    let most = a.x.max(a.y).max(a.z);
    if most > 1.0 { mean + d * (1.0 / most) } else { history }
}
