//! Material extensions.

use super::material_reader::Reader;
use super::uv::array_of;
use crate::error::InputError;
use crate::scene::{Alpha, TextureRef};
use gltf::json::extensions::material::Material as Extensions;
use gltf::json::texture;
use serde_json::Value;

/// Smallest attenuation color, because the absorption coefficient is its logarithm.
const DARKEST: f32 = 1e-6;

pub(super) fn read(r: &mut Reader, extensions: &Extensions) -> Result<(), InputError> {
    if let Some(strength) = &extensions.emissive_strength {
        r.material.emissive = r.material.emissive.map(|c| c * strength.emissive_strength.0);
    }
    if let Some(ior) = &extensions.ior {
        // KHR_materials_ior defines 0 as infinity, for files converted from specular-glossiness.
        r.material.ior = if ior.ior.0 == 0.0 { MAX_IOR } else { r.clamped(ior.ior.0, 1.0, MAX_IOR) };
    }
    if let Some(specular) = &extensions.specular {
        r.material.specular = r.clamped(specular.specular_factor.0, 0.0, 1.0);
        r.material.specular_color = specular.specular_color_factor.0.map(|c| r.clamped(c, 0.0, 1e3));
        r.material.specular_texture = r.texture(specular.specular_texture.as_ref())?;
        r.material.specular_color_texture = r.texture(specular.specular_color_texture.as_ref())?;
    }
    if let Some(transmission) = &extensions.transmission {
        r.material.transmission = r.clamped(transmission.transmission_factor.0, 0.0, 1.0);
        r.material.transmission_texture = r.texture(transmission.transmission_texture.as_ref())?;
    }
    if let Some(volume) = &extensions.volume {
        r.material.volume = volume.thickness_factor.0 > 0.0;
        let distance = volume.attenuation_distance.0;
        let color = volume.attenuation_color.0.map(|c| r.clamped(c, 0.0, 1.0));
        if distance > 0.0 {
            r.material.absorption =
                color.map(|c| -c.max(DARKEST).ln() / distance).map(|a| a.clamp(0.0, MAX_ABSORPTION));
        } else {
            r.warn("attenuation distances of 0 or less are not used");
        }
    }
    let others = &extensions.others;
    if let Some(coat) = others.get("KHR_materials_clearcoat") {
        r.material.clearcoat = factor(r, coat, "clearcoatFactor");
        r.material.clearcoat_texture = texture_of(r, coat, "clearcoatTexture")?;
        r.material.clearcoat_roughness = factor(r, coat, "clearcoatRoughnessFactor");
        r.material.clearcoat_roughness_texture = texture_of(r, coat, "clearcoatRoughnessTexture")?;
        if coat.get("clearcoatNormalTexture").is_some() {
            r.warn("normal maps of coats are left out");
        }
    }
    if let Some(sheen) = others.get("KHR_materials_sheen") {
        let color = array_of(sheen.get("sheenColorFactor")).unwrap_or([0.0; 3]);
        r.material.sheen_color = color.map(|c| r.clamped(c, 0.0, 1.0));
        r.material.sheen_color_texture = texture_of(r, sheen, "sheenColorTexture")?;
        r.material.sheen_roughness = factor(r, sheen, "sheenRoughnessFactor");
        r.material.sheen_roughness_texture = texture_of(r, sheen, "sheenRoughnessTexture")?;
    }
    if let Some(anisotropy) = others.get("KHR_materials_anisotropy") {
        r.material.anisotropy = factor(r, anisotropy, "anisotropyStrength");
        let turn = anisotropy.get("anisotropyRotation").and_then(Value::as_f64).unwrap_or(0.0) as f32;
        if turn != 0.0 && r.material.normal_texture.is_some() {
            r.warn("rotations of anisotropy are left out where there is a normal map");
        } else if turn.is_finite() {
            r.tangent_turn = turn;
        }
        if anisotropy.get("anisotropyTexture").is_some() {
            r.warn("textures of anisotropy are left out");
        }
    }
    if others.contains_key("KHR_materials_unlit") {
        unlit(r);
    }
    Ok(())
}

/// Largest index of refraction: reflects 99.6 % at normal incidence.
const MAX_IOR: f32 = 1e3;
/// Largest absorption coefficient in 1/m: black within a micrometre.
const MAX_ABSORPTION: f32 = 1e7;

/// Emulates an unlit material: emits the base color and reflects nothing. Opacity is kept.
fn unlit(r: &mut Reader) {
    let m = &mut r.material;
    m.emissive = m.base_color;
    m.emissive_texture = m.base_color_texture;
    m.base_color = [0.0; 3];
    m.metallic = 0.0;
    m.specular = 0.0;
    m.transmission = 0.0;
    m.clearcoat = 0.0;
    m.sheen_color = [0.0; 3];
    if m.alpha == Alpha::Opaque {
        m.base_color_texture = None;
    }
    r.warn("unlit materials emit their base color, and so light what is around them");
}

/// Factor in 0 to 1 with a default of 0.
fn factor(r: &mut Reader, extension: &Value, name: &str) -> f32 {
    r.clamped(extension.get(name).and_then(Value::as_f64).unwrap_or(0.0) as f32, 0.0, 1.0)
}

/// Texture of an extension that the crate `gltf` leaves as JSON.
fn texture_of(r: &mut Reader, extension: &Value, name: &str) -> Result<Option<TextureRef>, InputError> {
    let info = texture_info(r, extension, name);
    r.texture(info.as_ref())
}

pub(super) fn texture_info(r: &mut Reader, extension: &Value, name: &str) -> Option<texture::Info> {
    let value = extension.get(name)?;
    let info = serde_json::from_value::<texture::Info>(value.clone()).ok();
    if info.is_none() {
        r.warn("textures that do not conform to glTF 2.0 are left out");
    }
    info
}
