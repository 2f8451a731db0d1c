//! Facts of a frame that CPU and GPU share: gaze, view, reset.

use crate::convention::{DepthConvention, MotionConvention};
use crate::error::{FrameError, SettingsError};
use crate::geometry::ViewGeometry;
use crate::kernel::rng;
use crate::kernel::rng::Purpose;
use crate::settings::{Sampler, Settings};
use glam::Vec3;

/// Where one eye looks.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Gaze {
    /// At this position of its view: pixels, (0, 0) is the centre of the top-left pixel, y down. May lie outside the view.
    At {
        /// Position in pixels.
        px: [f32; 2],
    },
    /// Not known in this frame (blink, lost tracking): the last known position is held; before the first one, the middle of
    /// the view.
    #[default]
    Lost,
}

impl Gaze {
    /// The position to use: this one if it is known and finite, else `held`, else the middle of a view of `size_px`. Limited to
    /// a million pixels either way, so that angles stay finite.
    pub fn resolve(self, held: Option<[f32; 2]>, size_px: [u32; 2]) -> [f32; 2] {
        let middle = size_px.map(|s| 0.5 * s as f32 - 0.5);
        match self {
            Self::At { px } if px[0].is_finite() && px[1].is_finite() => px.map(|v| v.clamp(-1e6, 1e6)),
            _ => held.unwrap_or(middle),
        }
    }
}

/// Facts of one view of one frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewFrame {
    /// How its pixels map to rays.
    pub geometry: ViewGeometry,
    /// Where its eye looks.
    pub gaze: Gaze,
    /// Camera motion: takes a point from this frame's view space (x right, y down, z forward) to the previous frame's.
    /// Row-major, for column vectors. With it, driving towards a wall does not look like disocclusion. `None`: distances are
    /// expected to stay as they are.
    pub previous_from_current: Option<[[f32; 4]; 4]>,
}

/// What a pass needs to know of one view of one frame besides its images, for both executors.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ViewConstants {
    /// Where the eye is taken to look; to be held if the gaze is lost next.
    pub gaze_px: [f32; 2],
    /// Ray through it.
    pub gaze_ray: Vec3,
    /// Third row of the current-to-previous view transform: it gives the previous distance.
    pub depth_row: [f32; 4],
    /// Key of the view's random stream.
    pub key: u32,
}

impl ViewFrame {
    /// Constants of view `view` of frame `index`, with the gaze `held` from before.
    pub(crate) fn constants(
        &self,
        held: Option<[f32; 2]>,
        settings: &Settings,
        view: usize,
        index: u64,
    ) -> ViewConstants {
        let gaze_px = self.gaze.resolve(held, self.geometry.size_px());
        let purpose = match settings.sampler {
            Sampler::AChao => Purpose::Select,
            Sampler::AEs => Purpose::Key,
        };
        ViewConstants {
            gaze_px,
            gaze_ray: self.geometry.ray(gaze_px),
            depth_row: self.previous_from_current.map_or([0.0, 0.0, 1.0, 0.0], |m| m[2]),
            key: rng::stream_key(settings.seed, view as u32, purpose, index),
        }
    }

    /// Checks what does not depend on images.
    pub(crate) fn check(&self, view: usize, desc: &ContextDesc) -> Result<(), FrameError> {
        let found = self.geometry.size_px();
        if found != desc.size_px {
            return Err(FrameError::Size { input: "geometry", view, found, expected: desc.size_px });
        }
        let Some(matrix) = self.previous_from_current else {
            return Ok(());
        };
        let refuse =
            |found: String, expected| Err(FrameError::Value { what: "previous_from_current", view, found, expected });
        if matches!(desc.depth, DepthConvention::Orthographic { .. }) {
            return refuse(
                "given with orthographic depth".into(),
                "None: rays of an orthographic view are not known here",
            );
        }
        match matrix.iter().flatten().find(|v| !v.is_finite()) {
            Some(v) => refuse(
                format!("a matrix that holds {v}"),
                "finite numbers, or None if the camera's motion is not known",
            ),
            None => Ok(()),
        }
    }
}

/// What of the history is still true.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Reset {
    /// Everything.
    #[default]
    None,
    /// Nothing: a cut, a teleport, a pause. This frame starts afresh.
    All,
}

/// How bright this frame's numbers are against the previous frame's. Engines that multiply an exposure into the colors they
/// hand over say so here, and history follows.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Exposure {
    /// As bright: the same surface in the same light has the same numbers.
    #[default]
    Same,
    /// This frame's exposure over the previous frame's.
    Changed {
        /// Above 0 and finite.
        ratio: f32,
    },
}

impl Exposure {
    /// Refuses a ratio that is no ratio.
    pub(crate) fn check(self) -> Result<(), FrameError> {
        match self {
            Self::Changed { ratio } if !(ratio.is_finite() && ratio > 0.0) => Err(FrameError::Value {
                what: "exposure ratio",
                view: 0,
                found: ratio.to_string(),
                expected: "this frame's exposure over the previous frame's: above 0 and finite",
            }),
            _ => Ok(()),
        }
    }

    /// The factor on stored colors, if there is one. Limited to where halves can follow ([`expose`](crate::kernel::wrs::expose)).
    pub(crate) fn factor(self) -> Option<f32> {
        const LIMIT: f32 = (1_u64 << 40) as f32;
        match self {
            Self::Same => None,
            Self::Changed { ratio } => Some(ratio.clamp(1.0 / LIMIT, LIMIT)),
        }
    }
}

/// Facts that hold from creation on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContextDesc {
    /// Width and height of each view in pixels, at least 1x1.
    pub size_px: [u32; 2],
    /// Number of views; 2 for stereo.
    pub view_count: u32,
    /// What motion vectors mean.
    pub motion: MotionConvention,
    /// What depth values mean.
    pub depth: DepthConvention,
}

impl ContextDesc {
    /// Largest accepted side of a view, in pixels.
    pub const MAX_SIDE: u32 = 16384;

    /// One view of `size_px` with the default conventions: motion as previous minus current in pixels with y down, depth as
    /// linear distance.
    pub fn new(size_px: [u32; 2]) -> Self {
        Self { size_px, view_count: 1, motion: Default::default(), depth: Default::default() }
    }

    /// Checks size, number of views and planes.
    pub(crate) fn validate(&self) -> Result<(), SettingsError> {
        self.depth.validate()?;
        check_size(self.size_px).map_err(|e| SettingsError {
            setting: "size_px",
            found: format!("{}x{}", self.size_px[0], self.size_px[1]),
            expected: e.to_string(),
        })?;
        if self.view_count == 0 {
            return Err(SettingsError { setting: "view_count", found: "0".into(), expected: "at least 1 view".into() });
        }
        Ok(())
    }
}

/// Refuses sizes without a pixel and sizes beyond [`ContextDesc::MAX_SIDE`].
pub(crate) fn check_size(size: [u32; 2]) -> Result<(), FrameError> {
    let max = ContextDesc::MAX_SIDE;
    if size.iter().all(|s| (1..=max).contains(s)) { Ok(()) } else { Err(FrameError::Extent { size, max }) }
}
