//! Watertight ray/triangle intersection (Woop, Benthin and Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1),
//! 2013), and origins of secondary rays.
//!
//! The test shears space so that the ray runs along an axis, then asks on which side of each edge the axis passes. A
//! vertex is sheared alike in every triangle, and the two triangles at an edge compute the same two products with
//! opposite signs, so no gap opens between them. Zero counts as inside on both sides.
//!
//! Edges shorter than the rounding error at their distance from the ray give random answers. A test of the triangle's
//! bounds, which is exact, therefore comes first.

use glam::{Vec3, Vec3A};

/// Offset of a secondary ray's origin from its surface, as a share of the largest vertex coordinate. A hit point from
/// barycentrics is off by at most 7 * 2^-24 of that coordinate (Pharr, Jakob and Humphreys, "Physically Based
/// Rendering", 4th edition, 6.8.5), and the test's distance by as much. The constant is 32 times 2^-23.
pub const ORIGIN_OFFSET: f32 = 1.0 / 262_144.0;

/// Triangles whose edge functions sum to less than this count as having no area: the products have become denormal.
pub const MIN_DET: f32 = 1e-36;

/// Upper bound for the lower corner of a sheared triangle's bounds. It is 0 across the ray, and unbounded along it.
const ACROSS: Vec3A = Vec3A::new(0.0, 0.0, f32::MAX);

/// Columns of the matrix that shears a ray's direction to (0, 0, 1).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shear {
    /// Image of the x axis.
    pub x: Vec3A,
    /// Image of the y axis.
    pub y: Vec3A,
    /// Image of the z axis.
    pub z: Vec3A,
}

/// Intersection of a ray with a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Intersection {
    /// Distance in units of the ray direction's length; 0 without an intersection.
    pub t: f32,
    /// Barycentric weight of the second vertex.
    pub u: f32,
    /// Barycentric weight of the third vertex.
    pub v: f32,
}

/// Shear for a finite, nonzero direction; the axis of its largest component becomes z. Each row has at most two nonzero
/// entries, so row sums do not depend on their order.
#[inline]
pub fn shear(direction: Vec3) -> Shear {
    let size = direction.abs();
    if size.x >= size.y && size.x >= size.z {
        let inv = 1.0 / direction.x;
        return Shear {
            x: Vec3A::new(-(direction.y / direction.x), -(direction.z / direction.x), inv),
            y: Vec3A::X,
            z: Vec3A::Y,
        };
    }
    if size.y >= size.z {
        let inv = 1.0 / direction.y;
        return Shear {
            x: Vec3A::Y,
            y: Vec3A::new(-(direction.z / direction.y), -(direction.x / direction.y), inv),
            z: Vec3A::X,
        };
    }
    let inv = 1.0 / direction.z;
    Shear { x: Vec3A::X, y: Vec3A::Y, z: Vec3A::new(-(direction.x / direction.z), -(direction.y / direction.z), inv) }
}

/// Sheared position of a vertex given relative to the ray's origin: x and y across the ray, z along it.
#[inline]
pub fn sheared(shear: Shear, from_origin: Vec3A) -> Vec3A {
    shear.x * from_origin.x + shear.y * from_origin.y + shear.z * from_origin.z
}

/// Edge function: twice the signed area spanned by the ray's axis and the edge from `a` to `b`. Swapping the arguments
/// changes only the sign.
#[inline]
pub fn edge(a: Vec3A, b: Vec3A) -> f32 {
    a.x * b.y - a.y * b.x
}

/// Intersects the ray from `origin` with the triangle, from either side.
#[inline]
pub fn intersect(shear: Shear, origin: Vec3A, v0: Vec3A, v1: Vec3A, v2: Vec3A) -> Intersection {
    let miss = Intersection { t: 0.0, u: 0.0, v: 0.0 };
    let a = sheared(shear, v0 - origin);
    let b = sheared(shear, v1 - origin);
    let c = sheared(shear, v2 - origin);
    let low = a.min(b.min(c));
    let high = a.max(b.max(c));
    if (low.cmpgt(ACROSS) | high.cmplt(Vec3A::ZERO)).any() {
        return miss;
    }
    let e0 = edge(c, b);
    let e1 = edge(a, c);
    let e2 = edge(b, a);
    if e0.min(e1.min(e2)) < 0.0 && e0.max(e1.max(e2)) > 0.0 {
        return miss;
    }
    let det = e0 + (e1 + e2);
    if det.abs() < MIN_DET {
        return miss;
    }
    // The quotient is not negative, except for the sign of a zero.
    let u = (e1 / det).abs();
    let v = (e2 / det).abs();
    // One vertex' depth plus two differences instead of three products: every compiler keeps this order of operations.
    Intersection { t: (a.z + u * (b.z - a.z)) + v * (c.z - a.z), u, v }
}

/// Point of a triangle at barycentric weights. More accurate than a point along the ray, whose error grows with
/// distance.
#[inline]
pub fn point_at(v0: Vec3, v1: Vec3, v2: Vec3, u: f32, v: f32) -> Vec3 {
    (v0 + (v1 - v0) * u) + (v2 - v0) * v
}

/// Largest coordinate of a triangle's vertices; bounds the rounding error of its points.
#[inline]
pub fn magnitude(v0: Vec3, v1: Vec3, v2: Vec3) -> f32 {
    let largest = v0.abs().max(v1.abs()).max(v2.abs());
    largest.x.max(largest.y.max(largest.z))
}

/// Origin of a ray leaving a surface on the side of unit vector `normal`: far enough to miss the same triangle, near
/// enough to be invisible. After Waechter and Binder ("A Fast and Robust Method for Avoiding Self-Intersection", Ray
/// Tracing Gems, 2019, chapter 6), whose offset also grows with the position but stays 2^-16 m near the world's origin.
#[inline]
pub fn offset_ray(point: Vec3, normal: Vec3, magnitude: f32) -> Vec3 {
    point + normal * (magnitude * ORIGIN_OFFSET)
}
