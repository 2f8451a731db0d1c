//! Where frames come from: stills, EXR sequences, analytic scenes, rendered scenes. All hand out frames in one form.

pub mod analytic;
pub mod cameras;
pub mod exr_file;
pub mod limits;
pub mod motion_check;
pub mod raster;
pub mod scene_camera;
pub mod sequence;
pub mod still;
pub mod traced;

pub use analytic::AnalyticSource;
pub use limits::ReadLimits;
pub use raster::RasterSource;
pub use scene_camera::{SceneCamera, Stance};
pub use sequence::SequenceSource;
pub use still::StillSource;
pub use traced::{TracedSamples, TracedSource};

use crate::error::{FrameError, InputError};
use crate::image::Image;
use crate::trace::sampling::{FoveatedFrame, Guide};
use glam::DMat4;
use std::path::Path;

/// One full-rate frame with what a temporal method needs to know about it.
#[derive(Clone, Debug)]
pub struct SourceFrame {
    /// Linear Rec. 709 colour, scene-referred. Non-finite pixels of the input are black here and counted below.
    pub color: Image<[f32; 3]>,
    /// Distance along the view axis; `f32::INFINITY` (or 1e10) where there is nothing. `None`: not known.
    pub depth: Option<Image<f32>>,
    /// Pixels, y down, previous minus current: `p` was at `p + motion`. `None`: nothing moves.
    pub motion: Option<Image<[f32; 2]>>,
    /// How far the past of each pixel may be believed (1 as usual, 0 not at all), where the source knows what moves without vectors.
    pub trust: Option<Image<f32>>,
    /// Takes a point from this frame's view space (x right, y down, z forward) to the previous frame's; row-major, for column
    /// vectors. `None`: the camera did not move, or its motion is not known.
    pub previous_from_current: Option<[[f32; 4]; 4]>,
    /// Nothing of the previous frame is valid here.
    pub cut: bool,
    /// Colour pixels of the input that were NaN or infinite.
    pub nonfinite: u64,
}

/// What is known about a source before its first frame is read.
#[derive(Clone, Debug, PartialEq)]
pub struct SourceInfo {
    /// As the user named it.
    pub name: String,
    /// Width and height of every frame in pixels.
    pub size: [u32; 2],
    /// Distinct frames; `None` for a source that never ends (analytic scenes).
    pub frames: Option<u64>,
    /// Frames per second, where the input says so.
    pub fps: Option<f32>,
    /// Horizontal field of view in degrees, where the input says so.
    pub hfov_deg: Option<f32>,
    /// The same picture for ever: nothing moves, and every pixel stays the same surface point.
    pub still: bool,
}

/// A stream of frames, by playback index.
///
/// A sequence shorter than the playback goes forwards and backwards (0, 1, ..., n-1, n-2, ..., 1, 0, 1, ...), with motion
/// vectors that follow. Memory does not grow with the number of frames.
pub trait FrameSource {
    /// Facts that hold for all frames.
    fn info(&self) -> &SourceInfo;

    /// The frame at playback position `index`. Positions may be asked for in any order; the vectors always refer to
    /// `index - 1`.
    ///
    /// # Errors
    /// If the file behind it cannot be read or is not what its header promised.
    fn frame(&mut self, index: u64) -> Result<SourceFrame, InputError>;

    /// The same frame as the source foveates it for a gaze in pixels, with samples where `guide` misses them; `None` if it does not, and
    /// a simulator has to.
    ///
    /// # Errors
    /// As for [`frame`](Self::frame).
    fn foveated(
        &mut self,
        _index: u64,
        _gaze_px: [f32; 2],
        _guide: Option<&Guide>,
    ) -> Result<Option<FoveatedFrame>, InputError> {
        Ok(None)
    }

    /// Where the camera stands at playback position `index`; `None` if there is none that can be steered.
    fn stance(&self, _index: u64) -> Option<Stance> {
        None
    }

    /// Takes a camera that can be steered off its path, or with `None` back ([`SceneCamera::steer`]).
    fn steer(&mut self, _index: u64, _before_and_now: Option<[DMat4; 2]>) {}
}

/// What a scene needs to be told; files know it themselves.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SceneOptions {
    /// Width and height in pixels; default 640x360. Refused for files.
    pub size: Option<[u32; 2]>,
    /// Horizontal field of view in degrees; default 70. Files keep their own.
    pub hfov_deg: Option<f32>,
    /// Frames per second; default 60. Files keep their own.
    pub fps: Option<f32>,
}

/// Whether what the user named is a scene, which a renderer makes frames of ([`RasterSource`]), and not frames.
pub fn is_scene(input: &str) -> bool {
    input.starts_with("builtin:") || matches!(extension(Path::new(input)).as_str(), "gltf" | "glb")
}

/// Opens what the user named: a folder of EXR frames, a still (`.exr`, `.png`, `.jpg`, `.jpeg`), or `analytic:NAME`.
///
/// # Errors
/// If it does not exist, cannot be read, or is of a kind that is not read.
pub fn open(input: &str, limits: &ReadLimits, scene: &SceneOptions) -> Result<Box<dyn FrameSource + Send>, InputError> {
    // A scheme in front names a source that is no file. Checked first, so that no file hides it.
    match input.split_once(':') {
        Some(("analytic", name)) => return Ok(Box::new(open_analytic(name, limits, scene)?)),
        _ if is_scene(input) => return Err(scene_error(input)),
        _ => {}
    }
    if let Some([w, h]) = scene.size {
        return Err(InputError::new(
            input,
            format!("has a size of its own, and {w}x{h} was asked for"),
            "give a size for scenes only",
        ));
    }
    let path = Path::new(input);
    if path.is_dir() {
        return Ok(Box::new(SequenceSource::open(path, limits)?));
    }
    match extension(path).as_str() {
        "exr" | "png" | "jpg" | "jpeg" => Ok(Box::new(StillSource::open(path, limits)?)),
        _ if !path.exists() => Err(InputError::new(
            input,
            "does not exist",
            "expected a folder of .exr frames, or a .exr, .png, .jpg or .jpeg file",
        )),
        _ => Err(InputError::new(
            input,
            "is not of a kind that is read",
            "expected a folder of .exr frames, or a .exr, .png, .jpg or .jpeg file",
        )),
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

/// Refuses frames to be rendered that are larger than those that may be read.
fn check_size(subject: &str, [w, h]: [u32; 2], limits: &ReadLimits) -> Result<(), InputError> {
    let pixels = u64::from(w) * u64::from(h);
    if pixels <= limits.max_pixels {
        return Ok(());
    }
    Err(InputError::new(
        subject,
        format!("{w}x{h} pixels are above the limit of {} million", limits.max_pixels / 1_000_000),
        format!("choose a smaller size, or raise the limit with --max-megapixels {}", pixels.div_ceil(1_000_000)),
    ))
}

/// What a renderer says that has lost its device.
fn device_lost(name: &str, lost: &FrameError) -> InputError {
    InputError::new(name, lost.to_string(), "start again, or use --backend cpu where that is possible")
}

fn scene_error(input: &str) -> InputError {
    InputError::new(
        input,
        "is a scene, and scenes need a renderer",
        "expected EXR frames or a still; open it as a RasterSource or a TracedSource",
    )
}

/// The ending of a file name in lower case, without the dot; empty if there is none.
fn extension(path: &Path) -> String {
    path.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default()
}
