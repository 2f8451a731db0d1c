//! Supported extensions.

use super::errors::printable;
use super::warnings::Warnings;
use crate::error::InputError;
use std::collections::BTreeSet;

const SUPPORTED: [&str; 17] = [
    "EXT_mesh_gpu_instancing",
    "KHR_lights_punctual",
    "KHR_materials_anisotropy",
    "KHR_materials_clearcoat",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_sheen",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_volume",
    "KHR_mesh_quantization",
    // Of an application that lets people touch things: nothing to draw.
    "KHR_node_hoverability",
    "KHR_node_selectability",
    "KHR_node_visibility",
    "KHR_texture_transform",
];

/// Largest number of extensions named in warnings, which bounds the output for hostile files.
const MOST_NAMED: usize = 50;

/// Refuses a file that requires an unsupported extension.
pub(super) fn check_required(subject: &str, required: &[String]) -> Result<(), InputError> {
    let Some(missing) = required.iter().find(|name| !SUPPORTED.contains(&name.as_str())) else { return Ok(()) };
    let remedy = match missing.as_str() {
        "KHR_draco_mesh_compression" | "EXT_meshopt_compression" | "KHR_meshopt_compression" => {
            "decompress it first, for instance with gltf-transform"
        }
        "KHR_texture_basisu" | "EXT_texture_webp" | "EXT_texture_avif" | "MSFT_texture_dds" => {
            "convert its textures to PNG or JPEG first, for instance with gltf-transform"
        }
        _ => "export the scene without it",
    };
    Err(InputError::not_supported(
        subject,
        format!("requires the extension {}, which is not supported", printable(missing)),
        remedy,
    ))
}

/// Warns of each unsupported extension in use.
pub(super) fn warn_of_unsupported(used: &[String], warnings: &mut Warnings) {
    let unsupported: BTreeSet<&str> =
        used.iter().map(String::as_str).filter(|name| !SUPPORTED.contains(name)).collect();
    for name in unsupported.iter().take(MOST_NAMED) {
        warnings.add(format!("extension {} is not supported and left out", printable(name)));
    }
    if unsupported.len() > MOST_NAMED {
        warnings.add(format!("{} more extensions are not supported and left out", unsupported.len() - MOST_NAMED));
    }
}
