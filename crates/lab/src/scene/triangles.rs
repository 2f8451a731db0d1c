//! A soup of triangles in world space.

use glam::{Vec2, Vec3, Vec4};

/// Triangles in world space, one array an attribute, one entry a triangle. No vertex is shared.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Triangles {
    /// Metres. Counter-clockwise from the front.
    pub positions: Vec<[Vec3; 3]>,
    /// Shading normals of length 1.
    pub normals: Vec<[Vec3; 3]>,
    /// Texture coordinates, (0, 0) at the first texel's corner.
    pub uvs: Vec<[Vec2; 3]>,
    /// Direction of growing u, of length 1, and in w the sign of the bitangent `cross(normal, tangent) * w`, which a
    /// normal map's green points along (up in the image, against growing v). Some direction beside
    /// the normal where the material needs none.
    pub tangents: Vec<[Vec4; 3]>,
    /// Linear factors of the base color, and of alpha in w.
    pub colors: Vec<[Vec4; 3]>,
    /// Index into the scene's materials.
    pub materials: Vec<u32>,
}

impl Triangles {
    /// Number of triangles.
    pub fn len(&self) -> usize {
        self.positions.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.positions.is_empty()
    }

    /// Whether every triangle has an entry in each array.
    pub(crate) fn is_complete(&self) -> bool {
        let others = [self.normals.len(), self.uvs.len(), self.tangents.len(), self.colors.len(), self.materials.len()];
        others == [self.len(); 5]
    }

    /// Makes room for `more` triangles.
    pub(crate) fn reserve(&mut self, more: usize) {
        self.positions.reserve(more);
        self.normals.reserve(more);
        self.uvs.reserve(more);
        self.tangents.reserve(more);
        self.colors.reserve(more);
        self.materials.reserve(more);
    }

    /// Adds all of `other`.
    pub fn extend(&mut self, other: &Self) {
        self.positions.extend_from_slice(&other.positions);
        self.normals.extend_from_slice(&other.normals);
        self.uvs.extend_from_slice(&other.uvs);
        self.tangents.extend_from_slice(&other.tangents);
        self.colors.extend_from_slice(&other.colors);
        self.materials.extend_from_slice(&other.materials);
    }

    /// Adds a triangle with its geometric normal, white, without texture coordinates.
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

    /// Adds the two triangles of a quadrilateral, corners counter-clockwise from the front.
    pub fn push_quad(&mut self, corners: [Vec3; 4], material: u32) {
        let [a, b, c, d] = corners;
        self.push_flat([a, b, c], material);
        self.push_flat([a, c, d], material);
    }
}
