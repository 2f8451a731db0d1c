//! Input frames: loaded by a thread, or scenes that the window's device renders when a frame is shown.

use super::frame_loader::{FrameLoader, LoadedFrame, Steering};
use crate::failure::Failure;
use afterimage_lab::source::{CameraPose, FrameSource, RasterSource, ViewedScene};
use glam::DMat4;

/// Where frames come from.
pub enum Frames {
    Loaded(FrameLoader),
    Scene(Box<SceneFrames>),
}

/// Frames of a scene, which need no waiting: they are rendered for the gaze of the frame that is shown.
pub struct SceneFrames {
    pub scene: ViewedScene,
    steering: Steering,
    /// Position, and the pose (world from camera) to which the user steers the camera.
    requested: Option<(u64, Option<DMat4>)>,
}

/// A requested frame.
pub enum NextFrame {
    Loaded(Box<LoadedFrame>),
    /// The frame at this position, to be rendered.
    Posed {
        index: u64,
        cut: bool,
        camera_pose: Option<CameraPose>,
    },
}

impl Frames {
    pub fn of_scene(scene: ViewedScene) -> Self {
        Self::Scene(Box::new(SceneFrames { scene, steering: Steering::default(), requested: None }))
    }

    /// The scene, if frames are rendered when they are shown.
    pub fn scene(&self) -> Option<&ViewedScene> {
        match self {
            Self::Loaded(_) => None,
            Self::Scene(frames) => Some(&frames.scene),
        }
    }

    /// Requests a frame, unless a request is pending.
    pub fn request(&mut self, index: u64, size: [u32; 2], pose: Option<DMat4>) {
        match self {
            Self::Loaded(loader) => loader.request(index, size, pose),
            Self::Scene(frames) => _ = frames.requested.get_or_insert((index, pose)),
        }
    }

    /// Cancels the pending request.
    pub fn cancel(&mut self) {
        match self {
            Self::Loaded(loader) => loader.cancel(),
            Self::Scene(frames) => frames.requested = None,
        }
    }

    /// The requested frame, if it is ready. `renderer` renders the scene; its camera is steered.
    pub fn take(&mut self, renderer: Option<&mut RasterSource>) -> Result<Option<NextFrame>, Failure> {
        match self {
            Self::Loaded(loader) => Ok(loader.take()?.map(|frame| NextFrame::Loaded(Box::new(frame)))),
            Self::Scene(frames) => {
                let (Some(renderer), Some((index, pose))) = (renderer, frames.requested.take()) else {
                    return Ok(None);
                };
                let cut = frames.steering.steer(renderer, index, pose) || index == 0;
                Ok(Some(NextFrame::Posed { index, cut, camera_pose: renderer.camera_pose(index) }))
            }
        }
    }
}
