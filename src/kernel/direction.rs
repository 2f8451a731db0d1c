//! Directions: unit vectors, frames around a normal, storage in a word.

use glam::{Vec2, Vec3};

/// Steps of an octahedral coordinate on each side of 0, so that the axes are stored exactly.
const OCT_STEPS: f32 = 32767.0;

/// `v` at length 1; the z axis for a `v` whose largest component is not in \[1e-30, 1e30\].
#[inline]
pub fn unit(v: Vec3) -> Vec3 {
    let m = v.x.abs().max(v.y.abs()).max(v.z.abs());
    if (1e-30..=1e30).contains(&m) {
        // Over the largest component first: squares neither overflow nor vanish.
        let s = v / m;
        return s / s.dot(s).sqrt();
    }
    Vec3::Z
}

/// Two unit vectors that complete the unit vector `n` to a right-handed frame (Duff et al., "Building an Orthonormal Basis,
/// Revisited", JCGT 6(1), 2017).
#[inline]
pub fn basis(n: Vec3) -> [Vec3; 2] {
    let sign = if n.z >= 0.0 { 1.0 } else { -1.0 };
    let a = -1.0 / (sign + n.z);
    let b = (n.x * a) * n.y;
    let x = n.x * a;
    let y = n.y * a;
    [Vec3::new(1.0 + sign * (x * n.x), sign * b, -sign * n.x), Vec3::new(b, sign + y * n.y, -n.y)]
}

/// `v` in the frame (`x`, `y`, `z`) of unit vectors at right angles.
#[inline]
pub fn to_local(v: Vec3, x: Vec3, y: Vec3, z: Vec3) -> Vec3 {
    Vec3::new(v.dot(x), v.dot(y), v.dot(z))
}

/// The inverse of [`to_local`].
#[inline]
pub fn to_world(v: Vec3, x: Vec3, y: Vec3, z: Vec3) -> Vec3 {
    Vec3::new(v.x * x.x + v.y * y.x + v.z * z.x, v.x * x.y + v.y * y.y + v.z * z.y, v.x * x.z + v.y * y.z + v.z * z.z)
}

#[inline]
fn oct_fold(p: Vec2) -> Vec2 {
    let x = if p.x >= 0.0 { 1.0 - p.y.abs() } else { p.y.abs() - 1.0 };
    let y = if p.y >= 0.0 { 1.0 - p.x.abs() } else { p.x.abs() - 1.0 };
    Vec2::new(x, y)
}

/// A unit vector in 2 x 16 bits: its octahedral projection (Cigolle et al., "A Survey of Efficient Representations for
/// Independent Unit Vectors", JCGT 3(2), 2014). At most 7e-5 rad off; the axes are exact.
#[inline]
pub fn oct_encode(v: Vec3) -> u32 {
    let sum = (v.x.abs() + v.y.abs()) + v.z.abs();
    let p = Vec2::new(v.x / sum, v.y / sum);
    let q = if v.z >= 0.0 { p } else { oct_fold(p) };
    let x = (q.x * OCT_STEPS + 32767.5).floor().clamp(0.0, 65534.0) as u32;
    let y = (q.y * OCT_STEPS + 32767.5).floor().clamp(0.0, 65534.0) as u32;
    x | (y << 16)
}

/// The unit vector that [`oct_encode`] stored; finite for any word.
#[inline]
pub fn oct_decode(word: u32) -> Vec3 {
    let x = ((word & 0xffff) as f32 - OCT_STEPS) / OCT_STEPS;
    let y = ((word >> 16) as f32 - OCT_STEPS) / OCT_STEPS;
    let z = (1.0 - x.abs()) - y.abs();
    let p = Vec2::new(x, y);
    let q = if z >= 0.0 { p } else { oct_fold(p) };
    unit(Vec3::new(q.x, q.y, z))
}
