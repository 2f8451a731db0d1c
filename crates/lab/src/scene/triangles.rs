//! Triangle soup in world space.

use glam::{Vec2, Vec3, Vec4};

/// Triangle soup in world space: one array per attribute, one entry per triangle. Vertices are not shared.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Triangles {
    /// Corners in metres, counter-clockwise seen from the front.
    pub positions: Vec<[Vec3; 3]>,
    /// Unit shading normals.
    pub normals: Vec<[Vec3; 3]>,
    /// Texture coordinates, (0, 0) at the first texel's corner.
    pub uvs: Vec<[Vec2; 3]>,
    /// Second texture coordinates. Triangles after the last one that has them have none, so that they are empty where
    /// no texture takes them.
    pub second_uvs: Vec<[Vec2; 3]>,
    /// Unit tangent in the direction of increasing u; w is the sign of the bitangent `cross(normal, tangent) * w`,
    /// which is the direction of a normal map's green channel (up in the image, decreasing v). An arbitrary direction
    /// orthogonal to the normal if the material needs no tangent.
    pub tangents: Vec<[Vec4; 3]>,
    /// Vertex colors: linear factors of the base color, and of alpha in w.
    pub colors: Vec<[Vec4; 3]>,
    /// Index into the scene's materials.
    pub materials: Vec<u32>,
}

impl Triangles {
    /// Number of triangles.
    pub fn len(&self) -> usize {
        self.positions.len()
    }

    /// Whether there are no triangles.
    pub fn is_empty(&self) -> bool {
        self.positions.is_empty()
    }

    /// Whether every triangle has an entry in each array.
    pub(crate) fn is_complete(&self) -> bool {
        let others = [self.normals.len(), self.uvs.len(), self.tangents.len(), self.colors.len(), self.materials.len()];
        others == [self.len(); 5]
    }

    /// Reserves capacity for `more` triangles.
    pub(crate) fn reserve(&mut self, more: usize) {
        self.positions.reserve(more);
        self.normals.reserve(more);
        self.uvs.reserve(more);
        self.tangents.reserve(more);
        self.colors.reserve(more);
        self.materials.reserve(more);
    }

    /// Appends the triangles of `other`.
    pub fn extend(&mut self, other: &Self) {
        self.positions.extend_from_slice(&other.positions);
        self.normals.extend_from_slice(&other.normals);
        if !other.second_uvs.is_empty() {
            self.second_uvs.resize(self.uvs.len(), [Vec2::ZERO; 3]);
            self.second_uvs.extend_from_slice(&other.second_uvs);
        }
        self.uvs.extend_from_slice(&other.uvs);
        self.tangents.extend_from_slice(&other.tangents);
        self.colors.extend_from_slice(&other.colors);
        self.materials.extend_from_slice(&other.materials);
    }

    /// Appends a white triangle with its geometric normal and no texture coordinates.
    pub fn push_flat(&mut self, positions: [Vec3; 3], material: u32) {
        let [a, b, c] = positions;
        let normal = (b - a).cross(c - a).normalize_or(Vec3::Y);
        self.positions.push(positions);
        self.normals.push([normal; 3]);
        self.uvs.push([Vec2::ZERO; 3]);
        self.tangents.push([normal.any_orthonormal_vector().extend(1.0); 3]);
        self.colors.push([Vec4::ONE; 3]);
        self.materials.push(material);
    }

    /// Appends the two triangles of a quadrilateral. Corners are counter-clockwise seen from the front.
    pub fn push_quad(&mut self, corners: [Vec3; 4], material: u32) {
        let [a, b, c, d] = corners;
        self.push_flat([a, b, c], material);
        self.push_flat([a, c, d], material);
    }
}
