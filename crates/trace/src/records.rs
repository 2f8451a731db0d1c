//! Textures and lights in the layout that both tracers read: rows of 16 bytes, described in
//! `shaders/trace/records.wgsl`. Materials and punctual lights are
//! [`shading_records`](afterimage_lab::scene::shading_records).
// Fields are documented in `scene`, under the same names.
#![allow(missing_docs)]

use afterimage_lab::kernel::texel;
use afterimage_lab::scene::{Texture, Wrap};
use bytemuck::{Pod, Zeroable};

/// Bit of [`TextureRecord::addressing`]: the second texture coordinates.
pub const ADDRESSING_SECOND: u32 = 32;

/// A texture's location, addressing and coordinates, three rows.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct TextureRecord {
    /// Row of its first texel, relative to the texels' section; four texels per row.
    pub first: u32,
    pub width: u32,
    pub height: u32,
    /// Wrap mode along u in bits 0 and 1, along v in bits 2 and 3; bit 4 selects nearest filtering, bit 5 the second
    /// texture coordinates.
    pub addressing: u32,
    /// Rows of the transform of texture coordinates; the fourth element is unused.
    pub coordinates: [[f32; 4]; 2],
}

impl TextureRecord {
    /// Converts a texture whose texels begin at row `first`.
    pub fn new(t: &Texture, first: u32) -> Self {
        let wrap = |w: Wrap| match w {
            Wrap::Repeat => texel::WRAP_REPEAT,
            Wrap::Mirror => texel::WRAP_MIRROR,
            Wrap::Clamp => texel::WRAP_CLAMP,
        };
        let addressing = wrap(t.wrap[0]) | wrap(t.wrap[1]) << 2 | u32::from(t.nearest) << 4;
        let addressing = addressing | if t.coordinates.second { ADDRESSING_SECOND } else { 0 };
        let coordinates = t.coordinates.rows.map(|[a, b, c]| [a, b, c, 0.0]);
        Self { first, width: t.size[0], height: t.size[1], addressing, coordinates }
    }
}

/// Kind of a light: emissive triangle.
pub const LIGHT_TRIANGLE: u32 = 0;
/// Kind of a light: punctual.
pub const LIGHT_PUNCTUAL: u32 = 1;
/// Kind of a light: the environment.
pub const LIGHT_ENVIRONMENT: u32 = 2;

/// Mask of the light's index in [`PickRecord::kind_and_index`].
pub const LIGHT_INDEX: u32 = 0x3fff_ffff;

/// A row of the alias table over all lights (Walker's alias method): row i picks light i with probability `keep`,
/// otherwise light `alias`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct PickRecord {
    pub keep: f32,
    pub alias: u32,
    /// Probability that this light is picked.
    pub probability: f32,
    /// Kind of the light in the upper two bits, index of its triangle or punctual light in the others.
    pub kind_and_index: u32,
}

/// A texel of the environment map in two rows of 16 bytes.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct MapRecord {
    pub radiance: [f32; 3],
    /// Probability that this texel is picked.
    pub probability: f32,
    /// `keep` and `alias` as in [`PickRecord`].
    pub keep: f32,
    pub alias: u32,
    pub unused: [f32; 2],
}
