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
mod peeked;
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
pub use peeked::PeekedSource;
#[cfg(feature = "full")]
pub use raster::{RasterScene, RasterSource};
#[cfg(feature = "full")]
pub use scene_camera::SceneCamera;
#[cfg(feature = "full")]
pub use sequence::SequenceSource;
#[cfg(feature = "full")]
pub use still::StillSource;
#[cfg(feature = "full")]
pub use traced::{TracedSamples, TracedSource};

use crate::clock::Elapsed;
#[cfg(feature = "full")]
use crate::device::Headless;
use crate::error::InputError;
#[cfg(feature = "full")]
use crate::frame::{ComposedFrame, DeviceFrame, DeviceSamples, SparseFrame};
use crate::frame::{FoveatedFrame, Guide, SourceFrame};
#[cfg(feature = "full")]
use crate::lattices::SparseGeometry;
#[cfg(feature = "full")]
use crate::quad_views::QuadViews;
#[cfg(feature = "full")]
use afterimage::Lattices;
use glam::DMat4;
#[cfg(feature = "full")]
use std::sync::Arc;

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

    /// The frame at playback position `index`. Positions may come in any order; motion vectors always refer to
    /// `index - 1`.
    ///
    /// # Errors
    /// [`Io`](InputError::Io) and [`Invalid`](InputError::Invalid) if the file of the frame cannot be read or
    /// contradicts its header, [`Limit`](InputError::Limit) if it is larger than the limits by now,
    /// [`Device`](InputError::Device) if the renderer failed or lost its device.
    fn frame(&mut self, index: u64) -> Result<SourceFrame, InputError>;

    /// The frame at `index`, foveated by the source itself around a gaze in pixels. `guide` directs the samples. `None`
    /// if the source cannot foveate: a simulator then foveates the full-rate frame.
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

    /// As [`foveated`](Self::foveated), with the samples of a sparse frame left on `device`, and with their depth and
    /// motion if `geometry` asks for them. `None` unless the source makes sparse frames on that device.
    ///
    /// # Errors
    /// As for [`frame`](Self::frame).
    #[cfg(feature = "full")]
    fn foveated_on(
        &mut self,
        _device: &Arc<Headless>,
        _index: u64,
        _gaze_px: [f32; 2],
        _geometry: SparseGeometry,
    ) -> Result<Option<DeviceSamples>, InputError> {
        Ok(None)
    }

    /// The frame at `index` with the samples of `lattices` alone: color, depth and motion in atlases on a device.
    /// `None` if the source does not render such frames: samples are then taken from the full-rate frame.
    ///
    /// # Errors
    /// As for [`frame`](Self::frame).
    #[cfg(feature = "full")]
    fn sparse(&mut self, _index: u64, _lattices: &Lattices) -> Result<Option<SparseFrame>, InputError> {
        Ok(None)
    }

    /// The frame at `index`, composed of quad views. `None` if the source does not render such frames.
    ///
    /// # Errors
    /// As for [`frame`](Self::frame).
    #[cfg(feature = "full")]
    fn composed(&mut self, _index: u64, _views: &QuadViews) -> Result<Option<ComposedFrame>, InputError> {
        Ok(None)
    }

    /// The frame that [`frame`](Self::frame) gave last, where it was rendered on a device and still lies there.
    #[cfg(feature = "full")]
    fn device_frame(&self) -> Option<DeviceFrame> {
        None
    }

    /// Time of rendering the frame that [`frame`](Self::frame), [`foveated`](Self::foveated) or `sparse` gave last,
    /// until it was complete on its device: posing the scene, recording and drawing or tracing, without reading back.
    /// `None` if the source renders nothing.
    fn render_time(&self) -> Option<Elapsed> {
        None
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
