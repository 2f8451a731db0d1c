//! Textures.

use glam::Vec2;

/// An 8 bit RGBA texture. Texels are encoded as in the file; whether that is sRGB depends on the material slot that
/// uses it.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    /// Width and height in texels, 1 or more.
    pub size: [u32; 2],
    /// Texels in row-major order, top row (v = 0) first.
    pub texels: Vec<[u8; 4]>,
    /// Wrap mode along u and v.
    pub wrap: [Wrap; 2],
    /// Nearest instead of bilinear filtering.
    pub nearest: bool,
    /// Which texture coordinates it takes.
    pub coordinates: Coordinates,
}

/// Texture coordinates of a texture: a set of the triangles', and an affine transform.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coordinates {
    /// [`Triangles::second_uvs`](super::Triangles::second_uvs) instead of [`Triangles::uvs`](super::Triangles::uvs).
    pub second: bool,
    /// Rows of a 2x3 matrix: u is `rows[0]`, and v is `rows[1]`, times (u, v, 1).
    pub rows: [[f32; 3]; 2],
}

/// Bound of transformed texture coordinates, which keeps them finite.
const MAX_COORDINATE: f32 = 1e9;

impl Coordinates {
    /// The transform of coordinates of its set. Twin: `coordinates_of` in `trace/shaders/trace/texture.wgsl`.
    #[inline(always)]
    pub fn of(&self, uv: Vec2) -> Vec2 {
        let row = |r: [f32; 3]| ((r[0] * uv.x + r[2]) + r[1] * uv.y).clamp(-MAX_COORDINATE, MAX_COORDINATE);
        Vec2::new(row(self.rows[0]), row(self.rows[1]))
    }
}

impl Default for Coordinates {
    /// The first set as it is.
    fn default() -> Self {
        Self { second: false, rows: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]] }
    }
}

/// Wrap mode: the texture outside of 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wrap {
    /// Repeated.
    Repeat,
    /// Repeated, every second copy mirrored.
    Mirror,
    /// Clamped to the edge.
    Clamp,
}
