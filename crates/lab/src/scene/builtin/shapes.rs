//! Shapes and materials shared by the built-in scenes.

use crate::scene::{Material, Phong, Triangles};
use glam::{Quat, Vec2, Vec3, Vec4};
use std::f32::consts::{PI, TAU};

/// A diffuse material with a highlight: of `roughness` in the Disney mode, of `exponent` in the Phong mode.
pub(super) fn glossy(name: &str, base_color: [f32; 3], roughness: f32, exponent: f32) -> Material {
    let phong = Some(Phong { specular: [0.1; 3], exponent });
    Material { name: name.into(), base_color, roughness, double_sided: false, phong, ..Material::default() }
}

/// A sphere that is scaled, then rotated, then translated.
pub(super) struct Ellipsoid {
    pub center: Vec3,
    pub radii: Vec3,
    pub rotation: Quat,
    /// Faces around its y axis, 3 or more.
    pub around: u32,
    /// Rings of faces from pole to pole, 2 or more.
    pub rings: u32,
}

impl Ellipsoid {
    /// Appends 2 `around` (`rings` - 1) triangles: a closed mesh with smooth normals.
    pub fn push(&self, material: u32, out: &mut Triangles) {
        for ring in 0..self.rings {
            for k in 0..self.around {
                let [a, b] = [k, k + 1].map(|k| self.direction(ring, k));
                let [c, d] = [k, k + 1].map(|k| self.direction(ring + 1, k));
                // At the poles the quadrilateral degenerates to one triangle.
                if ring > 0 {
                    self.push_triangle([a, d, b], material, out);
                }
                if ring + 1 < self.rings {
                    self.push_triangle([a, c, d], material, out);
                }
            }
        }
    }

    /// Vertex on the unit sphere, ring 0 at the top. The last meridian equals the first one bit for bit.
    fn direction(&self, ring: u32, k: u32) -> Vec3 {
        if ring == 0 || ring == self.rings {
            return if ring == 0 { Vec3::Y } else { Vec3::NEG_Y };
        }
        let (sin_polar, cos_polar) = (PI * ring as f32 / self.rings as f32).sin_cos();
        let (sin, cos) = (TAU * (k % self.around) as f32 / self.around as f32).sin_cos();
        Vec3::new(sin_polar * sin, cos_polar, sin_polar * cos)
    }

    fn push_triangle(&self, directions: [Vec3; 3], material: u32, out: &mut Triangles) {
        let normals = directions.map(|d| (self.rotation * (d / self.radii)).normalize());
        out.positions.push(directions.map(|d| self.center + self.rotation * (d * self.radii)));
        out.normals.push(normals);
        out.uvs.push([Vec2::ZERO; 3]);
        out.tangents.push(normals.map(|n| n.any_orthonormal_vector().extend(1.0)));
        out.colors.push([Vec4::ONE; 3]);
        out.materials.push(material);
    }
}

/// Appends the 12 triangles of an axis-aligned box. Fronts face outwards, or inwards if `inward`.
pub(super) fn push_box(min: Vec3, max: Vec3, inward: bool, material: u32, out: &mut Triangles) {
    let corner = |x: bool, y: bool, z: bool| Vec3::select(glam::BVec3::new(x, y, z), max, min);
    for axis in 0..3 {
        for upper in [false, true] {
            // Counter-clockwise seen from the positive end of the axis.
            let mut face = [(false, false), (true, false), (true, true), (false, true)].map(|(u, v)| match axis {
                0 => corner(upper, u, v),
                1 => corner(v, upper, u),
                _ => corner(u, v, upper),
            });
            if upper == inward {
                face.reverse();
            }
            out.push_quad(face, material);
        }
    }
}
