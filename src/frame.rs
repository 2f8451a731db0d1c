//! Descriptions of a context, of a frame and of its views, for both executors.

use crate::convention::{DepthConvention, MotionConvention};
use crate::error::{FrameError, SettingsError};
use crate::geometry::ViewGeometry;
use crate::settings::Settings;
use std::fmt::Debug;

/// Gaze: position in a view that the eye looks at. Default: [`Lost`](Self::Lost). Example: [`ViewFrame`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub enum Gaze {
    /// Known position. May lie outside the view. A position that is not finite counts as [`Lost`](Self::Lost).
    At {
        /// Position in pixels: (0, 0) is the centre of the top-left pixel, y down.
        px: [f32; 2],
    },
    /// Unknown in this frame (blink, lost tracking): the last known position is used; before the first one, the middle
    /// of the view.
    #[default]
    Lost,
}

impl Gaze {
    /// Position to use: this one if it is known and finite, else `held`, else the middle of a view of `size_px`.
    /// Clamped to +-1e6 pixels, so that angles stay finite.
    #[doc(hidden)]
    pub fn resolve(self, held: Option<[f32; 2]>, size_px: [u32; 2]) -> [f32; 2] {
        let middle = size_px.map(|s| 0.5 * s as f32 - 0.5);
        match self {
            Self::At { px } if px[0].is_finite() && px[1].is_finite() => px.map(|v| v.clamp(-1e6, 1e6)),
            _ => held.unwrap_or(middle),
        }
    }
}

/// Description of a view in a frame: geometry, gaze and camera motion of a screen or of one eye of a headset.
///
/// Create it with [`new`](Self::new) and `..`, so that later versions can add fields:
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
    /// Rays through the pixels.
    pub geometry: ViewGeometry,
    /// Gaze position.
    pub gaze: Gaze,
    /// Camera motion: the matrix that transforms a point from this frame's view space (x right, y down, z forward) to
    /// the previous frame's. Row-major, for column vectors; perspective views only. `None`: the depth test expects
    /// unchanged distances, so that history is rejected on surfaces that the camera approaches or leaves fast.
    pub previous_from_current: Option<[[f32; 4]; 4]>,
}

impl ViewFrame {
    /// A view of unknown camera motion.
    pub fn new(geometry: ViewGeometry, gaze: Gaze) -> Self {
        Self { geometry, gaze, previous_from_current: None }
    }

    /// Third row of [`previous_from_current`](Self::previous_from_current), which gives the previous distance.
    pub(crate) fn depth_row(&self) -> [f32; 4] {
        self.previous_from_current.map_or([0.0, 0.0, 1.0, 0.0], |m| m[2])
    }

    /// Checks all fields against the context's description.
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

/// Reset of history by a frame. Default: [`None`](Self::None). `examples/02_engine.rs` uses it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Reset {
    /// History is valid.
    #[default]
    None,
    /// No history is valid: after a cut, a teleport or a pause. The frame is processed like the first one.
    All,
}

/// Change of exposure between the previous frame and this one, for renderers whose colors are multiplied by an
/// exposure. Stored colors are scaled by the ratio. Default: [`Same`](Self::Same). `examples/02_engine.rs` uses it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub enum Exposure {
    /// Unchanged exposure.
    #[default]
    Same,
    /// Changed exposure.
    Changed {
        /// This frame's exposure divided by the previous frame's: above 0 and finite.
        ratio: f32,
    },
}

impl Exposure {
    /// Rejects a ratio that is not above 0 and finite.
    pub(crate) fn check(self) -> Result<(), FrameError> {
        match self {
            Self::Changed { ratio } if !(ratio.is_finite() && ratio > 0.0) => Err(FrameError::Value {
                what: "exposure ratio",
                view: 0,
                found: ratio.to_string(),
                expected: "a number above 0 and finite: this frame's exposure divided by the previous frame's",
            }),
            _ => Ok(()),
        }
    }

    /// Factor on stored colors; `None` if unchanged. Clamped to the range of [`expose`](crate::kernel::wrs::expose).
    pub(crate) fn factor(self) -> Option<f32> {
        const LIMIT: f32 = (1_u64 << 40) as f32;
        match self {
            Self::Same => None,
            Self::Changed { ratio } => Some(ratio.clamp(1.0 / LIMIT, LIMIT)),
        }
    }
}

/// Executor of the post-process: types of its input images.
///
/// Implemented by `gpu::Afterimage`, whose inputs are textures with one array layer a view, and by
/// `cpu::CpuAfterimage`, whose inputs are slices with one `Image` a view. It only makes [`Frame`] generic; there is no
/// need to implement or to name it.
pub trait Executor {
    /// Images with three channels (color).
    type Colors<'a>: Copy + Debug;
    /// Images with one channel.
    type Scalars<'a>: Copy + Debug;
    /// Images with two channels.
    type Vectors<'a>: Copy + Debug;
}

