//! What is fixed when a context is made, and what it asks of the device.

use super::MAX_VIEWS;
use crate::error::{CreateError, SettingsError};
use crate::frame::ContextDesc;
use crate::settings::Settings;
use wgpu::TextureFormat;

/// Facts that hold from creation on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GpuDesc {
    /// Size, number of views (at most [`MAX_VIEWS`]), conventions.
    pub context: ContextDesc,
    /// Format of the output texture: `Rgba16Float`, `Rgba32Float` or `Rgba8Unorm`.
    pub output_format: TextureFormat,
    /// Tunables; can be changed later.
    pub settings: Settings,
}

impl GpuDesc {
    /// One view of `size_px` with default conventions and settings.
    pub fn new(size_px: [u32; 2], output_format: TextureFormat) -> Self {
        Self { context: ContextDesc::new(size_px), output_format, settings: Settings::default() }
    }

    /// What the output format is called in WGSL.
    pub(crate) fn output_texel(&self) -> Result<&'static str, CreateError> {
        match self.output_format {
            TextureFormat::Rgba16Float => Ok("rgba16float"),
            TextureFormat::Rgba32Float => Ok("rgba32float"),
            TextureFormat::Rgba8Unorm => Ok("rgba8unorm"),
            found => Err(CreateError::OutputFormat { found, expected: "Rgba16Float, Rgba32Float, Rgba8Unorm" }),
        }
    }

    /// Checks everything, the device's limits included.
    pub(crate) fn validate(&self, limits: &wgpu::Limits) -> Result<(), CreateError> {
        self.settings.validate()?;
        self.context.validate()?;
        self.output_texel()?;
        if self.context.view_count as usize > MAX_VIEWS {
            return Err(CreateError::Settings(SettingsError {
                setting: "view_count",
                found: self.context.view_count.to_string(),
                expected: format!("at most {MAX_VIEWS} views"),
            }));
        }
        let needed = self.required_limits();
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

    /// Limits that a device must have: the defaults of WebGPU, or more for large frames. No features are needed.
    pub fn required_limits(&self) -> wgpu::Limits {
        let defaults = wgpu::Limits::default();
        let side = self.context.size_px[0].max(self.context.size_px[1]);
        wgpu::Limits { max_texture_dimension_2d: side.max(defaults.max_texture_dimension_2d), ..defaults }
    }
}
