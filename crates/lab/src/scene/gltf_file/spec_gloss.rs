//! KHR_materials_pbrSpecularGlossiness, the predecessor of metallic-roughness, converted: the same diffuse color and
//! reflectance, without metal, and roughness as one minus glossiness.

use super::lobes::texture_info;
use super::material_reader::Reader;
use super::uv::{UvSource, array_of};
use crate::error::InputError;
use crate::kernel::microfacet::reflectance_at_normal;
use serde_json::Value;

pub(super) const NAME: &str = "KHR_materials_pbrSpecularGlossiness";

/// Reads the extension in the place of the core's metallic-roughness.
pub(super) fn read(r: &mut Reader, extension: &Value) -> Result<(), InputError> {
    let [red, green, blue, opacity] = array_of(extension.get("diffuseFactor")).unwrap_or([1.0; 4]);
    r.material.base_color = [red, green, blue].map(|c| r.clamped(c, 0.0, 1.0));
    r.material.opacity = r.clamped(opacity, 0.0, 1.0);
    let diffuse = texture_info(r, extension, "diffuseTexture");
    r.material.base_color_texture = r.texture(diffuse.as_ref())?;
    let specular = array_of(extension.get("specularFactor")).unwrap_or([1.0; 3]);
    // `specular_color` is a factor of what the index of refraction reflects.
    let unit = reflectance_at_normal(r.material.ior);
    r.material.specular_color = specular.map(|c| r.clamped(c, 0.0, 1.0) / unit);
    // The diffuse color leaves what is reflected, as the extension defines it.
    let glossiness = extension.get("glossinessFactor").and_then(Value::as_f64).unwrap_or(1.0) as f32;
    let glossiness = r.clamped(glossiness, 0.0, 1.0);
    r.material.metallic = 0.0;
    r.material.roughness = 1.0 - glossiness;
    if let Some(info) = texture_info(r, extension, "specularGlossinessTexture") {
        r.material.specular_color_texture = r.texture(Some(&info))?;
        let source = UvSource::of(&info);
        r.material.metallic_roughness_texture = r.sourced_texture(info.index, source, Some(glossiness))?;
        if r.material.metallic_roughness_texture.is_some() {
            r.material.roughness = 1.0;
        }
    }
    Ok(())
}
