//! Requirements of a context: output formats and device limits.

use super::MAX_VIEWS;
use crate::error::{CreateError, SettingsError};
use crate::foveation::Filter;
use crate::frame::ContextDesc;
use crate::settings::{Method, Settings};
use wgpu::{Device, Features, Limits, TextureFormat, TextureUsages};

/// Format of a debug view beside the output.
pub(super) const DEBUG_FORMAT: TextureFormat = TextureFormat::Rgba16Float;

/// WGSL name of an output format: one with red, green and blue that compute shaders can write on `device`.
pub(crate) fn texel(device: &Device, format: TextureFormat) -> Result<&'static str, CreateError> {
    let refuse = |expected| Err(CreateError::OutputFormat { found: format, expected });
    let name = match format {
        TextureFormat::Rgba16Float => "rgba16float",
        TextureFormat::Rgba32Float => "rgba32float",
        TextureFormat::Rgba8Unorm => "rgba8unorm",
        TextureFormat::Rgba8Snorm => "rgba8snorm",
        TextureFormat::Bgra8Unorm => "bgra8unorm",
        TextureFormat::Rgb10a2Unorm => "rgb10a2unorm",
        TextureFormat::Rg11b10Ufloat => "rg11b10ufloat",
        TextureFormat::Rgba16Unorm => "rgba16unorm",
        TextureFormat::Rgba16Snorm => "rgba16snorm",
        TextureFormat::Rgba8UnormSrgb | TextureFormat::Bgra8UnormSrgb => {
            return refuse(
                "a format without sRGB encoding, which compute shaders cannot write; Rgba16Float suits most, tone-mapped to the screen afterwards",
            );
        }
        _ => return refuse("Rgba16Float, Rgba32Float, Rgba8Unorm or another storable format with red, green and blue"),
    };
    let specific = Features::TEXTURE_ADAPTER_SPECIFIC_FORMAT_FEATURES;
    let usages = format.guaranteed_format_features(device.features()).allowed_usages;
    let storable = usages.contains(TextureUsages::STORAGE_BINDING) || device.features().contains(specific);
    match format {
        TextureFormat::Bgra8Unorm if !usages.contains(TextureUsages::STORAGE_BINDING) => {
            refuse("a device with Features::BGRA8UNORM_STORAGE, or the format Rgba8Unorm")
        }
        TextureFormat::Rgba16Unorm | TextureFormat::Rgba16Snorm
            if !device.features().contains(Features::TEXTURE_FORMAT_16BIT_NORM) =>
        {
            refuse("a device with Features::TEXTURE_FORMAT_16BIT_NORM, or the format Rgba16Float")
        }
        _ if !storable => {
            refuse("a device with Features::TEXTURE_ADAPTER_SPECIFIC_FORMAT_FEATURES, or the format Rgba16Float")
        }
        _ => Ok(name),
    }
}

/// Refuses settings that only the CPU executor supports so far.
pub(crate) fn check_settings(settings: &Settings) -> Result<(), SettingsError> {
    settings.validate()?;
    if settings.method == Method::Smr && settings.foveation.filter == Filter::Sparse {
        return Err(SettingsError {
            setting: "method",
            found: "smr".into(),
            expected: "none, taa, wrs or taau: smr on sparse frames runs on the CPU only, so far".into(),
        });
    }
    Ok(())
}

/// Checks a description and an output format against a device.
pub(crate) fn validate(device: &Device, desc: &ContextDesc, output: TextureFormat) -> Result<(), CreateError> {
    desc.validate()?;
    check_settings(&desc.settings)?;
    texel(device, output)?;
    if desc.view_count as usize > MAX_VIEWS {
        return Err(CreateError::Settings(SettingsError {
            setting: "view_count",
            found: desc.view_count.to_string(),
            expected: format!("at most {MAX_VIEWS} views"),
        }));
    }
    let (limits, needed) = (device.limits(), required_limits(desc));
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
