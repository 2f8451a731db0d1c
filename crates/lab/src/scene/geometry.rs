//! Meshes in node space or in their skin's bind pose, and their transformation to triangles in world space.

use super::Triangles;
use glam::{Affine3A, DAffine3, Mat3, Mat3A, Vec2, Vec3, Vec3A, Vec4};
use rayon::prelude::*;

/// Largest coordinate in metres. Products of four coordinates fit a float, so that areas and intersections are finite.
pub(crate) const MAX_COORDINATE: f32 = 1e9;

/// Smallest number of vertices per parallel task.
const MIN_BATCH: usize = 4096;

/// An indexed triangle mesh. Attributes that it lacks are empty.
#[derive(Clone, Debug, Default)]
pub(crate) struct Geometry {
    pub positions: Vec<Vec3>,
    /// Empty: flat shading.
    pub normals: Vec<Vec3>,
    /// Empty: the material needs none.
    pub tangents: Vec<Vec4>,
    pub uvs: Vec<Vec2>,
    /// Empty: no texture takes them.
    pub second_uvs: Vec<Vec2>,
    pub colors: Vec<Vec4>,
    pub indices: Vec<[u32; 3]>,
    pub material: u32,
    pub targets: Vec<Target>,
    pub influences: Influences,
}

/// Displacements of a morph target at weight 1. Empty: none.
#[derive(Clone, Debug, Default)]
pub(crate) struct Target {
    pub positions: Vec<Vec3>,
    pub normals: Vec<Vec3>,
    pub tangents: Vec<Vec3>,
}

/// Joints and weights of each vertex. All vertices have the same number of joints; weights sum to 1.
#[derive(Clone, Debug, Default)]
pub(crate) struct Influences {
    pub per_vertex: usize,
    pub joints: Vec<u16>,
    pub weights: Vec<f32>,
}

/// Vertices of a mesh in world space, at one time.
pub(crate) struct Posed {
    vertices: Vec<PosedVertex>,
}

#[derive(Clone, Copy)]
struct PosedVertex {
    position: Vec3,
    normal: Vec3,
    tangent: Vec4,
    mirrored: bool,
}

impl Geometry {
    /// Vertices after morphing and a rigid or affine transformation.
    pub fn transformed(&self, world: &DAffine3, weights: &[f32]) -> Posed {
        // In f64, so that normals stay accurate under tiny and huge scales.
        let largest = world.matrix3.to_cols_array().iter().fold(0.0f64, |a, x| a.max(x.abs())).max(f64::MIN_POSITIVE);
        let scaled = (world.matrix3 * (1.0 / largest)).as_mat3();
        let mirrored = world.matrix3.determinant() < 0.0;
        let normal_from_local = signed_cofactors(scaled, mirrored);
        self.posed(weights, |_, v| PosedVertex {
            position: world.transform_point3(v.position.as_dvec3()).as_vec3(),
            normal: Vec3::from(normal_from_local * Vec3A::from(v.normal)).normalize_or_zero(),
            tangent: transformed_tangent(scaled, v.tangent, mirrored),
            mirrored,
        })
    }

    /// Vertices after morphing and linear blend skinning.
    pub fn skinned(&self, joints: &[Affine3A], weights: &[f32]) -> Posed {
        let n = self.influences.per_vertex;
        self.posed(weights, |i, v| {
            let mut linear = Mat3A::ZERO;
            let mut shift = Vec3A::ZERO;
            let influences = self.influences.joints[i * n..].iter().zip(&self.influences.weights[i * n..]).take(n);
            for (&joint, &weight) in influences.filter(|(_, w)| **w != 0.0) {
                let m = &joints[usize::from(joint)];
                linear += m.matrix3 * weight;
                shift += m.translation * weight;
            }
            let largest = linear.to_cols_array().iter().fold(0.0f32, |a, x| a.max(x.abs())).max(f32::MIN_POSITIVE);
            let scaled = Mat3::from(linear * (1.0 / largest));
            let mirrored = scaled.determinant() < 0.0;
            PosedVertex {
                position: Vec3::from(linear * Vec3A::from(v.position) + shift),
                normal: Vec3::from(signed_cofactors(scaled, mirrored) * Vec3A::from(v.normal)).normalize_or_zero(),
                tangent: transformed_tangent(scaled, v.tangent, mirrored),
                mirrored,
            }
        })
    }

