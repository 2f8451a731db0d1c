//! Solids that the room's furniture consists of.

use crate::scene::Triangles;
use crate::scene::builtin::patch::patch;
use crate::scene::builtin::shapes::push_box;
use glam::{Vec2, Vec3};
use std::f32::consts::TAU;

/// Faces around a wire, which is about a pixel wide.
const WIRE_SIDES: u32 = 6;

/// Appends an axis-aligned box. Its texture coordinates are metres.
pub(super) fn block(min: [f32; 3], max: [f32; 3], material: u32, out: &mut Triangles) {
    let first = out.len();
    push_box(Vec3::from(min), Vec3::from(max), false, material, out);
    for i in first..out.len() {
        let normal = out.normals[i][0].abs();
        out.uvs[i] = out.positions[i].map(|p| {
            if normal.x > 0.5 {
                Vec2::new(p.z, -p.y)
            } else if normal.y > 0.5 {
                Vec2::new(p.x, p.z)
            } else {
                Vec2::new(p.x, -p.y)
            }
        });
    }
}

/// Appends a curved surface (see [`patch`]) with tangents that are orthogonal to its smooth normals.
pub(super) fn surface(out: &mut Triangles, cells: [u32; 2], material: u32, at: impl Fn(f32, f32) -> Vec3) {
    let first = out.len();
    patch(out, cells, material, at);
    for (tangents, normals) in out.tangents[first..].iter_mut().zip(&out.normals[first..]) {
        *tangents = normals.map(|n| n.any_orthonormal_vector().extend(1.0));
    }
}

/// A round rod between two points.
pub(super) struct Rod {
    pub from: Vec3,
    pub to: Vec3,
    /// Radius at each end, metres.
    pub radii_m: [f32; 2],
}

impl Rod {
    /// A rod of the same radius everywhere.
    pub fn even(from: [f32; 3], to: [f32; 3], radius_m: f32) -> Self {
        Self { from: from.into(), to: to.into(), radii_m: [radius_m; 2] }
    }

    /// Appends the side and both ends.
    pub fn push(&self, sides: u32, material: u32, out: &mut Triangles) {
        self.push_side(sides, material, out);
        let [bottom, top] = self.radii_m;
        surface(out, [sides, 1], material, |u, v| self.from + self.outwards(u) * (bottom * v));
        surface(out, [sides, 1], material, |u, v| self.to + self.outwards(u) * (top * (1.0 - v)));
    }

    /// Appends the side alone.
    pub fn push_side(&self, sides: u32, material: u32, out: &mut Triangles) {
        let [bottom, top] = self.radii_m;
        surface(out, [sides, 1], material, |u, v| {
            self.from.lerp(self.to, v) + self.outwards(u) * (bottom + (top - bottom) * v)
        });
    }

    /// Unit vector away from the axis at `u` of a turn.
    fn outwards(&self, u: f32) -> Vec3 {
        let axis = (self.to - self.from).normalize_or(Vec3::Y);
        let right = axis.any_orthonormal_vector();
        let (sin, cos) = (u * TAU).sin_cos();
        right * sin + right.cross(axis) * cos
    }
}

/// Appends a thin rod without ends.
pub(super) fn wire(from: Vec3, to: Vec3, radius_m: f32, material: u32, out: &mut Triangles) {
    Rod { from, to, radii_m: [radius_m; 2] }.push_side(WIRE_SIDES, material, out);
}

/// Appends a wire bent to a circle about the z axis through `center`.
pub(super) fn hoop(center: Vec3, radius_m: f32, wire_radius_m: f32, material: u32, out: &mut Triangles) {
    surface(out, [48, WIRE_SIDES], material, |u, v| {
        let ((sin, cos), (rise, spread)) = ((u * TAU).sin_cos(), (v * TAU).sin_cos());
        let outwards = Vec3::new(cos, sin, 0.0) * (radius_m + wire_radius_m * spread);
        center + outwards + Vec3::Z * (wire_radius_m * rise)
    });
}
