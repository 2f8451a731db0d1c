//! Validation of a frame before anything is recorded.

use super::{Frame, Target};
use crate::error::FrameError;
use crate::frame::ContextDesc;
use crate::stats::COUNTERS_BYTES;
use wgpu::{Buffer, BufferUsages, Texture, TextureAspect, TextureFormat, TextureSampleType, TextureUsages};

/// Checks a frame and its target against the context's description.
pub(super) fn check(
    desc: &ContextDesc,
    output_format: TextureFormat,
    frame: &Frame<'_>,
    target: &Target<'_>,
) -> Result<(), FrameError> {
    check_inputs(desc, frame)?;
    if let Some(counters) = target.counters {
        check_words("counters", counters, COUNTERS_BYTES, "at least afterimage::COUNTERS_BYTES")?;
    }
    check_texture(desc, "output", target.output, TextureUsages::STORAGE_BINDING)?;
    if target.output.format() == output_format {
        Ok(())
    } else {
        Err(refuse(
            "output",
            target.output,
            "not the context's".into(),
            "the output format given to Afterimage::new; or create a context for this one",
        ))
    }
}

/// Checks a frame without its target.
pub(super) fn check_inputs(desc: &ContextDesc, frame: &Frame<'_>) -> Result<(), FrameError> {
    frame.check(desc)?;
    let inputs = [
        ("color", Some(frame.color), 3),
        ("depth", frame.depth, 1),
        ("motion", frame.motion, 2),
        ("trust", frame.trust, 1),
        ("lod", frame.lod, 1),
        ("noise", frame.noise, 2),
    ];
    for (input, texture, channels) in inputs {
        if let Some(texture) = texture {
            check_texture(desc, input, texture, TextureUsages::TEXTURE_BINDING)?;
            check_readable(input, texture, channels)?;
        }
    }
    Ok(())
}

/// Checks size, layers, samples and usage of a texture.
pub(crate) fn check_texture(
    desc: &ContextDesc,
    input: &'static str,
    texture: &Texture,
    usage: TextureUsages,
) -> Result<(), FrameError> {
    let found = [texture.width(), texture.height()];
    if found != desc.size_px {
        return Err(FrameError::Size { input, view: 0, found, expected: desc.size_px });
    }
    let layers = texture.depth_or_array_layers();
    if texture.dimension() != wgpu::TextureDimension::D2 || layers != desc.view_count {
        return Err(refuse(
            input,
            texture,
            format!("with {layers} layers"),
            "a 2D texture with one array layer for each view of the context",
        ));
    }
    if texture.sample_count() != 1 {
        let samples = texture.sample_count();
        return Err(refuse(
            input,
            texture,
            format!("with {samples} samples"),
            "one sample per pixel; resolve it first",
        ));
    }
    if !texture.usage().contains(usage) {
        let expected = if usage == TextureUsages::STORAGE_BINDING {
            "the usage STORAGE_BINDING"
        } else {
            "the usage TEXTURE_BINDING"
        };
        return Err(refuse(input, texture, "without a required usage".into(), expected));
    }
    Ok(())
}

/// Checks size and usages of a buffer of the caller's, which is cleared and written.
pub(super) fn check_words(
    input: &'static str,
    buffer: &Buffer,
    bytes: u64,
    expected_size: &'static str,
) -> Result<(), FrameError> {
    let refuse = |problem, expected| Err(FrameError::Buffer { input, problem, expected });
    if buffer.size() < bytes {
        return refuse(format!("of {} bytes", buffer.size()), expected_size);
    }
    if !buffer.usage().contains(BufferUsages::STORAGE | BufferUsages::COPY_DST) {
        return refuse(format!("with the usages {:?}", buffer.usage()), "the usages STORAGE and COPY_DST");
    }
    Ok(())
}

/// Checks that a texture can be read as floats or depth, with at least `channels` channels.
pub(crate) fn check_readable(input: &'static str, texture: &Texture, channels: u8) -> Result<(), FrameError> {
    let format = texture.format();
    let aspect = format.has_depth_aspect().then_some(TextureAspect::DepthOnly);
    let readable =
        matches!(format.sample_type(aspect, None), Some(TextureSampleType::Float { .. } | TextureSampleType::Depth));
    let found = if format.has_depth_aspect() { 1 } else { format.components() };
    if readable && found >= channels {
        return Ok(());
    }
    let expected = match channels {
        1 if input == "depth" => "a depth format or R32Float",
        1 => "a float or normalised format, such as R8Unorm or R16Float",
        2 => "Rg16Float, Rg32Float or wider",
        _ => "a float or normalised format with red, green and blue, such as Rgba16Float",
    };
    Err(refuse(input, texture, "which this input cannot have".into(), expected))
}

fn refuse(input: &'static str, texture: &Texture, problem: String, expected: &'static str) -> FrameError {
    FrameError::Texture { input, format: format!("{:?}", texture.format()), problem, expected }
}
