//! Textures.

/// An 8 bit RGBA texture. Texels are encoded as in the file; whether that is sRGB depends on the material slot that
/// uses it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Texture {
    /// Width and height in texels, 1 or more.
    pub size: [u32; 2],
    /// Texels in row-major order, top row (v = 0) first.
    pub texels: Vec<[u8; 4]>,
    /// Wrap mode along u and v.
    pub wrap: [Wrap; 2],
    /// Nearest instead of bilinear filtering.
    pub nearest: bool,
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
