//! Images on surfaces.

/// An image as materials use it: 8 bit RGBA, encoded as the file has it (the material's slot says whether that is sRGB).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Texture {
    /// Width and height in texels, 1 or more.
    pub size: [u32; 2],
    /// First row on top, as glTF's v grows.
    pub texels: Vec<[u8; 4]>,
    /// Beyond 0 and 1, along u and v.
    pub wrap: [Wrap; 2],
    /// The nearest texel instead of a blend of four.
    pub nearest: bool,
}

/// What is beyond the edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wrap {
    /// The image again.
    Repeat,
    /// The image again, every second time reversed.
    Mirror,
    /// The texel at the edge.
    Clamp,
}
