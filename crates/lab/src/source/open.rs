//! Opens a source from the name that a user gives.

use super::analytic::{self, AnalyticSource};
use super::exr_file::ChannelNames;
use super::{FrameSource, ReadLimits, SceneOptions, SequenceSource, StillSource};
use crate::error::InputError;
use crate::file_kind::{folder_of_pattern, kind, other_kind};
use std::path::Path;

/// Whether `input` names a scene, which needs a renderer (`RasterSource`, or `TracedSource` of `afterimage-trace`), and
/// not a file of frames.
pub fn is_scene(input: &str) -> bool {
    input.starts_with("builtin:") || matches!(kind(Path::new(input)).as_str(), "gltf" | "glb")
}

/// Opens an input, whose channels are recognised by their names: [`open_named`].
///
/// # Errors
/// As of [`open_named`].
pub fn open(input: &str, limits: &ReadLimits, scene: &SceneOptions) -> Result<Box<dyn FrameSource + Send>, InputError> {
    open_named(input, limits, scene, &ChannelNames::default())
}

/// Opens a folder of EXR frames, a still (`.exr`, `.png`, `.jpg`, `.jpeg`; with another ending, by its first bytes), or
/// `analytic:NAME`.
///
/// # Errors
/// - [`Io`](InputError::Io): the file or folder does not exist or cannot be read.
/// - [`Invalid`](InputError::Invalid): a file is damaged, lacks color, or does not fit the other frames of its
///   sequence.
/// - [`NotSupported`](InputError::NotSupported): the kind of file or a feature of it is not implemented.
/// - [`Limit`](InputError::Limit): a frame has more pixels than `limits` allows.
/// - [`Request`](InputError::Request): `scene` gives a size for a file, there is no analytic scene of that name,
///   `input` is a scene that needs a renderer, or the folder holds no frames.
pub fn open_named(
    input: &str,
    limits: &ReadLimits,
    scene: &SceneOptions,
    names: &ChannelNames,
) -> Result<Box<dyn FrameSource + Send>, InputError> {
    // Schemes first, so that a file of the same name cannot hide them.
    match input.split_once(':') {
        Some(("analytic", name)) => return Ok(Box::new(open_analytic(name, limits, scene)?)),
        _ if is_scene(input) => {
            return Err(InputError::request(
                input,
                "is a scene, and scenes need a renderer",
                "expected EXR frames or a still; open it as a RasterSource or a TracedSource",
            ));
        }
        _ => {}
    }
    if let Some([w, h]) = scene.size {
        return Err(InputError::request(
            input,
            format!("has its own size, but {w}x{h} pixels were requested"),
            "give a size for scenes only",
        ));
    }
    let path = Path::new(input);
    if path.is_dir() {
        return Ok(Box::new(SequenceSource::open_named(path, limits, names)?));
    }
    if let Some(folder) = folder_of_pattern(path) {
        let remedy = format!("give the folder, {}; its frames are sorted by their numbers", folder.display());
        return Err(InputError::request(input, "is a pattern of names", remedy));
    }
    let expected = "expected a folder of .exr frames, a .exr, .png, .jpg or .jpeg file, or a scene (.gltf, .glb)";
    match kind(path).as_str() {
        "exr" | "png" | "jpg" | "jpeg" => Ok(Box::new(StillSource::open_named(path, limits, names)?)),
        _ if !path.exists() => Err(InputError::io(input, "does not exist", expected)),
        _ => Err(match other_kind(path) {
            Some((problem, remedy)) => InputError::not_supported(input, problem, remedy),
            None => InputError::not_supported(input, "is a kind of file that is not supported", expected),
        }),
    }
}

fn open_analytic(name: &str, limits: &ReadLimits, scene: &SceneOptions) -> Result<AnalyticSource, InputError> {
    let size = scene.size.unwrap_or(analytic::DEFAULT_SIZE);
    check_size(&format!("analytic:{name}"), size, limits)?;
    AnalyticSource::new(
        name,
        size,
        scene.hfov_deg.unwrap_or(analytic::DEFAULT_HFOV_DEG),
        scene.fps.unwrap_or(analytic::DEFAULT_FPS),
    )
}

/// Checks the size of frames to render against the limit for frames to read.
pub(super) fn check_size(subject: &str, [w, h]: [u32; 2], limits: &ReadLimits) -> Result<(), InputError> {
    let pixels = u64::from(w) * u64::from(h);
    if pixels <= limits.max_pixels {
        return Ok(());
    }
    Err(InputError::limit(
        limits.exceeded(Some(pixels)),
        subject,
        format!("{w}x{h} pixels are above the limit of {} million", limits.max_pixels / 1_000_000),
        "choose a smaller size, or raise the limit",
    ))
}
