//! From a surface's attributes to the frame and colors that scattering works with.

use super::direction::unit;
use afterimage::kernel::color::luma;
use glam::{Vec2, Vec3};

/// The normal that a tangent-space normal map shows: `texel` red, green and blue in \[0, 1\], its x and y scaled by `scale`.
/// `tangent` need not be perpendicular; `sign` is that of the bitangent. The surface's own normal where the map says nothing.
#[inline]
pub fn mapped_normal(normal: Vec3, tangent: Vec3, sign: f32, texel: Vec3, scale: f32) -> Vec3 {
    let along = unit(tangent - normal * normal.dot(tangent));
    let bitangent = normal.cross(along) * sign;
    let local = texel * 2.0 - Vec3::ONE;
    let xy = Vec2::new(local.x, local.y) * scale;
    let z = local.z.max(1e-3);
    unit(along * xy.x + bitangent * xy.y + normal * z)
}

/// The shading normal, brought to a side that can be seen: where `toward` (the direction to the eye) is below it, it is tilted
/// until `toward` grazes the surface. All of length 1; `geometric` is on the side of `toward`.
#[inline]
pub fn visible_normal(shading: Vec3, geometric: Vec3, toward: Vec3) -> Vec3 {
    let seen = shading.dot(toward);
    if seen >= GRAZING {
        return shading;
    }
    // Move along `toward` until the cosine is right; far from it, the face itself.
    let lifted = unit(shading + toward * (GRAZING - seen));
    if lifted.dot(geometric) > 0.0 && lifted.dot(toward) > 0.0 { lifted } else { geometric }
}

/// Smallest cosine at which a shaded surface is seen.
const GRAZING: f32 = 1e-3;

/// The hue of a color at luminance 1; white for black.
#[inline]
pub fn hue(color: Vec3) -> Vec3 {
    let y = luma(color);
    if y > 1e-6 { color / y } else { Vec3::ONE }
}

/// White for `amount` 0, the hue of `color` for 1.
#[inline]
pub fn tint(color: Vec3, amount: f32) -> Vec3 {
    Vec3::splat(1.0 - amount) + hue(color) * amount
}