    /// Gives every triangle corner its own vertex, in the order of the triangles.
    pub fn unweld(&mut self) {
        fn corners<T: Copy>(values: &mut Vec<T>, indices: &[[u32; 3]]) {
            if !values.is_empty() {
                *values = indices.iter().flatten().map(|&i| values[i as usize]).collect();
            }
        }
        let indices = std::mem::take(&mut self.indices);
        corners(&mut self.positions, &indices);
        corners(&mut self.normals, &indices);
        corners(&mut self.tangents, &indices);
        corners(&mut self.uvs, &indices);
        corners(&mut self.second_uvs, &indices);
        corners(&mut self.colors, &indices);
        for target in &mut self.targets {
            corners(&mut target.positions, &indices);
            corners(&mut target.normals, &indices);
            corners(&mut target.tangents, &indices);
        }
        let n = self.influences.per_vertex;
        if n > 0 {
            let all = indices.iter().flatten().flat_map(|&i| i as usize * n..(i as usize + 1) * n);
            let Influences { joints, weights, .. } = std::mem::take(&mut self.influences);
            let joints = all.clone().map(|i| joints[i]).collect();
            let weights = all.map(|i| weights[i]).collect();
            self.influences = Influences { per_vertex: n, joints, weights };
        }
        self.indices = (0..indices.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    }

    fn posed(&self, weights: &[f32], place: impl Fn(usize, &PosedVertex) -> PosedVertex + Sync) -> Posed {
        let vertices = (0..self.positions.len())
            .into_par_iter()
            .with_min_len(MIN_BATCH)
            .map(|i| place(i, &self.morphed(i, weights)))
            .collect();
        Posed { vertices }
    }

    /// A vertex with its morph targets, in local space.
    fn morphed(&self, i: usize, weights: &[f32]) -> PosedVertex {
        let mut v = PosedVertex {
            position: self.positions[i],
            normal: self.normals.get(i).copied().unwrap_or_default(),
            tangent: self.tangents.get(i).copied().unwrap_or_default(),
            mirrored: false,
        };
        for (target, &weight) in self.targets.iter().zip(weights).filter(|(_, w)| **w != 0.0) {
            let add = |deltas: &[Vec3]| deltas.get(i).map_or(Vec3::ZERO, |&d| d * weight);
            v.position += add(&target.positions);
            v.normal += add(&target.normals);
            v.tangent += add(&target.tangents).extend(0.0);
        }
        v
    }

    /// Appends the triangles to `out`. Triangles with a corner that is not finite or beyond [`MAX_COORDINATE`] are
    /// dropped if `drop_bad`; otherwise they collapse to a point, which keeps the order and number of triangles.
    /// Returns the number dropped.
    pub fn push_triangles(&self, posed: &Posed, drop_bad: bool, out: &mut Triangles) -> u64 {
        let mut dropped = 0;
        out.reserve(self.indices.len());
        for &triangle in &self.indices {
            let triangle = triangle.map(|i| i as usize);
            let first = &posed.vertices[triangle[0]];
            // Mirroring flips the winding order: swap two corners.
            let [a, b, c] = triangle;
            let triangle = if first.mirrored { [a, c, b] } else { [a, b, c] };
            let corners = triangle.map(|i| posed.vertices[i]);
            let mut positions = corners.map(|v| v.position);
            if !positions.iter().all(is_usable) {
                if drop_bad {
                    dropped += 1;
                    continue;
                }
                positions = [Vec3::ZERO; 3];
            }
            let face = face_normal(positions);
            let normals = corners.map(|v| {
                let usable =
                    self.normals.len() == self.positions.len() && v.normal.is_finite() && v.normal != Vec3::ZERO;
                if usable { v.normal } else { face }
            });
            let tangents = std::array::from_fn(|k| orthogonal_tangent(normals[k], corners[k].tangent));
            out.positions.push(positions);
            out.normals.push(normals);
            out.tangents.push(tangents);
            if !self.second_uvs.is_empty() {
                out.second_uvs.resize(out.uvs.len(), [Vec2::ZERO; 3]);
                out.second_uvs.push(triangle.map(|i| self.second_uvs[i]));
            }
            out.uvs.push(triangle.map(|i| self.uvs.get(i).copied().unwrap_or_default()));
            out.colors.push(triangle.map(|i| self.colors.get(i).copied().unwrap_or(Vec4::ONE)));
            out.materials.push(self.material);
        }
        dropped
    }
}

/// Whether a position is finite and within [`MAX_COORDINATE`].
pub(crate) fn is_usable(p: &Vec3) -> bool {
    p.is_finite() && p.abs().max_element() <= MAX_COORDINATE
}

/// Unit normal of a triangle of any size; y for a degenerate one.
pub(crate) fn face_normal([a, b, c]: [Vec3; 3]) -> Vec3 {
    let (u, v) = ((b - a).as_dvec3(), (c - a).as_dvec3());
    u.cross(v).normalize_or(glam::DVec3::Y).as_vec3()
}

/// Normal transformation: the inverse transpose up to a factor, signed so that normals keep pointing outwards under
/// mirroring.
fn signed_cofactors(m: Mat3, mirrored: bool) -> Mat3A {
    let sign = if mirrored { -1.0 } else { 1.0 };
    let [x, y, z] = [m.x_axis, m.y_axis, m.z_axis];
    Mat3A::from_cols((y.cross(z) * sign).into(), (z.cross(x) * sign).into(), (x.cross(y) * sign).into())
}

fn transformed_tangent(m: Mat3, tangent: Vec4, mirrored: bool) -> Vec4 {
    let direction = (m * tangent.truncate()).normalize_or_zero();
    direction.extend(if mirrored { -tangent.w } else { tangent.w })
}

/// The tangent made orthogonal to the normal; an arbitrary orthogonal direction if the tangent is not usable.
fn orthogonal_tangent(normal: Vec3, tangent: Vec4) -> Vec4 {
    let t = tangent.truncate();
    let flat = t - normal * normal.dot(t);
    let sign = if tangent.w < 0.0 { -1.0 } else { 1.0 };
    // A component below 1e-6 of the length is rounding error.
    if flat.is_finite() && flat.length_squared() > 1e-12 {
        flat.normalize().extend(sign)
    } else {
        normal.any_orthonormal_vector().extend(sign)
    }
}
