//! Shading normals and tints.

use super::direction::unit;
use afterimage::kernel::color::luma;
use glam::{Vec2, Vec3};

/// Normal from a tangent-space normal map. `texel` holds red, green and blue in \[0, 1\]; x and y are multiplied by
/// `scale`. `tangent` need not be perpendicular to `normal`; `sign` is the bitangent's. A neutral texel returns
/// `normal`.
#[inline]
pub fn mapped_normal(normal: Vec3, tangent: Vec3, sign: f32, texel: Vec3, scale: f32) -> Vec3 {
    let along = unit(tangent - normal * normal.dot(tangent));
    let bitangent = normal.cross(along) * sign;
    let local = texel * 2.0 - Vec3::ONE;
    let xy = Vec2::new(local.x, local.y) * scale;
    let z = local.z.max(1e-3);
    unit(along * xy.x + bitangent * xy.y + normal * z)
}

/// Shading normal visible from `toward`, the direction to the viewer. If `toward` is below the shading normal's
/// horizon, the normal is tilted until `toward` is just above it. All vectors have unit length; `geometric` is on the
/// side of `toward`.
#[inline]
pub fn visible_normal(shading: Vec3, geometric: Vec3, toward: Vec3) -> Vec3 {
    let seen = shading.dot(toward);
    if seen >= GRAZING {
        return shading;
    }
    // Move along `toward` until the cosine is right. If the result is on the wrong side, use the geometric normal.
    let lifted = unit(shading + toward * (GRAZING - seen));
    if lifted.dot(geometric) > 0.0 && lifted.dot(toward) > 0.0 { lifted } else { geometric }
}

/// Smallest cosine between a shading normal and the view direction.
const GRAZING: f32 = 1e-3;

/// `color` scaled to luminance 1; white for black.
#[inline]
pub fn hue(color: Vec3) -> Vec3 {
    let y = luma(color);
    if y > 1e-6 { color / y } else { Vec3::ONE }
}

/// Blend between white (`amount` 0) and the hue of `color` (`amount` 1).
#[inline]
pub fn tint(color: Vec3, amount: f32) -> Vec3 {
    Vec3::splat(1.0 - amount) + hue(color) * amount
}
