//! Where frames come from: stills, EXR sequences, analytic scenes, rendered scenes. All hand out frames in one form.

pub mod analytic;

#[cfg(feature = "full")]
pub mod exr_file;
#[cfg(feature = "full")]
pub mod limits;
#[cfg(feature = "full")]
pub mod motion_check;
#[cfg(feature = "full")]
mod open;
#[cfg(feature = "full")]
pub mod raster;
#[cfg(feature = "full")]
pub mod scene_camera;
#[cfg(feature = "full")]
pub mod sequence;
#[cfg(feature = "full")]
pub mod still;
#[cfg(feature = "full")]
pub mod traced;

pub use analytic::AnalyticSource;
#[cfg(feature = "full")]
pub use limits::ReadLimits;
#[cfg(feature = "full")]
pub use open::{is_scene, open};
#[cfg(feature = "full")]
pub use raster::RasterSource;
#[cfg(feature = "full")]
pub use scene_camera::SceneCamera;
#[cfg(feature = "full")]
pub use sequence::SequenceSource;
#[cfg(feature = "full")]
pub use still::StillSource;
#[cfg(feature = "full")]
pub use traced::{TracedSamples, TracedSource};

use crate::error::InputError;
use crate::frame::{FoveatedFrame, Guide, SourceFrame};
use glam::DMat4;

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

/// Where a camera stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stance {
    /// x right, y up, looking along -z.
    pub world_from_camera: DMat4,
    /// How many metres a second are a walk in its scene: through all of it in about ten.
    pub speed_m_s: f64,
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
    /// [`Io`](InputError::Io) and [`Invalid`](InputError::Invalid) if the file of the frame cannot be read or contradicts its
    /// header, [`Limit`](InputError::Limit) if it is larger than the limits by now, [`Device`](InputError::Device) if the renderer
    /// failed or lost its device.
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
