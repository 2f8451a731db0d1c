//! Sampling of simple shapes from uniform draws in \[0, 1), with densities, and the MIS weight.
//!
//! Every function is finite for all draws in \[0, 1\], including the ends.

use afterimage::kernel::approx::sin_cos_turns;
use glam::{Vec2, Vec3};
use std::f32::consts::FRAC_1_PI;

/// Point of the unit disk, uniform in area.
#[inline]
pub fn disk(u: Vec2) -> Vec2 {
    let r = u.x.sqrt();
    let [s, c] = sin_cos_turns(u.y);
    Vec2::new(r * c, r * s)
}

/// Direction with z >= 0 and density proportional to z.
#[inline]
pub fn cosine_hemisphere(u: Vec2) -> Vec3 {
    let d = disk(u);
    Vec3::new(d.x, d.y, (1.0 - u.x).max(0.0).sqrt())
}

/// Density of [`cosine_hemisphere`] in 1/sr.
#[inline]
pub fn cosine_hemisphere_pdf(z: f32) -> f32 {
    z.max(0.0) * FRAC_1_PI
}

/// Direction with z >= 0, uniform in solid angle.
#[inline]
pub fn uniform_hemisphere(u: Vec2) -> Vec3 {
    let r = (u.x * (2.0 - u.x)).max(0.0).sqrt();
    let [s, c] = sin_cos_turns(u.y);
    Vec3::new(r * c, r * s, 1.0 - u.x)
}

/// Density of [`uniform_hemisphere`] in 1/sr.
#[inline]
pub fn uniform_hemisphere_pdf(z: f32) -> f32 {
    if z >= 0.0 { 0.5 * FRAC_1_PI } else { 0.0 }
}

/// Barycentric coordinates of a point in a triangle, uniform in area (Turk 1990).
#[inline]
pub fn barycentrics(u: Vec2) -> Vec3 {
    let s = u.x.sqrt();
    let y = u.y * s;
    Vec3::new(1.0 - s, s - y, y)
}

/// Density in 1/sr of a point sampled uniformly on a surface of `area`, seen at a squared distance of
/// `distance_squared` and with `cosine` to the surface normal. 0 if the surface is edge-on or has no area. Takes the
/// squared distance, because compilers replace the square of a root by its argument.
#[inline]
pub fn area_pdf(area: f32, distance_squared: f32, cosine: f32) -> f32 {
    let projected = area * cosine.abs();
    if projected > 1e-30 { distance_squared / projected } else { 0.0 }
}

/// MIS weight by the power heuristic (Veach 1997, beta = 2) of a sample whose own strategy has density `own` and the
/// other strategy `other`: own^2 / (own^2 + other^2). In \[0, 1\]; 0 if both are 0. No overflow for densities up to
/// 1e18.
#[inline]
pub fn power_heuristic(own: f32, other: f32) -> f32 {
    if own > other {
        let r = other / own;
        return 1.0 / (r * r + 1.0);
    }
    if other > 0.0 {
        let r = own / other;
        return (r * r) / (r * r + 1.0);
    }
    0.0
}
