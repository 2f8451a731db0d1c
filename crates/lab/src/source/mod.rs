//! Frame sources: stills, EXR sequences, analytic scenes and rendered scenes, behind one trait ([`FrameSource`]).

pub mod analytic;

#[cfg(feature = "full")]
pub mod exr_file;
mod gait;
#[cfg(feature = "full")]
pub mod limits;
#[cfg(feature = "full")]
pub mod motion_check;
#[cfg(feature = "full")]
mod open;
#[cfg(feature = "full")]
pub mod raster;
mod request;
#[cfg(feature = "full")]
pub mod scene_camera;
#[cfg(feature = "full")]
pub mod sequence;
#[cfg(feature = "full")]
pub mod still;
#[cfg(feature = "full")]
pub mod traced;
#[cfg(feature = "full")]
pub mod viewed_scene;

pub use analytic::AnalyticSource;
#[cfg(feature = "full")]
pub use limits::ReadLimits;
#[cfg(feature = "full")]
pub use open::{is_scene, open};
#[cfg(feature = "full")]
pub use raster::RasterSource;
pub use request::{FrameRequest, SamplingGuide, Wanted};
#[cfg(feature = "full")]
pub use scene_camera::SceneCamera;
#[cfg(feature = "full")]
pub use sequence::SequenceSource;
#[cfg(feature = "full")]
pub use still::StillSource;
#[cfg(feature = "full")]
pub use traced::{TracedSamples, TracedSource};
#[cfg(feature = "full")]
pub use viewed_scene::{Light, SceneChoice, ViewedScene};

use crate::error::InputError;
use crate::frame::{RenderedFrame, SourceFrame};
use glam::DMat4;

/// Properties of a source that are known before its first frame is read.
#[derive(Clone, Debug, PartialEq)]
pub struct SourceInfo {
    /// Name as the user gave it.
    pub name: String,
    /// Width and height of every frame in pixels.
    pub size: [u32; 2],
    /// Number of distinct frames; `None` for an endless source (analytic scenes).
    pub frames: Option<u64>,
    /// Frames per second, if the input states them.
    pub fps: Option<f32>,
    /// Horizontal field of view in degrees, if the input states it.
    pub hfov_deg: Option<f32>,
    /// Whether all frames show the same picture: nothing moves, and every pixel keeps its surface point.
    pub still: bool,
}

/// Pose of a camera that a viewer can steer, and a speed to steer it with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraPose {
    /// Camera-to-world matrix: x right, y up, looking along -z.
    pub world_from_camera: DMat4,
    /// Walking speed that suits the scene, in m/s: it crosses the scene in about ten seconds.
    pub speed_m_s: f64,
}

/// A stream of frames, by playback index.
///
/// A sequence shorter than the playback is played forwards and backwards (0, 1, ..., n-1, n-2, ..., 1, 0, 1, ...), with
/// motion vectors for the direction of playback. Memory does not grow with the number of frames.
pub trait FrameSource {
    /// Properties that hold for all frames.
    fn info(&self) -> &SourceInfo;

    /// The frame that `request` asks for. Positions may come in any order.
    ///
    /// # Errors
    /// [`Io`](InputError::Io) and [`Invalid`](InputError::Invalid) if the file of the frame cannot be read or
    /// contradicts its header, [`Limit`](InputError::Limit) if it is larger than the limits by now,
    /// [`Device`](InputError::Device) if the renderer failed or lost its device.
    fn render(&mut self, request: &FrameRequest<'_>) -> Result<RenderedFrame, InputError>;

    /// The full-rate frame at playback position `index`: short for [`render`](Self::render).
    ///
    /// # Errors
    /// As for `render`.
    fn frame(&mut self, index: u64) -> Result<SourceFrame, InputError> {
        Ok(self.render(&FrameRequest::full_rate(index))?.reference)
    }

    /// Camera pose at playback position `index`; `None` if the camera cannot be steered.
    fn camera_pose(&self, _index: u64) -> Option<CameraPose> {
        None
    }

    /// Overrides the camera's path from frame `index` on with the poses before and from then; `None` returns it to its
    /// path. See `SceneCamera::steer`. Sources whose camera cannot be steered ignore it.
    fn steer(&mut self, _index: u64, _before_and_now: Option<[DMat4; 2]>) {}
}

/// View parameters of scenes. Files of frames state their own.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SceneOptions {
    /// Width and height in pixels; default 640x360. An error for files of frames.
    pub size: Option<[u32; 2]>,
    /// Horizontal field of view in degrees; default 70. Ignored for files of frames.
    pub hfov_deg: Option<f32>,
    /// Frames per second; default 60. Ignored for files of frames.
    pub fps: Option<f32>,
}
