//! Unit vectors, and frames around a normal.

use glam::Vec3;

/// `v` normalized. Returns the z axis if the largest component's magnitude is not in \[1e-30, 1e30\].
#[inline]
pub fn unit(v: Vec3) -> Vec3 {
    let m = v.x.abs().max(v.y.abs()).max(v.z.abs());
    if (1e-30..=1e30).contains(&m) {
        // Divided by the largest component first, so that squares neither overflow nor underflow.
        let s = v / m;
        return s / s.dot(s).sqrt();
    }
    Vec3::Z
}

/// Two unit vectors that complete unit vector `n` to a right-handed frame (Duff et al., "Building an Orthonormal Basis,
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

/// Coordinates of `v` in the orthonormal frame (`x`, `y`, `z`).
#[inline]
pub fn to_local(v: Vec3, x: Vec3, y: Vec3, z: Vec3) -> Vec3 {
    Vec3::new(v.dot(x), v.dot(y), v.dot(z))
}

/// Inverse of [`to_local`].
#[inline]
pub fn to_world(v: Vec3, x: Vec3, y: Vec3, z: Vec3) -> Vec3 {
    Vec3::new(v.x * x.x + v.y * y.x + v.z * z.x, v.x * x.y + v.y * y.y + v.z * z.y, v.x * x.z + v.y * y.z + v.z * z.z)
}
