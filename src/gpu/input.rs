//! Validation of a frame before its passes are recorded.

use super::output::DEBUG_FORMAT;
use super::{Afterimage, Frame, Target, Textures};
use crate::context::ContextDesc;
use crate::error::{FrameError, FrameValue};
use crate::frame::Input;
use crate::stats::FrameStats;
use wgpu::{Buffer, BufferUsages, Device, Texture, TextureAspect, TextureFormat, TextureSampleType, TextureUsages};

/// Checks a frame and its target against the device and the context's description.
pub(super) fn check(
    device: &Device,
    desc: &ContextDesc,
    output_format: TextureFormat,
    frame: &Frame<'_>,
    target: &Target<'_>,
) -> Result<(), FrameError> {
    check_inputs(desc, frame)?;
    if let Some(counters) = target.counters {
        check_buffer("counters", counters, FrameStats::COUNTERS_BYTES, "at least FrameStats::COUNTERS_BYTES")?;
    }
    let expected = "the output format given to Afterimage::new; or create a context for this one";
    check_output(desc, "output", target.output, output_format, expected)?;
    check_apart("output", target.output, frame)?;
    let Some(debug) = target.debug else { return Ok(()) };
    check_output(desc, "debug view", debug.output, DEBUG_FORMAT, "Rgba16Float")?;
    check_apart("debug view", debug.output, frame)?;
    let found = device.limits().max_storage_textures_per_shader_stage;
    if found < STORAGE_TEXTURES_WITH_VIEW {
        return Err(FrameError::Value {
            value: FrameValue::DebugView,
            view: 0,
            found: format!("beside the output, on a device with max_storage_textures_per_shader_stage of {found}"),
            expected: "a limit of 5; or Afterimage::record_view",
        });
    }
    Ok(())
}

/// Checks a frame without its target.
pub(super) fn check_inputs(desc: &ContextDesc, frame: &Frame<'_>) -> Result<(), FrameError> {
    frame.check(desc)?;
    frame.inputs().iter().try_for_each(|input| check_input(desc, input))
}

/// Checks that an output shares no layer of a texture with an input: a pass cannot read a layer and write it, not even
/// other regions of it.
fn check_apart(output: &'static str, written: Textures<'_>, frame: &Frame<'_>) -> Result<(), FrameError> {
    for (name, read) in frame.inputs().iter().filter_map(|input| Some((input.name, input.images?.textures()))) {
        let meets = |layers: [Option<u32>; 2]| layers.contains(&None) || layers[0] == layers[1];
        let shared = written.parts().find(|&(a, i)| read.parts().any(|(b, j)| a == b && meets([i, j])));
        if let Some((texture, _)) = shared {
            let problem = format!("which is also the texture of {name}");
            return Err(refuse(output, texture, problem, "a texture of its own, or another layer than any input's"));
        }
    }
    Ok(())
}

/// Checks the parts of a frame that are known before it is shaded.
pub(super) fn check_geometry(desc: &ContextDesc, frame: &Frame<'_>) -> Result<(), FrameError> {
    frame.inputs().iter().filter(|input| input.is_geometry).try_for_each(|input| check_input(desc, input))
}

/// Checks place, usage and format of an input.
fn check_input(desc: &ContextDesc, input: &Input<Textures<'_>, Textures<'_>, Textures<'_>>) -> Result<(), FrameError> {
    let Some(images) = input.images else { return Ok(()) };
    let desc = ContextDesc { size_px: images.size_px(desc.size_px), ..*desc };
    check_textures(&desc, input.name, images.textures(), Afterimage::INPUT_USAGE)?;
    images.textures().iter().try_for_each(|texture| check_readable(input.name, texture, images.channels()))
}

/// Storage textures of a pass that also writes a debug view: output, view, and at most three of history.
const STORAGE_TEXTURES_WITH_VIEW: u32 = 5;

fn check_output(
    desc: &ContextDesc,
    name: &'static str,
    textures: Textures<'_>,
    format: TextureFormat,
    expected: &'static str,
) -> Result<(), FrameError> {
    check_textures(desc, name, textures, Afterimage::OUTPUT_USAGE)?;
    match textures.iter().find(|t| t.format() != format) {
        Some(texture) => Err(refuse(name, texture, "not the right one".into(), expected)),
        None => Ok(()),
    }
}

/// Checks place, layers, samples and usage of an input's or output's textures.
fn check_textures(
    desc: &ContextDesc,
    input: &'static str,
    textures: Textures<'_>,
    usage: TextureUsages,
) -> Result<(), FrameError> {
    let regions = match textures {
        Textures::Layers(texture) => return check_texture(desc, input, texture, usage),
        Textures::Regions(regions) => regions,
    };
    let (found, expected) = (regions.len(), desc.view_count as usize);
    if found != expected {
        return Err(FrameError::ViewCount { found, expected });
    }
    for (view, region) in regions.iter().enumerate() {
        let texture = region.texture;
        check_usage(input, texture, usage)?;
        let size = [texture.width(), texture.height()];
        let end = [0, 1].map(|i| u64::from(region.origin_px[i]) + u64::from(desc.size_px[i]));
        if end[0] > u64::from(size[0]) || end[1] > u64::from(size[1]) {
            let ([x, y], [width, height]) = (region.origin_px, desc.size_px);
            return Err(FrameError::Value {
                value: FrameValue::Region { input },
                view,
                found: format!("a region of {width}x{height} from ({x}, {y}) in a texture of {}x{}", size[0], size[1]),
                expected: "a rectangle of the context's size inside the texture",
            });
        }
        if region.layer >= texture.depth_or_array_layers() {
            let problem = format!("with {} layers, for layer {}", texture.depth_or_array_layers(), region.layer);
            return Err(refuse(input, texture, problem, "a layer that exists"));
        }
    }
    Ok(())
}

/// Checks size, layers, samples and usage of a texture with one layer a view.
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
    if layers != desc.view_count {
        let expected = "a 2D texture with one array layer for each view of the context, or Textures::Regions";
        return Err(refuse(input, texture, format!("with {layers} layers"), expected));
    }
    check_usage(input, texture, usage)
}

/// Checks dimension, samples and usage of a texture.
fn check_usage(input: &'static str, texture: &Texture, usage: TextureUsages) -> Result<(), FrameError> {
    if texture.dimension() != wgpu::TextureDimension::D2 {
        return Err(refuse(input, texture, format!("of dimension {:?}", texture.dimension()), "a 2D texture"));
    }
    if texture.sample_count() != 1 {
        let problem = format!("with {} samples", texture.sample_count());
        return Err(refuse(input, texture, problem, "one sample per pixel; resolve it first"));
    }
    if !texture.usage().contains(usage) {
        let is_written = usage == TextureUsages::STORAGE_BINDING;
        let expected = if is_written { "the usage STORAGE_BINDING" } else { "the usage TEXTURE_BINDING" };
        return Err(refuse(input, texture, "without a required usage".into(), expected));
    }
    Ok(())
}

/// Checks size and usages of a buffer from the caller, which is cleared and written.
pub(super) fn check_buffer(
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
