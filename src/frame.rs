//! Descriptions that both executors share: of a context, of a frame and of its views.

use crate::convention::{DepthConvention, MotionConvention};
use crate::error::{FrameError, SettingsError};
use crate::geometry::ViewGeometry;
use crate::settings::Settings;
use std::fmt::Debug;

/// Position that one eye looks at.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
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

/// One view of one frame: a screen, or an eye of a headset.
///
/// Make it with [`new`](Self::new) and `..`, so that a field that comes later breaks nothing:
///
/// ```
/// # use afterimage::{Gaze, ViewFrame, ViewGeometry};
/// # let camera_motion = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.02], [0.0, 0.0, 0.0, 1.0]];
/// let geometry = ViewGeometry::flat([1920, 1080], 70.0)?;
/// let gaze = Gaze::At { px: [1200.0, 500.0] };
/// let view = ViewFrame { previous_from_current: Some(camera_motion), ..ViewFrame::new(geometry, gaze) };
/// # Ok::<(), afterimage::SettingsError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewFrame {
    /// Rays through its pixels.
    pub geometry: ViewGeometry,
    /// Position that its eye looks at.
    pub gaze: Gaze,
    /// Camera motion: takes a point from this frame's view space (x right, y down, z forward) to the previous frame's. Row-major,
    /// for column vectors; perspective views only. `None`: distances are expected to stay as they are, and history on surfaces that
    /// the camera approaches or leaves fast is rejected.
    pub previous_from_current: Option<[[f32; 4]; 4]>,
}

impl ViewFrame {
    /// A view whose camera motion is not known.
    pub fn new(geometry: ViewGeometry, gaze: Gaze) -> Self {
        Self { geometry, gaze, previous_from_current: None }
    }

    /// Third row of [`previous_from_current`](Self::previous_from_current): it gives the previous distance.
    pub(crate) fn depth_row(&self) -> [f32; 4] {
        self.previous_from_current.map_or([0.0, 0.0, 1.0, 0.0], |m| m[2])
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

/// Whether history survives into this frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Reset {
    /// All history is valid.
    #[default]
    None,
    /// No history is valid, after a cut, a teleport or a pause. This frame starts afresh.
    All,
}

/// Exposure of this frame's colors against the previous frame's, for engines that multiply an exposure into the colors that they
/// hand over. Stored colors are scaled by the ratio.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub enum Exposure {
    /// Unchanged: the same surface in the same light has the same numbers.
    #[default]
    Same,
    /// This frame's exposure over the previous frame's.
    Changed {
        /// Above 0 and finite.
        ratio: f32,
    },
}

impl Exposure {
    /// Refuses a ratio that is not above 0 and finite.
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

/// An executor of the post-process, by the images that it reads.
///
/// Implemented by [`gpu::Afterimage`](crate::gpu::Afterimage), whose images are textures with one array layer a view, and by
/// [`cpu::CpuAfterimage`](crate::cpu::CpuAfterimage), whose images are slices with one [`Image`](crate::Image) a view.
pub trait Executor {
    /// Images of colors.
    type Colors<'a>: Copy + Debug;
    /// Images of numbers.
    type Scalars<'a>: Copy + Debug;
    /// Images of pairs of numbers.
    type Vectors<'a>: Copy + Debug;
}

/// One frame: images of the size that the context was made for, and what the renderer knows about them.
///
/// [`gpu::Frame`](crate::gpu::Frame) and [`cpu::Frame`](crate::cpu::Frame) are this type for either executor. Make it with
/// [`new`](Self::new) and `..`, so that a field that comes later breaks nothing.
pub struct Frame<'a, E: Executor> {
    /// The foveated frame: linear color in Rec. 709 primaries, scene-referred. Pixels that are NaN or infinite are dropped and
    /// counted. On a GPU any float format.
    pub color: E::Colors<'a>,
    /// Depth in the context's convention; on a GPU a depth format or `R32Float`. `None` switches the depth test off.
    pub depth: Option<E::Scalars<'a>>,
    /// Motion vectors in the context's convention; on a GPU `Rg16Float`, `Rg32Float` or wider. `None`: nothing moves.
    pub motion: Option<E::Vectors<'a>>,
    /// Confidence in history, 0 to 1: 0 for what moves without vectors (video panels, particles, reflections). About 1 minus FSR2's
    /// reactive mask. On a GPU any float or normalised format. `None`: 1 everywhere.
    pub trust: Option<E::Scalars<'a>>,
    /// Level of detail of the foveated frame: log2 of the block edge in pixels; on a GPU any float format. `None`: computed from the
    /// gaze as [`Settings::foveation`] says. Its `rate_far` must be the coarsest in either case: history is not matched at coarser
    /// levels.
    pub lod: Option<E::Scalars<'a>>,
    /// Noise of the color: the standard error of its luma, linear, and the number of samples that it is a mean of, at its level of
    /// detail; on a GPU `Rg16Float`, `Rg32Float` or wider. Given where, and only where, [`Settings::noisy`] is set.
    pub noise: Option<E::Vectors<'a>>,
    /// One entry a view.
    pub views: &'a [ViewFrame],
    /// Frame counter. Random numbers follow it: the same index and seed give the same bytes.
    pub index: u64,
    /// Whether history still holds.
    pub reset: Reset,
    /// Exposure of this frame's colors against the previous frame's.
    pub exposure: Exposure,
}

