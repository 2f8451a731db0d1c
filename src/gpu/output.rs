//! Requirements of a context: output formats and device limits.

use super::MAX_VIEWS;
use crate::error::{CreateError, SettingsError};
use crate::frame::ContextDesc;
use wgpu::{Limits, TextureFormat};

/// WGSL name of an output format.
pub(crate) fn texel(format: TextureFormat) -> Result<&'static str, CreateError> {
    match format {
        TextureFormat::Rgba16Float => Ok("rgba16float"),
        TextureFormat::Rgba32Float => Ok("rgba32float"),
        TextureFormat::Rgba8Unorm => Ok("rgba8unorm"),
        found => Err(CreateError::OutputFormat { found, expected: "Rgba16Float, Rgba32Float, Rgba8Unorm" }),
    }
}

/// Checks a description, an output format and the device's limits.
pub(crate) fn validate(desc: &ContextDesc, output: TextureFormat, limits: &Limits) -> Result<(), CreateError> {
    desc.validate()?;
    texel(output)?;
    if desc.view_count as usize > MAX_VIEWS {
        return Err(CreateError::Settings(SettingsError {
            setting: "view_count",
            found: desc.view_count.to_string(),
            expected: format!("at most {MAX_VIEWS} views"),
        }));
    }
    let needed = required_limits(desc);
    let checks = [
        ("max_texture_dimension_2d", limits.max_texture_dimension_2d, needed.max_texture_dimension_2d),
        (
            "max_storage_textures_per_shader_stage",
            limits.max_storage_textures_per_shader_stage,
            needed.max_storage_textures_per_shader_stage,
        ),
    ];
    match checks.into_iter().find(|(_, found, needed)| found < needed) {
        Some((limit, found, needed)) => Err(CreateError::Limit { limit, found, needed }),
        None => Ok(()),
    }
}

pub(super) fn required_limits(desc: &ContextDesc) -> Limits {
    let defaults = Limits::default();
    let side = desc.size_px[0].max(desc.size_px[1]);
    Limits { max_texture_dimension_2d: side.max(defaults.max_texture_dimension_2d), ..defaults }
}
