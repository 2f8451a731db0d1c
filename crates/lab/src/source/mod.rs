//! Frame sources: stills, EXR sequences, analytic scenes and rendered scenes, behind one trait ([`FrameSource`]).

pub mod color_frames;
pub mod exr_file;
pub mod ffmpeg;
mod frame_files;
pub mod limits;
pub mod motion_check;
mod open;
pub mod raster;
pub mod scene_camera;
pub mod sequence;
pub mod still;
mod video;
pub mod viewed_scene;
pub mod y4m;
pub mod yuv;

pub use crate::file_kind::other_kind;
pub use afterimage_eval::source::{
    AnalyticSource, CameraPose, FrameRequest, FrameSource, SourceInfo, Wanted, analytic, reference_offsets_px,
};
pub use color_frames::ColorFrames;
pub use exr_file::{AlbedoLayer, ChannelNames};
pub use limits::ReadLimits;
pub use open::{is_scene, open, open_named};
pub use raster::RasterSource;
pub use scene_camera::SceneCamera;
pub use sequence::SequenceSource;
pub use still::StillSource;
pub use viewed_scene::{Light, SceneChoice, ViewedScene};

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