// Not derived: that would ask the executor itself to be `Copy`.
impl<E: Executor> Clone for Frame<'_, E> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<E: Executor> Copy for Frame<'_, E> {}

impl<E: Executor> Debug for Frame<'_, E> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Frame")
            .field("color", &self.color)
            .field("depth", &self.depth)
            .field("motion", &self.motion)
            .field("trust", &self.trust)
            .field("lod", &self.lod)
            .field("noise", &self.noise)
            .field("views", &self.views)
            .field("index", &self.index)
            .field("reset", &self.reset)
            .field("exposure", &self.exposure)
            .finish()
    }
}

impl<'a, E: Executor> Frame<'a, E> {
    /// A frame that continues the previous one, without optional inputs.
    pub fn new(color: E::Colors<'a>, views: &'a [ViewFrame], index: u64) -> Self {
        Self {
            color,
            depth: None,
            motion: None,
            trust: None,
            lod: None,
            noise: None,
            views,
            index,
            reset: Reset::None,
            exposure: Exposure::Same,
        }
    }

    /// Checks what does not depend on images.
    pub(crate) fn check(&self, desc: &ContextDesc) -> Result<(), FrameError> {
        let (found, expected) = (self.views.len(), desc.view_count as usize);
        if found != expected {
            return Err(FrameError::ViewCount { found, expected });
        }
        for (i, view) in self.views.iter().enumerate() {
            view.check(i, desc)?;
        }
        self.check_noise(&desc.settings)?;
        self.exposure.check()
    }

    /// Refuses noise where none is expected, and the other way round.
    fn check_noise(&self, settings: &Settings) -> Result<(), FrameError> {
        let (found, expected) = match (settings.noisy, self.noise.is_some()) {
            (true, false) => ("None", "images, as Settings::noisy is set"),
            (false, true) => ("given", "None, or Settings::noisy set"),
            _ => return Ok(()),
        };
        Err(FrameError::Value { what: "noise", view: 0, found: found.into(), expected })
    }
}

/// Description of a context: facts that hold from its creation on, and tunables, which can be changed later.
///
/// Make it with [`new`](Self::new) and change fields, or with `..`, so that a field that comes later breaks nothing:
///
/// ```
/// use afterimage::{ContextDesc, DepthConvention, MotionConvention};
///
/// let mut desc = ContextDesc::new([1920, 1080]);
/// desc.motion = MotionConvention::BLENDER;
/// desc.depth = DepthConvention::Reversed { near: 0.1, far: f32::INFINITY };
/// desc.settings.foveation.rate_far = 8;
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContextDesc {
    /// Width and height of each view in pixels, 1 to [`MAX_SIDE`](Self::MAX_SIDE) each.
    pub size_px: [u32; 2],
    /// Number of views: 2 for stereo, at most 4 on a GPU.
    pub view_count: u32,
    /// Convention of motion vectors.
    pub motion: MotionConvention,
    /// Convention of depth values.
    pub depth: DepthConvention,
    /// Tunables.
    pub settings: Settings,
}

impl ContextDesc {
    /// Largest accepted side of a view, in pixels.
    pub const MAX_SIDE: u32 = 16384;

    /// One view of `size_px` with default settings and the default conventions: motion as previous minus current in pixels with y
    /// down, depth as linear distance.
    pub fn new(size_px: [u32; 2]) -> Self {
        Self {
            size_px,
            view_count: 1,
            motion: MotionConvention::default(),
            depth: DepthConvention::default(),
            settings: Settings::default(),
        }
    }

    /// Checks settings, size, number of views and planes.
    pub(crate) fn validate(&self) -> Result<(), SettingsError> {
        self.settings.validate()?;
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
