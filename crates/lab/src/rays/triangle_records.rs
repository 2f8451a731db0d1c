//! Triangle records, as the CPU and the tracer's shaders read them.

use crate::kernel::octahedral::{decode_direction, encode_direction};
use crate::kernel::texel::texel_value;
use crate::scene::{Alpha, Material, Triangles};
use bytemuck::{Pod, Zeroable};
use glam::{Vec2, Vec3, Vec3A, Vec4};

/// Material properties stored with each triangle, so that traversal needs no material lookup.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TriangleFlags;

impl TriangleFlags {
    /// Alpha mode MASK or BLEND: hits need an alpha test.
    pub const ALPHA: u32 = 1 << 24;
    /// Emits light.
    pub const EMISSIVE: u32 = 1 << 25;

    /// Flags of a material.
    pub fn of(material: &Material) -> u32 {
        let mut flags = 0;
        if material.alpha != Alpha::Opaque {
            flags |= Self::ALPHA;
        }
        if material.emissive.iter().any(|&e| e > 0.0) {
            flags |= Self::EMISSIVE;
        }
        flags
    }
}

/// A triangle for traversal: three elements of the scene buffer. Each element holds a vertex and one word: material (24
/// bits) with [`TriangleFlags`]; index of the triangle in its source; one plus its row in the light table, or 0 if it
/// does not emit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct TriangleRecord {
    /// Vertex in the first three floats; the fourth holds the word's bits.
    rows: [[f32; 4]; 3],
}

impl TriangleRecord {
    /// Largest material index that fits.
    pub const MAX_MATERIAL: u32 = (1 << 24) - 1;

    pub(super) fn new(triangles: &Triangles, source: u32, materials: &[Material]) -> Self {
        let [v0, v1, v2] = triangles.positions[source as usize];
        let material = triangles.materials.get(source as usize).copied().unwrap_or(0).min(Self::MAX_MATERIAL);
        let flags = materials.get(material as usize).map_or(0, TriangleFlags::of);
        let row = |v: Vec3, word: u32| v.extend(f32::from_bits(word)).to_array();
        Self { rows: [row(v0, material | flags), row(v1, source), row(v2, 0)] }
    }

    /// Corner positions in world space, metres.
    #[inline]
    pub fn positions(&self) -> [Vec3; 3] {
        self.rows.map(|[x, y, z, _]| Vec3::new(x, y, z))
    }

    /// Corner positions as SIMD vectors.
    #[inline(always)]
    pub(super) fn corners(&self) -> [Vec3A; 3] {
        self.rows.map(|row| Vec3A::from_vec4(Vec4::from_array(row)))
    }

    /// Index into the scene's materials.
    #[inline]
    pub fn material(&self) -> u32 {
        self.rows[0][3].to_bits() & Self::MAX_MATERIAL
    }

    /// Whether all of `flags` are set.
    #[inline]
    pub fn has(&self, flags: u32) -> bool {
        self.rows[0][3].to_bits() & flags == flags
    }

    /// Row in the light table; `None` if the triangle does not emit.
    #[inline]
    pub fn light(&self) -> Option<u32> {
        self.rows[2][3].to_bits().checked_sub(1)
    }

    pub(super) fn set_light(&mut self, light: u32) {
        self.rows[2][3] = f32::from_bits(light + 1);
    }

    /// Index in the [`Triangles`] that it was built from.
    #[inline]
    pub fn source(&self) -> u32 {
        self.rows[1][3].to_bits()
    }
}

/// Shading attributes of a triangle: four elements of the scene buffer.
///
/// | words | contents |
/// |---|---|
/// | 0 to 2 | normals, octahedral, two 16-bit signed fractions |
/// | 3, 7, 11 | vertex colors, 8 bits a channel, red lowest |
/// | 4 to 6 | tangents as normals, but the lowest bit is 1 for a bitangent sign of -1 |
/// | 8 to 10, 12 to 14 | texture coordinates, u then v of each vertex, as floats |
/// | 15 | unused |
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct AttributeRecord {
    words: [u32; 16],
}

/// Decoded [`AttributeRecord`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Attributes {
    /// Shading normals, unit length.
    pub normals: [Vec3; 3],
    /// Tangents in xyz, unit length, towards growing u; sign of the bitangent in w.
    pub tangents: [Vec4; 3],
    /// Texture coordinates.
    pub uvs: [Vec2; 3],
    /// Factors of base color and alpha, in steps of 1/255.
    pub colors: [Vec4; 3],
}

/// Second texture coordinates of a triangle: two elements of the scene buffer, u then v of each vertex.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct SecondUvRecord {
    uvs: [[f32; 2]; 4],
}

