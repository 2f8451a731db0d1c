//! Frame sources behind one trait ([`FrameSource`]), and those without a renderer: analytic scenes.

pub mod analytic;
pub mod gait;
mod reference;
mod request;

pub use analytic::AnalyticSource;
pub use reference::reference_offsets_px;
pub use request::{FrameRequest, Wanted};

use crate::error::InputError;
use crate::frame::{RenderedFrame, Shaded, ShadingRequest, SourceFrame};
use glam::{DMat4, DVec3};

/// Properties of a source that are known before its first frame is read.
#[derive(Clone, Debug, Default, PartialEq)]
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
    /// Whether frames have the albedo of every pixel, if it is [requested](FrameRequest::albedo).
    pub has_albedo: bool,
}

/// Pose of a camera that a viewer can steer, and a speed to steer it with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraPose {
    /// Camera-to-world matrix: x right, y up, looking along -z.
    pub world_from_camera: DMat4,
    /// To be added to positions for those in the coordinates of the scene's file, in metres.
    pub origin: DVec3,
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

    /// What was left out or assumed when the input was opened, a line each.
    fn warnings(&self) -> &[String] {
        &[]
    }

    /// What is read of the input's files, a line each.
    fn contents(&self) -> &[String] {
        &[]
    }

    /// The frame that `request` asks for. Positions may come in any order.
    ///
    /// # Errors
    /// [`Io`](InputError::Io) and [`Invalid`](InputError::Invalid) if the file of the frame cannot be read or
    /// contradicts its header, [`Limit`](InputError::Limit) if it has grown beyond the limits since it was opened,
    /// [`Device`](InputError::Device) if the renderer failed or lost its device.
    fn render(&mut self, request: &FrameRequest) -> Result<RenderedFrame, InputError>;

    /// The full-rate frame at playback position `index`: short for [`render`](Self::render).
    ///
    /// # Errors
    /// As for `render`.
    fn frame(&mut self, index: u64) -> Result<SourceFrame, InputError> {
        Ok(self.render(&FrameRequest::full_rate(index))?.reference)
    }

    /// Shades pixels of `frame`, which was rendered last, at full rate and with one sample each. `None`: the source
    /// cannot shade single pixels. Sources whose frames a simulator foveates do not need this, because their frames
    /// contain these pixels.
    ///
    /// # Errors
    /// As for `render`.
    fn shade(&mut self, _frame: &RenderedFrame, _request: &ShadingRequest) -> Result<Option<Shaded>, InputError> {
        Ok(None)
    }

    /// Camera pose at playback position `index`; `None` if the camera cannot be steered.
    fn camera_pose(&self, _index: u64) -> Option<CameraPose> {
        None
    }

    /// Overrides the camera's path with two poses: one for the frames before `index`, and one from `index` on. `None`
    /// returns the camera to its path. See `SceneCamera::steer`. Sources whose camera cannot be steered ignore it.
    fn steer(&mut self, _index: u64, _before_and_now: Option<[DMat4; 2]>) {}
}
