//! Materials and punctual lights in the layout that shaders read: rows of 16 bytes.
// Fields are documented in `scene`, under the same names.
#![allow(missing_docs)]

use super::{Alpha, Material, PunctualKind, PunctualLight, TextureRef};
use bytemuck::{Pod, Zeroable};

/// Texture index of a material that has no such texture.
pub const NO_TEXTURE: u32 = u32::MAX;

/// Alpha mode MASK: the surface is absent where opacity is below the cutoff.
pub const FLAG_MASK: u32 = 1;
/// Alpha mode BLEND: the surface is present with the probability of its opacity.
pub const FLAG_BLEND: u32 = 2;
/// Both sides of the surface emit.
pub const FLAG_DOUBLE_SIDED: u32 = 4;
/// The surface encloses a volume that refracts.
pub const FLAG_VOLUME: u32 = 8;

/// A [`Material`] in 12 rows of 16 bytes.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct MaterialRecord {
    pub base_color: [f32; 3],
    pub opacity: f32,
    pub emissive: [f32; 3],
    pub cutoff: f32,
    pub metallic: f32,
    pub roughness: f32,
    pub specular: f32,
    pub ior: f32,
    pub specular_color: [f32; 3],
    pub specular_tint: f32,
    pub sheen_color: [f32; 3],
    pub sheen_roughness: f32,
    pub anisotropy: f32,
    pub clearcoat: f32,
    pub clearcoat_roughness: f32,
    pub transmission: f32,
    pub absorption: [f32; 3],
    pub normal_scale: f32,
    pub phong_specular: [f32; 3],
    pub phong_exponent: f32,
    pub flags: u32,
    pub sheen_tint: f32,
    pub base_color_texture: u32,
    pub metallic_roughness_texture: u32,
    pub normal_texture: u32,
    pub emissive_texture: u32,
    pub specular_texture: u32,
    pub specular_color_texture: u32,
    pub clearcoat_texture: u32,
    pub clearcoat_roughness_texture: u32,
    pub sheen_color_texture: u32,
    pub sheen_roughness_texture: u32,
    pub transmission_texture: u32,
    pub phong_diffuse: f32,
    pub unused: [f32; 2],
}

impl MaterialRecord {
    /// Converts a material.
    pub fn new(m: &Material) -> Self {
        let texture = |t: Option<TextureRef>| t.map_or(NO_TEXTURE, |t| t.texture);
        let (alpha_flag, cutoff) = match m.alpha {
            Alpha::Opaque => (0, 0.0),
            Alpha::Mask { cutoff } => (FLAG_MASK, cutoff),
            Alpha::Blend => (FLAG_BLEND, 0.0),
        };
        let flag = |bit: u32, on: bool| if on { bit } else { 0 };
        // Without explicit Phong parameters, metal and dielectric reflection become the Phong highlight.
        let alpha = (m.roughness * m.roughness).max(0.03);
        let dielectric = 0.04 * m.specular * (1.0 - m.metallic);
        let derived = m.base_color.map(|c| c * m.metallic + dielectric);
        let (phong_specular, phong_exponent) =
            m.phong.map_or((derived, 2.0 / (alpha * alpha) - 2.0), |p| (p.specular, p.exponent));
        let diffuse_share = 1.0 - m.metallic;
        // A surface that does not transmit light has no interior that absorbs it.
        let absorption = if m.volume && m.transmission > 0.0 { m.absorption } else { [0.0; 3] };
        Self {
            base_color: m.base_color,
            opacity: m.opacity,
            emissive: m.emissive,
            cutoff,
            metallic: m.metallic,
            roughness: m.roughness,
            specular: m.specular,
            ior: m.ior,
            specular_color: m.specular_color,
            specular_tint: m.specular_tint,
            sheen_color: m.sheen_color,
            sheen_roughness: m.sheen_roughness,
            anisotropy: m.anisotropy,
            clearcoat: m.clearcoat,
            clearcoat_roughness: m.clearcoat_roughness,
            transmission: m.transmission,
            absorption,
            normal_scale: m.normal_scale,
            phong_specular,
            phong_exponent,
            flags: alpha_flag | flag(FLAG_DOUBLE_SIDED, m.double_sided) | flag(FLAG_VOLUME, m.volume),
            sheen_tint: m.sheen_tint,
            base_color_texture: texture(m.base_color_texture),
            metallic_roughness_texture: texture(m.metallic_roughness_texture),
            normal_texture: texture(m.normal_texture),
            emissive_texture: texture(m.emissive_texture),
            specular_texture: texture(m.specular_texture),
            specular_color_texture: texture(m.specular_color_texture),
            clearcoat_texture: texture(m.clearcoat_texture),
            clearcoat_roughness_texture: texture(m.clearcoat_roughness_texture),
            sheen_color_texture: texture(m.sheen_color_texture),
            sheen_roughness_texture: texture(m.sheen_roughness_texture),
            transmission_texture: texture(m.transmission_texture),
            phong_diffuse: diffuse_share,
            unused: [0.0; 2],
        }
    }
}

/// A [`PunctualLight`] in four rows of 16 bytes.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct PunctualRecord {
    pub position: [f32; 3],
    /// 0 directional, 1 point, 2 spot.
    pub kind: u32,
    pub direction: [f32; 3],
    pub range: f32,
    pub intensity: [f32; 3],
    pub cos_inner: f32,
    pub cos_outer: f32,
    pub unused: [f32; 3],
}

impl PunctualRecord {
    /// Converts a light.
    pub fn new(l: &PunctualLight) -> Self {
        let (kind, cos_inner, cos_outer) = match l.kind {
            PunctualKind::Directional => (0, 0.0, 0.0),
            PunctualKind::Point => (1, 0.0, 0.0),
            PunctualKind::Spot { cos_inner, cos_outer } => (2, cos_inner, cos_outer),
        };
        Self {
            position: l.position.to_array(),
            kind,
            direction: l.direction.to_array(),
            range: l.range,
            intensity: l.intensity,
            cos_inner,
            cos_outer,
            unused: [0.0; 3],
        }
    }
}