impl SecondUvRecord {
    pub(super) fn new(triangles: &Triangles, source: usize) -> Self {
        let finite = |uv: Vec2| uv.to_array().map(|x| if x.is_finite() { x } else { 0.0 });
        let [a, b, c] = triangles.second_uvs.get(source).copied().unwrap_or_default().map(finite);
        Self { uvs: [a, b, c, [0.0; 2]] }
    }

    /// At barycentric weights `u` (second corner) and `v` (third corner). Twin: `second_uv_at` in
    /// `trace/shaders/trace/geometry.wgsl`.
    #[inline]
    pub fn at(&self, u: f32, v: f32) -> Vec2 {
        let [a, b, c, _] = self.uvs.map(Vec2::from_array);
        let w = (1.0 - u) - v;
        (a * w + b * u) + c * v
    }
}

/// Interpolated attributes at a point of a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AttributesAt {
    /// Shading normal, not normalized.
    pub normal: Vec3,
    /// Tangent towards growing u, not normalized.
    pub tangent: Vec3,
    /// Sign of the bitangent at the first corner.
    pub bitangent_sign: f32,
    /// Texture coordinates.
    pub uv: Vec2,
    /// Second texture coordinates; zero unless [`Geometry::attributes_at`](super::Geometry::attributes_at) reads them.
    pub second_uv: Vec2,
    /// Factors of base color and alpha.
    pub color: Vec4,
}

impl AttributesAt {
    /// First and second texture coordinates.
    #[inline(always)]
    pub fn uvs(&self) -> [Vec2; 2] {
        [self.uv, self.second_uv]
    }
}

/// Word index of each texture coordinate component.
const UV_WORDS: [usize; 6] = [8, 9, 10, 12, 13, 14];

impl AttributeRecord {
    pub(super) fn new(triangles: &Triangles, source: usize) -> Self {
        let mut words = [0; 16];
        let finite = |x: f32| if x.is_finite() { x } else { 0.0 };
        for vertex in 0..3 {
            if let Some(n) = triangles.normals.get(source) {
                words[vertex] = direction_code(n[vertex]);
            }
            if let Some(t) = triangles.tangents.get(source) {
                words[4 + vertex] = direction_code(t[vertex].truncate()) & !1 | u32::from(t[vertex].w < 0.0);
            }
            if let Some(uv) = triangles.uvs.get(source) {
                words[UV_WORDS[2 * vertex]] = finite(uv[vertex].x).to_bits();
                words[UV_WORDS[2 * vertex + 1]] = finite(uv[vertex].y).to_bits();
            }
            let color = triangles.colors.get(source).map_or(Vec4::ONE, |c| c[vertex]);
            words[3 + 4 * vertex] =
                u32::from_le_bytes(color.to_array().map(|x| (x.clamp(0.0, 1.0) * 255.0).round() as u8));
        }
        Self { words }
    }

    /// Attributes at barycentric weights `u` (second corner) and `v` (third corner). Twin: `attributes_at` in
    /// `trace/shaders/trace/geometry.wgsl`.
    #[inline]
    pub fn at(&self, u: f32, v: f32) -> AttributesAt {
        let Attributes { normals: n, tangents: t, uvs, colors: c } = self.unpack();
        let w = (1.0 - u) - v;
        AttributesAt {
            normal: (n[0] * w + n[1] * u) + n[2] * v,
            tangent: (t[0].truncate() * w + t[1].truncate() * u) + t[2].truncate() * v,
            bitangent_sign: t[0].w,
            uv: (uvs[0] * w + uvs[1] * u) + uvs[2] * v,
            second_uv: Vec2::ZERO,
            // This form returns exactly the corners' color if all three are equal, so white vertex colors change
            // nothing.
            color: (c[0] + (c[1] - c[0]) * u) + (c[2] - c[0]) * v,
        }
    }

    /// Decodes the record.
    #[inline]
    pub fn unpack(&self) -> Attributes {
        let w = &self.words;
        let of = |word: usize| f32::from_bits(w[word]);
        Attributes {
            normals: [0, 1, 2].map(|i| decode_direction(w[i])),
            tangents: [4, 5, 6].map(|i| decode_direction(w[i] & !1).extend(if w[i] & 1 == 0 { 1.0 } else { -1.0 })),
            uvs: [0, 1, 2].map(|i| Vec2::new(of(UV_WORDS[2 * i]), of(UV_WORDS[2 * i + 1]))),
            colors: [3, 7, 11].map(|i| texel_value(w[i])),
        }
    }
}

/// Octahedral code of a direction; code of +z if `n` is zero or not finite.
fn direction_code(n: Vec3) -> u32 {
    let sum = n.abs().element_sum();
    if sum.is_finite() && sum >= f32::MIN_POSITIVE { encode_direction(n) } else { 0 }
}
