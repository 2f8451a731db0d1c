//! Generation of absent tangents by MikkTSpace, as glTF 2.0 (3.7.2.1) prescribes.

use crate::scene::geometry::{Geometry, face_normal};
use bevy_mikktspace::{Geometry as Faces, TangentSpace, generate_tangents};
use glam::{Vec2, Vec3, Vec4};
use std::collections::HashMap;

/// Largest number of corners at one position for MikkTSpace, whose time grows with its square.
const MAX_VALENCE: u32 = 512;

/// Gives every corner its own vertex with a tangent towards growing u of `along`, the coordinates of the vertices.
///
/// The sign in w is the opposite of MikkTSpace's: a glTF normal map's green channel points up in the image, towards
/// decreasing v.
pub(super) fn generate(geometry: &mut Geometry, along: Vec<Vec2>) {
    let of_corners = geometry.indices.iter().flatten().map(|&i| along[i as usize]).collect();
    geometry.unweld();
    let uvs = std::mem::replace(&mut geometry.uvs, of_corners);
    geometry.tangents = vec![Vec4::ZERO; geometry.positions.len()];
    let flat = geometry.normals.is_empty();
    if flat {
        let p = &geometry.positions;
        let faces = geometry.indices.iter().map(|f| face_normal(f.map(|i| p[i as usize])));
        geometry.normals = faces.flat_map(|n| [n; 3]).collect();
    }
    fill(geometry);
    geometry.uvs = uvs;
    if flat {
        geometry.normals.clear();
    }
}

fn fill(geometry: &mut Geometry) {
    if valence(geometry) > MAX_VALENCE {
        for face in 0..geometry.indices.len() {
            let tangent = face_tangent(geometry, face);
            geometry.tangents[face * 3..face * 3 + 3].fill(tangent);
        }
        return;
    }
    // MikkTSpace cannot fail here.
    let _ = generate_tangents(&mut Corners(geometry));
}

/// Largest number of corners at one position.
fn valence(geometry: &Geometry) -> u32 {
    let mut corners = HashMap::new();
    for p in &geometry.positions {
        // Adding zero turns -0 into +0.
        *corners.entry((*p + Vec3::ZERO).to_array().map(f32::to_bits)).or_insert(0u32) += 1;
    }
    corners.into_values().max().unwrap_or(0)
}

/// Tangent of a triangle from its texture coordinates.
fn face_tangent(geometry: &Geometry, face: usize) -> Vec4 {
    let [a, b, c] = [0, 1, 2].map(|k| face * 3 + k);
    let (p, uv) = (&geometry.positions, &geometry.uvs);
    let (edge_1, edge_2) = (p[b] - p[a], p[c] - p[a]);
    let (uv_1, uv_2) = (uv[b] - uv[a], uv[c] - uv[a]);
    let area = uv_1.perp_dot(uv_2);
    let direction = (edge_1 * uv_2.y - edge_2 * uv_1.y) * area.signum();
    direction.normalize_or_zero().extend(-area.signum())
}

/// Adapter to MikkTSpace for meshes without shared vertices.
struct Corners<'a>(&'a mut Geometry);

impl Faces for Corners<'_> {
    fn num_faces(&self) -> usize {
        self.0.indices.len()
    }

    fn num_vertices_of_face(&self, _face: usize) -> usize {
        3
    }

    fn position(&self, face: usize, corner: usize) -> [f32; 3] {
        self.0.positions[face * 3 + corner].to_array()
    }

    fn normal(&self, face: usize, corner: usize) -> [f32; 3] {
        self.0.normals[face * 3 + corner].to_array()
    }

    fn tex_coord(&self, face: usize, corner: usize) -> [f32; 2] {
        self.0.uvs[face * 3 + corner].to_array()
    }

    fn set_tangent(&mut self, space: Option<TangentSpace>, face: usize, corner: usize) {
        let [x, y, z, w] = space.unwrap_or_default().tangent_encoded();
        self.0.tangents[face * 3 + corner] = Vec4::new(x, y, z, -w);
    }
}
