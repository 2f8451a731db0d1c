//! Core glTF materials. `lobes` reads their extensions.

use super::document::Document;
use super::errors::named;
use super::images::Textures;
use super::material_reader::Reader;
use super::uv::{PLAIN_PLAN, UvPlan, UvSource};
use super::warnings::Warnings;
use super::{lobes, spec_gloss};
use crate::error::InputError;
use crate::scene::{Alpha, Coordinates, Material};
use gltf::json;
use gltf::json::material::AlphaMode;
use gltf::json::validation::Checked;

/// Largest emitted radiance, so that sums stay finite.
const MAX_EMISSION: f32 = 1e12;

/// A material, and the vertex attributes that it needs.
pub(super) struct Surface {
    pub material: Material,
    pub uv: UvPlan,
    /// Coordinates along which tangents point.
    pub tangents: Coordinates,
    pub textured: bool,
    pub needs_tangents: bool,
    /// Rotation of tangents about the normal, in radians.
    pub tangent_turn: f32,
}

/// glTF's default material, for primitives without one.
pub(super) fn default() -> Surface {
    let material = Material { metallic: 1.0, double_sided: false, ..Material::default() };
    Surface {
        material,
        uv: PLAIN_PLAN,
        tangents: Coordinates::default(),
        textured: false,
        needs_tangents: false,
        tangent_turn: 0.0,
    }
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
    let name = named("material", index, json.name.as_deref());
    // Read twice: how a texture finds its coordinates depends on all of them.
    let mut unheard = Warnings::default();
    let mut collected = Reader::new(json, textures, &mut unheard, name.clone(), None);
    let normal = material(&mut collected, json)?;
    let sources = collected.sources;
    let plan = UvPlan::of(&sources, warnings, || name.clone());
    let mut r = Reader::new(json, textures, warnings, name, Some(plan));
    material(&mut r, json)?;
    let normal = normal.filter(|_| r.material.normal_texture.is_some()).or(sources.first().copied());
    Ok(Surface {
        uv: plan,
        tangents: normal.map(|source| plan.coordinates(&source)).unwrap_or_default(),
        textured: !sources.is_empty(),
        needs_tangents: r.material.normal_texture.is_some() || r.material.anisotropy > 0.0,
        tangent_turn: r.tangent_turn,
        material: r.material,
    })
}

/// Reads all of a material, and returns the source of its normal map's coordinates.
fn material(r: &mut Reader, json: &json::Material) -> Result<Option<UvSource>, InputError> {
    // The base color texture first: its coordinates are the first ones.
    match json.extensions.as_ref().and_then(|e| e.others.get(spec_gloss::NAME)) {
        Some(extension) => spec_gloss::read(r, extension)?,
        None => metallic_roughness(r, &json.pbr_metallic_roughness)?,
    }
    let mut of_normals = None;
    if let Some(normal) = &json.normal_texture {
        let transform = normal.extensions.as_ref().and_then(|e| e.others.get("KHR_texture_transform"));
        let source = UvSource::of_value(normal.tex_coord, transform);
        of_normals = Some(source);
        r.material.normal_texture = r.sourced_texture(normal.index, source, None)?;
        r.material.normal_scale = r.clamped(normal.scale, -1e3, 1e3);
    }
    r.material.emissive = json.emissive_factor.0;
    r.material.emissive_texture = r.texture(json.emissive_texture.as_ref())?;
    let cutoff = json.alpha_cutoff.map_or(0.5, |c| c.0);
    r.material.alpha = match json.alpha_mode {
        Checked::Valid(AlphaMode::Mask) => Alpha::Mask { cutoff: r.clamped(cutoff, 0.0, f32::MAX) },
        Checked::Valid(AlphaMode::Blend) => Alpha::Blend,
        Checked::Valid(AlphaMode::Opaque) => Alpha::Opaque,
        Checked::Invalid => {
            r.warn("materials with an unknown alphaMode are opaque");
            Alpha::Opaque
        }
    };
    if let Some(extensions) = &json.extensions {
        lobes::read(r, extensions)?;
    }
    r.material.emissive = r.material.emissive.map(|c| r.clamped(c, 0.0, MAX_EMISSION));
    Ok(of_normals)
}

fn metallic_roughness(r: &mut Reader, pbr: &json::material::PbrMetallicRoughness) -> Result<(), InputError> {
    let [red, green, blue, opacity] = pbr.base_color_factor.0;
    r.material.base_color = [red, green, blue].map(|c| r.clamped(c, 0.0, 1.0));
    r.material.opacity = r.clamped(opacity, 0.0, 1.0);
    r.material.base_color_texture = r.texture(pbr.base_color_texture.as_ref())?;
    r.material.metallic = r.clamped(pbr.metallic_factor.0, 0.0, 1.0);
    r.material.roughness = r.clamped(pbr.roughness_factor.0, 0.0, 1.0);
    r.material.metallic_roughness_texture = r.texture(pbr.metallic_roughness_texture.as_ref())?;
    Ok(())
}
