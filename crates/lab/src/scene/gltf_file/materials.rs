//! Core glTF materials. `lobes` reads their extensions.

use super::document::Document;
use super::errors::named;
use super::images::Textures;
use super::lobes;
use super::material_reader::Reader;
use super::uv::{PLAIN, UvSource, common_source};
use super::warnings::Warnings;
use crate::error::InputError;
use crate::scene::{Alpha, Material};
use gltf::json;
use gltf::json::material::AlphaMode;
use gltf::json::validation::Checked;

/// Largest emitted radiance, so that sums stay finite.
const MAX_EMISSION: f32 = 1e12;

/// A material, and the vertex attributes that it needs.
pub(super) struct Surface {
    pub material: Material,
    pub uv: UvSource,
    pub textured: bool,
    pub needs_tangents: bool,
    /// Rotation of tangents about the normal, in radians.
    pub tangent_turn: f32,
}

/// glTF's default material, for primitives without one.
pub(super) fn default() -> Surface {
    let material = Material { metallic: 1.0, double_sided: false, ..Material::default() };
    Surface { material, uv: PLAIN, textured: false, needs_tangents: false, tangent_turn: 0.0 }
}

/// All materials of the file, in its order.
pub(super) fn read<'a>(
    document: &Document<'a>,
    textures: &mut Textures<'a>,
    warnings: &mut Warnings,
) -> Result<Vec<Surface>, InputError> {
    let materials = document.root.materials.iter().enumerate();
    materials.map(|(i, json)| surface(i, json, textures, warnings)).collect()
}

fn surface(
    index: usize,
    json: &json::Material,
    textures: &mut Textures,
    warnings: &mut Warnings,
) -> Result<Surface, InputError> {
    let name = json.name.clone().unwrap_or_default();
    let mut r = Reader {
        textures,
        warnings,
        name: named("material", index, Some(&name)),
        material: Material { name, double_sided: json.double_sided, ..Material::default() },
        tangent_turn: 0.0,
        sources: Vec::new(),
    };
    let pbr = &json.pbr_metallic_roughness;
    let [red, green, blue, opacity] = pbr.base_color_factor.0;
    r.material.base_color = [red, green, blue].map(|c| r.clamped(c, 0.0, 1.0));
    r.material.opacity = r.clamped(opacity, 0.0, 1.0);
    // The base color texture first: all textures of the material use the first one's coordinates.
    r.material.base_color_texture = r.texture(pbr.base_color_texture.as_ref())?;
    r.material.metallic = r.clamped(pbr.metallic_factor.0, 0.0, 1.0);
    r.material.roughness = r.clamped(pbr.roughness_factor.0, 0.0, 1.0);
    r.material.metallic_roughness_texture = r.texture(pbr.metallic_roughness_texture.as_ref())?;
    if let Some(normal) = &json.normal_texture {
        r.material.normal_texture = r.textures.use_texture(normal.index)?;
        r.material.normal_scale = r.clamped(normal.scale, -1e3, 1e3);
        let transform = normal.extensions.as_ref().and_then(|e| e.others.get("KHR_texture_transform"));
        r.sources.push(UvSource::of_value(normal.tex_coord, transform));
    }
    r.material.emissive = json.emissive_factor.0;
    r.material.emissive_texture = r.texture(json.emissive_texture.as_ref())?;
    let cutoff = json.alpha_cutoff.map_or(0.5, |c| c.0);
    r.material.alpha = match json.alpha_mode {
        Checked::Valid(AlphaMode::Mask) => Alpha::Mask { cutoff: r.clamped(cutoff, 0.0, f32::MAX) },
        Checked::Valid(AlphaMode::Blend) => Alpha::Blend,
        Checked::Valid(AlphaMode::Opaque) => Alpha::Opaque,
        Checked::Invalid => {
            r.warnings.about("materials with an unknown alphaMode are opaque", || r.name.clone());
            Alpha::Opaque
        }
    };
    if let Some(extensions) = &json.extensions {
        lobes::read(&mut r, extensions)?;
    }
    r.material.emissive = r.material.emissive.map(|c| r.clamped(c, 0.0, MAX_EMISSION));
    let uv = common_source(&r.sources, r.warnings, || r.name.clone());
    Ok(Surface {
        uv,
        textured: !r.sources.is_empty(),
        needs_tangents: r.material.normal_texture.is_some() || r.material.anisotropy > 0.0,
        tangent_turn: r.tangent_turn,
        material: r.material,
    })
}