/// A frame: its input images, all of the context's size, and descriptions of its views.
///
/// `gpu::Frame` and `cpu::Frame` are this type for either executor. Create it with [`new`](Self::new) and `..`, so that
/// later versions can add fields:
///
/// ```
/// # #[cfg(feature = "gpu")]
/// # use afterimage::wgpu;
/// # #[cfg(feature = "gpu")]
/// # fn example(color: &wgpu::Texture, depth: &wgpu::Texture, motion: &wgpu::Texture, views: &[afterimage::ViewFrame]) {
/// use afterimage::Reset;
/// use afterimage::gpu::Frame;
///
/// let after_a_cut = Frame { depth: Some(depth), motion: Some(motion), reset: Reset::All, ..Frame::new(color, views, 0) };
/// # let _ = after_a_cut;
/// # }
/// ```
pub struct Frame<'a, E: Executor> {
    /// Foveated frame: linear scene-referred color in Rec. 709 primaries, before tone mapping. Pixels that are NaN or
    /// infinite show their history, or black, and are counted. On a GPU any float format.
    pub color: E::Colors<'a>,
    /// Depth in the context's convention. On a GPU a depth format or `R32Float`. `None`: no depth test.
    pub depth: Option<E::Scalars<'a>>,
    /// Motion vectors in the context's convention. On a GPU `Rg16Float`, `Rg32Float` or wider. `None`: no motion.
    pub motion: Option<E::Vectors<'a>>,
    /// Trust mask: confidence in history, 0 to 1. 0 rejects history; use it for what changes without motion vectors
    /// (video panels, particles, reflections). About 1 minus FSR2's reactive mask. On a GPU any float or normalised
    /// format. `None`: 1 everywhere.
    pub trust: Option<E::Scalars<'a>>,
    /// Level of detail of the foveated frame: log2 of the block edge in pixels. On a GPU any float format. `None`:
    /// computed from gaze and [`Settings::foveation`]. With this input, too, `foveation.rate_far` must be the coarsest
    /// block edge: history is not matched at coarser levels.
    pub lod: Option<E::Scalars<'a>>,
    /// Noise of the color: standard error of its luma (linear), and number of samples that the color is a mean of, at
    /// its level of detail. On a GPU `Rg16Float`, `Rg32Float` or wider. Required if [`Settings::noisy`] is set,
    /// otherwise `None`.
    pub noise: Option<E::Vectors<'a>>,
    /// Descriptions of the views, one for each view of the context.
    pub views: &'a [ViewFrame],
    /// Frame counter, which seeds the random numbers: the same index and [`Settings::seed`] give the same bytes.
    pub index: u64,
    /// Reset of history.
    pub reset: Reset,
    /// Change of exposure since the previous frame.
    pub exposure: Exposure,
}

// Not derived: a derived impl would require the executor itself to be `Copy`.
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
    /// A frame without optional inputs, which continues the previous frame: no reset, unchanged exposure.
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

    /// Checks all fields but the images.
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

    /// Rejects a missing noise input if the settings require one, and an unexpected one.
    fn check_noise(&self, settings: &Settings) -> Result<(), FrameError> {
        let (found, expected) = match (settings.noisy, self.noise.is_some()) {
            (true, false) => ("None", "a noise input, because Settings::noisy is set"),
            (false, true) => ("given", "None; or set Settings::noisy"),
            _ => return Ok(()),
        };
        Err(FrameError::Value { what: "noise", view: 0, found: found.into(), expected })
    }
}

/// Description of a context: size and number of views, conventions of its inputs, and settings. Size and settings can
/// be changed later (`resize` and `set_settings` of either executor).
///
/// Create it with [`new`](Self::new) and change fields, so that later versions can add fields:
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
    /// Number of views: 1 for a screen, 2 for stereo; at most 4 on a GPU. Default 1.
    pub view_count: u32,
    /// Convention of motion vectors. Default: previous minus current position in pixels, y down.
    pub motion: MotionConvention,
    /// Convention of depth values. Default: linear distance.
    pub depth: DepthConvention,
    /// Method, foveation and tunables. Default: [`Settings::steady`].
    pub settings: Settings,
}

impl ContextDesc {
    /// Largest accepted side of a view, in pixels.
    pub const MAX_SIDE: u32 = 16384;

    /// One view of `size_px` with default conventions and settings.
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

/// Rejects sizes with a side of 0 or beyond [`ContextDesc::MAX_SIDE`].
pub(crate) fn check_size(size: [u32; 2]) -> Result<(), FrameError> {
    let max = ContextDesc::MAX_SIDE;
    if size.iter().all(|s| (1..=max).contains(s)) { Ok(()) } else { Err(FrameError::Extent { size, max }) }
}
