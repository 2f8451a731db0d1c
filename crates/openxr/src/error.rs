//! Errors of a headset.

use afterimage::{CreateError, FrameError, SettingsError};

/// Reason why no headset was found, or why frames end.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// No OpenXR loader on this machine.
    #[error("no OpenXR loader was found ({0}): install a runtime, such as Monado or SteamVR")]
    Loader(String),
    /// The runtime lacks what is needed.
    #[error("the OpenXR runtime {0}")]
    Runtime(&'static str),
    /// A call of OpenXR failed. `ERROR_FORM_FACTOR_UNAVAILABLE`: no headset is connected.
    #[error("OpenXR: {0}")]
    OpenXr(openxr::sys::Result),
    /// The runtime ends, to restart after an update, or crashed.
    #[error("the OpenXR runtime was lost: drop the headset and create another one")]
    InstanceLost,
    /// The Vulkan device could not be created.
    #[error("the Vulkan device: {0}")]
    Device(String),
    /// A frame was submitted without a choice of its quads: [`HeadsetFrame::choose`](crate::HeadsetFrame::choose).
    #[error("the quads of the frame were not chosen: call HeadsetFrame::choose between the prepass and the color pass")]
    NotChosen,
    /// Settings are out of range, or a view of the runtime is none.
    #[error(transparent)]
    Settings(#[from] SettingsError),
    /// The post-process could not be created.
    #[error(transparent)]
    Create(#[from] CreateError),
    /// The post-process refused a frame.
    #[error(transparent)]
    Frame(#[from] FrameError),
}

impl From<openxr::sys::Result> for Error {
    fn from(error: openxr::sys::Result) -> Self {
        match error {
            openxr::sys::Result::ERROR_INSTANCE_LOST => Self::InstanceLost,
            error => Self::OpenXr(error),
        }
    }
}
