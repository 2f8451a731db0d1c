//! Requirements of a context: device limits, and storage of its history.

use super::output::{is_storable, texel};
use super::recorder::STORED;
use super::{history, quads};
use crate::context::{ContextDesc, check_size};
use crate::error::{CreateError, FrameError, SettingsError};
use crate::foveation::FoveationKind;
use crate::settings::Settings;
use crate::uniforms::MAX_VIEWS;
use wgpu::{Device, Limits, TextureFormat};

/// Checks a description and an output format against a device.
pub(crate) fn validate(device: &Device, desc: &ContextDesc, output: TextureFormat) -> Result<(), CreateError> {
    desc.validate()?;
    if desc.has_albedo && desc.keep_alpha {
        let expected = "false; or no keep_alpha, which has the same place in history".into();
        let found = "true".into();
        return Err(CreateError::Settings(SettingsError { setting: "has_albedo", found, expected }));
    }
    texel(device, output)?;
    if desc.view_count as usize > MAX_VIEWS {
        return Err(CreateError::Settings(SettingsError {
            setting: "view_count",
            found: desc.view_count.to_string(),
            expected: format!("at most {MAX_VIEWS} views"),
        }));
    }
    match lacking(device, desc) {
        Some(Lacking { limit, found, needed }) => Err(CreateError::Limit { limit, found, needed }),
        None => Ok(()),
    }
}

/// A limit of a device that is too low.
struct Lacking {
    limit: &'static str,
    found: u64,
    needed: u64,
}

/// The first limit of `device` that is too low for a context.
fn lacking(device: &Device, desc: &ContextDesc) -> Option<Lacking> {
    let (limits, needed) = (device.limits(), required_limits(desc));
    let checks = compared(&limits).into_iter().zip(compared(&needed));
    let mut checks = checks.map(|((limit, found), (_, needed))| Lacking { limit, found, needed });
    checks.find(|check| check.found < check.needed)
}

/// Checks that `device` can have history in its storage textures. wgpu's GL backend cannot.
pub(super) fn check_history(device: &Device) -> Result<(), CreateError> {
    match STORED.into_iter().find(|&format| !is_storable(device, format)) {
        Some(needed) => Err(CreateError::HistoryFormat { needed, backend: device.adapter_info().backend }),
        None => Ok(()),
    }
}

/// Checks a new size of a context's views against the device.
pub(super) fn check_resize(device: &Device, desc: &ContextDesc, size_px: [u32; 2]) -> Result<(), FrameError> {
    check_size(size_px)?;
    let desc = ContextDesc { size_px, ..*desc };
    let max = device.limits().max_texture_dimension_2d;
    if largest_side(&desc) > max {
        return Err(FrameError::Extent { size: size_px, max });
    }
    match lacking(device, &desc) {
        Some(Lacking { limit, found, needed }) => Err(FrameError::Limit { size: size_px, limit, found, needed }),
        None => Ok(()),
    }
}

/// Checks new settings of a context against the device.
pub(super) fn check_settings(device: &Device, desc: &ContextDesc, settings: &Settings) -> Result<(), SettingsError> {
    settings.validate()?;
    desc.check_albedo(settings)?;
    match lacking(device, &ContextDesc { settings: *settings, ..*desc }) {
        Some(Lacking { limit, found, needed }) => {
            let [width, height] = desc.size_px;
            let expected = format!(
                "at least {needed} for these settings at {width}x{height}; request the device with Afterimage::required_limits()"
            );
            Err(SettingsError { setting: limit, found: found.to_string(), expected })
        }
        None => Ok(()),
    }
}

/// The limits that a context can exceed, by name.
fn compared(limits: &Limits) -> [(&'static str, u64); 10] {
    [
        ("max_texture_dimension_2d", limits.max_texture_dimension_2d.into()),
        ("max_texture_array_layers", limits.max_texture_array_layers.into()),
        ("max_sampled_textures_per_shader_stage", limits.max_sampled_textures_per_shader_stage.into()),
        ("max_storage_textures_per_shader_stage", limits.max_storage_textures_per_shader_stage.into()),
        ("max_storage_buffers_per_shader_stage", limits.max_storage_buffers_per_shader_stage.into()),
        ("max_uniform_buffers_per_shader_stage", limits.max_uniform_buffers_per_shader_stage.into()),
        ("max_storage_buffer_binding_size", limits.max_storage_buffer_binding_size),
        ("max_buffer_size", limits.max_buffer_size),
        ("max_compute_invocations_per_workgroup", limits.max_compute_invocations_per_workgroup.into()),
        ("max_compute_workgroups_per_dimension", limits.max_compute_workgroups_per_dimension.into()),
    ]
}

pub(super) fn required_limits(desc: &ContextDesc) -> Limits {
    let least = Limits::downlevel_defaults();
    let by_quads = desc.settings.foveation.kind == FoveationKind::Quads;
    let list = if by_quads { quads::list_bytes(desc) } else { 0 };
    Limits {
        max_texture_dimension_2d: largest_side(desc),
        max_texture_array_layers: desc.view_count,
        max_storage_buffer_binding_size: list.max(least.max_storage_buffer_binding_size),
        max_buffer_size: list.max(least.max_buffer_size),
        // One workgroup a row of pixels.
        max_compute_workgroups_per_dimension: desc.size_px[1].max(least.max_compute_workgroups_per_dimension),
        ..least
    }
}

/// Largest side of the textures of a context, in texels.
fn largest_side(desc: &ContextDesc) -> u32 {
    let sides = [desc.size_px, history::largest_size(desc)];
    sides.into_iter().flatten().fold(1, u32::max)
}
