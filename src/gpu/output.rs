//! Output formats, and formats that a device can store.

use crate::error::CreateError;
use crate::kernel::sanitize::MAX_HALF;
use std::future::Future;
use std::task::{Context, Poll, Waker};
use wgpu::{Device, ErrorFilter, Extent3d, Features, TextureDescriptor, TextureFormat, TextureUsages};

/// Format of a debug view beside the output.
pub(super) const DEBUG_FORMAT: TextureFormat = TextureFormat::Rgba16Float;

/// Formats that shaders write, and their names in WGSL. The first ones are those of outputs.
const FORMATS: [(TextureFormat, &str); 14] = [
    (TextureFormat::Rgba16Float, "rgba16float"),
    (TextureFormat::Rgba32Float, "rgba32float"),
    (TextureFormat::Rgba8Unorm, "rgba8unorm"),
    (TextureFormat::Rgba8Snorm, "rgba8snorm"),
    (TextureFormat::Bgra8Unorm, "bgra8unorm"),
    (TextureFormat::Rgb10a2Unorm, "rgb10a2unorm"),
    (TextureFormat::Rg11b10Ufloat, "rg11b10ufloat"),
    (TextureFormat::Rgba16Unorm, "rgba16unorm"),
    (TextureFormat::Rgba16Snorm, "rgba16snorm"),
    (TextureFormat::R32Float, "r32float"),
    (TextureFormat::Rg32Float, "rg32float"),
    (TextureFormat::R32Uint, "r32uint"),
    (TextureFormat::Rg32Uint, "rg32uint"),
    (TextureFormat::Rgba32Uint, "rgba32uint"),
];
const OUTPUTS: usize = 9;

pub(super) fn format_of(name: &str) -> Option<TextureFormat> {
    FORMATS.iter().find(|(_, other)| *other == name).map(|(format, _)| *format)
}

/// WGSL name of an output format: one with red, green and blue that compute shaders can write on `device`.
pub(crate) fn texel(device: &Device, format: TextureFormat) -> Result<&'static str, CreateError> {
    let refuse = |expected| Err(CreateError::OutputFormat { found: format, expected });
    let Some((_, name)) = FORMATS[..OUTPUTS].iter().find(|(other, _)| *other == format) else {
        return refuse(match format {
            TextureFormat::Rgba8UnormSrgb | TextureFormat::Bgra8UnormSrgb => {
                "a format without sRGB encoding, which compute shaders cannot write; Rgba16Float suits most, tone-mapped to the screen afterwards"
            }
            _ => "Rgba16Float, Rgba32Float, Rgba8Unorm or another storable format with red, green and blue",
        });
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
        _ if !is_storable(device, format) => refuse("a format that this adapter can store; Rgba16Float suits most"),
        _ => Ok(name),
    }
}

/// Largest magnitude of a color in an output: of floats of 32 bits all that they can hold, otherwise that of halves.
pub(super) fn largest(format: TextureFormat) -> f32 {
    if format == TextureFormat::Rgba32Float { f32::MAX } else { MAX_HALF }
}

/// Whether compute shaders can write textures of a format. The device says what its features guarantee, but not what
/// its adapter lacks of WebGPU, so that this makes a texture of one texel.
pub(super) fn is_storable(device: &Device, format: TextureFormat) -> bool {
    let scope = device.push_error_scope(ErrorFilter::Validation);
    let _ = device.create_texture(&TextureDescriptor {
        label: Some("afterimage format"),
        size: Extent3d::default(),
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: TextureUsages::STORAGE_BINDING | TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    });
    // In a browser the answer comes later. WebGPU guarantees the formats there.
    let error = std::pin::pin!(scope.pop()).poll(&mut Context::from_waker(Waker::noop()));
    !matches!(error, Poll::Ready(Some(_)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formats_that_cannot_be_stored_are_found() {
        let (device, _) = Device::noop(&wgpu::DeviceDescriptor::default());
        assert!(is_storable(&device, TextureFormat::Rg32Uint));
        // As Rg32Uint on wgpu's GL backend.
        assert!(!is_storable(&device, TextureFormat::Rgba8UnormSrgb));
        assert!(!is_storable(&device, TextureFormat::Rg16Float));
    }
}
