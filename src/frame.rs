//! Description of a frame, for both executors.

use crate::context::ContextDesc;
use crate::error::{FrameError, FrameValue};
use crate::foveation::FoveationKind;
use crate::settings::Settings;
use crate::view::ViewFrame;

/// Reset of history by a frame. Default: [`None`](Self::None).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Reset {
    /// History is valid.
    #[default]
    None,
    /// All history is invalid, as after a cut, a teleport or a pause. The frame is processed like the first one.
    All,
}

/// Exposure of a frame's colors. Stored colors follow its changes. Default: [`Same`](Self::Same).
/// `examples/02_engine.rs` uses it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub enum Exposure {
    /// Colors are multiplied by an exposure already, or need none: white is at about 1. It is unchanged.
    #[default]
    Same,
    /// The same, but the exposure has changed since the previous frame.
    Changed {
        /// This frame's exposure divided by the previous frame's: above 0 and finite.
        ratio: f32,
    },
    /// Colors are radiance in any unit, and are shown in it. The context knows the previous frame's exposure, which is
    /// 1 for [`Same`](Self::Same) and [`Changed`](Self::Changed), and follows its changes.
    Scene {
        /// Factor by which colors have white at about 1: 2^-40 to 2^40. Noise ([`FrameInputs::noise`]) has the unit of
        /// the colors, and is multiplied, too. On a GPU, frames with it have pipelines of their own.
        exposure: f32,
    },
}

impl Exposure {
    /// Largest exposure, and inverse of the smallest one: the range of [`expose`](crate::kernel::color::expose).
    const LIMIT: f32 = (1_u64 << 40) as f32;

    /// Rejects a ratio that is not above 0 and finite, and an exposure out of range.
    pub(crate) fn check(self) -> Result<(), FrameError> {
        let (found, expected) = match self {
            Self::Changed { ratio } if !(ratio.is_finite() && ratio > 0.0) => {
                (ratio, "a number above 0 and finite: this frame's exposure divided by the previous frame's")
            }
            Self::Scene { exposure } if !(1.0 / Self::LIMIT..=Self::LIMIT).contains(&exposure) => {
                (exposure, "a number from 2^-40 to 2^40 by which the colors have white at about 1")
            }
            _ => return Ok(()),
        };
        Err(FrameError::Value { value: FrameValue::Exposure, view: 0, found: found.to_string(), expected })
    }

    /// Factor on given colors.
    pub(crate) fn of_colors(self) -> f32 {
        match self {
            Self::Same | Self::Changed { .. } => 1.0,
            Self::Scene { exposure } => exposure,
        }
    }

    /// Factor on stored colors. `before`: [factor](Self::of_colors) on the colors of the previous frame, if any.
    pub(crate) fn of_stored(self, before: Option<f32>) -> f32 {
        let ratio = match self {
            Self::Changed { ratio } => ratio,
            Self::Same | Self::Scene { .. } => 1.0,
        };
        let now = self.of_colors();
        (ratio * (now / before.unwrap_or(now))).clamp(1.0 / Self::LIMIT, Self::LIMIT)
    }
}

/// A frame: its input images, all of the context's size, and descriptions of its views.
///
/// `gpu::Frame` and `cpu::Frame` are this type for either executor, with its types of images: `Colors` have three
/// channels, `Scalars` one, `Vectors` two. Create it with [`new`](Self::new) and `..`, so that
/// later versions can add fields:
///
/// ```
/// # #[cfg(feature = "gpu")]
/// # use afterimage::wgpu;
/// # #[cfg(feature = "gpu")]
/// # fn example(color: &wgpu::Texture, depth: &wgpu::Texture, motion: &wgpu::Texture, views:
/// &[afterimage::levels::ViewFrame]) { use afterimage::levels::Reset; use afterimage::gpu::Frame;
///
/// let (depth, motion) = (Some(depth.into()), Some(motion.into()));
/// let after_a_cut = Frame { depth, motion, reset: Reset::All, ..Frame::new(color, views, 0) };
/// # let _ = after_a_cut;
/// # }
/// ```
#[derive(Clone, Copy, Debug)]
pub struct FrameInputs<'a, Colors, Scalars, Vectors> {
    /// Foveated frame: linear scene-referred color in Rec. 709 primaries, before tone mapping. Pixels that are NaN or
    /// infinite show their history, or black, and are counted. On a GPU any float format.
    ///
    /// Channels are 0 to 65504; larger ones are clamped, and smr, taa and taau store negative ones as 0. For smr the
    /// unit is free on frames that are neither planned nor noisy: colors times a constant give the picture times it.
    /// This holds for channels from 2^-14 (6e-5) on; darker ones are stored with fewer digits, and light that changes
    /// there leaves ghosts. wrs, planned frames and noise ([`Self::noise`]) compare colors by constants for white at
    /// about 1. Of colors in other units say the exposure ([`Exposure::Scene`]): then the range and these constants are
    /// for colors times it.
    pub color: Colors,
    /// Depth in the context's convention. On a GPU a depth format or `R32Float`. `None`: no depth test.
    pub depth: Option<Scalars>,
    /// Motion vectors in the context's convention. On a GPU `Rg16Float`, `Rg32Float` or wider. `None`: nothing moves,
    /// or only the camera ([`MotionConvention::without_camera`](crate::MotionConvention::without_camera)).
    pub motion: Option<Vectors>,
    /// Trust mask: confidence in history, 0 to 1. 0 rejects history; use it for content that changes without motion
    /// vectors (video panels, particles, reflections). 1 minus `reactive`. Values beyond 0 and 1
    /// are clamped; NaN counts as 0. On a GPU any float or normalised format. `None`: 1 everywhere.
    pub trust: Option<Scalars>,
    /// Reactive mask as FSR2 has it: 0 to 1, 1 rejects history. The trust is 1 minus this mask, so that a frame with
    /// both is an error. Values beyond 0 and 1 are clamped; NaN counts as 1. On a GPU any float or normalised format.
    /// `None`: `trust` says it.
    pub reactive: Option<Scalars>,
    /// Level of detail of the foveated frame: log2 of the block edge in pixels. On a GPU any float format. `None`:
    /// computed from gaze and [`Settings::foveation`]. Planned frames have the places of their samples instead, and no
    /// such input. `foveation.rate_far` must be the coarsest block edge even with this input, because history is not
    /// matched at coarser levels.
    pub lod: Option<Scalars>,
    /// Noise of the color: standard error of its luma (linear), and the number of samples that were averaged into the
    /// color, at its level of detail. On a GPU `Rg16Float`, `Rg32Float` or wider. Required if [`Settings::noisy`] is
    /// set, otherwise `None`. In planned frames it is read only at the pixels of samples.
    pub noise: Option<Vectors>,
    /// Albedo of every pixel of a planned frame, in which texture is then the pixel's own, and light alone is
    /// interpolated and remembered: the reflectance that multiplies light, 0 to 1, diffuse plus specular, in the same
    /// primaries as the color. It is jittered as the color is. 0 for the sky and for what shines itself; larger values
    /// count as 1, NaN and infinity as unknown. On a GPU any float or normalised format. Required if
    /// [`ContextDesc::has_albedo`] is set, otherwise `None`.
    #[doc(hidden)]
    pub albedo: Option<Colors>,
    /// Mask of a planned frame whose pixels the renderer chose itself, in place of
    /// `plan`: a pixel is shaded where it is above 0.5; NaN counts as 0. For checkerboards, half resolution, or a
    /// tracer that chooses its own pixels; any pattern does, if it visits every pixel in some frame. On a GPU any float
    /// or normalised format. `None`: `plan` chose the pixels.
    #[doc(hidden)]
    pub mask: Option<Scalars>,
    /// Colors of the quads of 2x2 pixels of a planned frame that are shaded in part:
    /// one texel a quad, half the width and height, rounded up. At most one pixel of such a quad is shaded then, as
    /// after a cut (`is_quarter` of either executor). `color` has the other quads. `None`: `color` has all pixels.
    #[doc(hidden)]
    pub half: Option<Colors>,
    /// Descriptions of the views, one for each view of the context.
    pub views: &'a [ViewFrame],
    /// Frame counter. It seeds the random numbers, so that the same index and [`Settings::seed`] give the same bytes,
    /// and moves the even pattern of planned frames. Count recorded frames; other numbers are right, too.
    pub index: u64,
    /// Reset of history.
    pub reset: Reset,
    /// Exposure of the colors, or its change since the previous frame.
    pub exposure: Exposure,
}

/// An input of a frame, given or not.
pub(crate) struct Input<Colors, Scalars, Vectors> {
    /// Name of its field in [`FrameInputs`].
    pub name: &'static str,
    /// Whether it is known before the frame is shaded.
    pub is_geometry: bool,
    pub images: Option<Images<Colors, Scalars, Vectors>>,
}

/// Images of an input.
#[derive(Clone, Copy)]
pub(crate) enum Images<Colors, Scalars, Vectors> {
    Colors(Colors),
    /// Colors of half the width and height, rounded up.
    HalfColors(Colors),
    Scalars(Scalars),
    Vectors(Vectors),
}

impl<Colors, Scalars, Vectors> Images<Colors, Scalars, Vectors> {
    /// Width and height, in frames of `whole_px`.
    pub fn size_px(&self, whole_px: [u32; 2]) -> [u32; 2] {
        match self {
            Self::HalfColors(_) => whole_px.map(|side| side.div_ceil(2)),
            _ => whole_px,
        }
    }

    /// Least number of channels.
    #[cfg(feature = "gpu")]
    pub fn channels(&self) -> u8 {
        match self {
            Self::Colors(_) | Self::HalfColors(_) => 3,
            Self::Vectors(_) => 2,
            Self::Scalars(_) => 1,
        }
    }
}

impl<'a, Colors, Scalars, Vectors> FrameInputs<'a, Colors, Scalars, Vectors> {
    /// Implementation of `new` of both executors.
    pub(crate) fn of_color(color: Colors, views: &'a [ViewFrame], index: u64) -> Self {
        Self {
            color,
            depth: None,
            motion: None,
            trust: None,
            reactive: None,
            lod: None,
            noise: None,
            albedo: None,
            mask: None,
            half: None,
            views,
            index,
            reset: Reset::None,
            exposure: Exposure::Same,
        }
    }

    /// All inputs, given or not.
    pub(crate) fn inputs(&self) -> [Input<Colors, Scalars, Vectors>; 10]
    where
        Colors: Copy,
        Scalars: Copy,
        Vectors: Copy,
    {
        let geometry = |name, images| Input { name, is_geometry: true, images };
        let shaded = |name, images| Input { name, is_geometry: false, images };
        [
            shaded("color", Some(Images::Colors(self.color))),
            geometry("depth", self.depth.map(Images::Scalars)),
            geometry("motion", self.motion.map(Images::Vectors)),
            geometry("trust", self.trust.map(Images::Scalars)),
            geometry("reactive", self.reactive.map(Images::Scalars)),
            shaded("lod", self.lod.map(Images::Scalars)),
            shaded("noise", self.noise.map(Images::Vectors)),
            shaded("albedo", self.albedo.map(Images::Colors)),
            shaded("mask", self.mask.map(Images::Scalars)),
            shaded("half", self.half.map(Images::HalfColors)),
        ]
    }

    /// Checks all fields except the images.
    pub(crate) fn check(&self, desc: &ContextDesc) -> Result<(), FrameError> {
        self.check_facts(desc)?;
        self.check_noise(&desc.settings)?;
        self.check_albedo(desc)
    }

    /// Checks the parts of a frame that are known before it is shaded.
    pub(crate) fn check_facts(&self, desc: &ContextDesc) -> Result<(), FrameError> {
        let (found, expected) = (self.views.len(), desc.view_count as usize);
        if found != expected {
            return Err(FrameError::ViewCount { found, expected });
        }
        for (i, view) in self.views.iter().enumerate() {
            view.check(i, desc)?;
            view.check_motion(i, desc, self.depth.is_some(), self.reset != Reset::None)?;
        }
        if self.trust.is_some() && self.reactive.is_some() {
            let expected = "None, because trust is given, and is 1 minus this mask";
            return Err(FrameError::Value { value: FrameValue::Reactive, view: 0, found: "given".into(), expected });
        }
        self.check_lod(&desc.settings)?;
        self.check_mask(&desc.settings)?;
        self.exposure.check()
    }

    /// Rejects levels of detail of planned frames.
    fn check_lod(&self, settings: &Settings) -> Result<(), FrameError> {
        if settings.foveation.kind == FoveationKind::Quads && self.lod.is_some() {
            let (found, expected) = ("given".into(), "None: the places of the samples say how coarse the frame is");
            return Err(FrameError::Value { value: FrameValue::Lod, view: 0, found, expected });
        }
        Ok(())
    }

    /// Rejects a mask, and colors of half the size, of frames that are not planned.
    fn check_mask(&self, settings: &Settings) -> Result<(), FrameError> {
        if settings.foveation.kind == FoveationKind::Quads || !(self.mask.is_some() || self.half.is_some()) {
            return Ok(());
        }
        let found = if self.mask.is_some() { "given" } else { "missing, with colors at half the size" };
        let expected = "set FoveationKind::Quads in Settings::foveation";
        Err(FrameError::Value { value: FrameValue::Mask, view: 0, found: found.into(), expected })
    }

    /// Checks the values of a frame whose quads are to be planned.
    pub(crate) fn check_plan(&self, desc: &ContextDesc) -> Result<(), FrameError> {
        if desc.settings.foveation.kind != FoveationKind::Quads {
            let (found, expected) = ("asked for".into(), "FoveationKind::Quads in Settings::foveation");
            return Err(FrameError::Value { value: FrameValue::Plan, view: 0, found, expected });
        }
        if self.mask.is_some() {
            let (found, expected) = ("asked for".into(), "no plan, or no mask: a mask says which pixels are shaded");
            return Err(FrameError::Value { value: FrameValue::Plan, view: 0, found, expected });
        }
        self.check_facts(desc)
    }

    /// Rejects a frame shaded by quads that was not planned. `planned`: index of the frame that was planned.
    pub(crate) fn check_planned(&self, desc: &ContextDesc, planned: Option<u64>) -> Result<(), FrameError> {
        let by_quads = desc.settings.foveation.kind == FoveationKind::Quads;
        if by_quads && self.mask.is_none() && planned != Some(self.index) {
            let found = planned.map_or("missing".into(), |index| format!("that of frame {index}"));
            let expected = "the plan of this frame: call plan before the frame is shaded, or give a mask";
            return Err(FrameError::Value { value: FrameValue::Plan, view: 0, found, expected });
        }
        Ok(())
    }

    /// Rejects a missing albedo if the context needs one, and an albedo if it does not.
    fn check_albedo(&self, desc: &ContextDesc) -> Result<(), FrameError> {
        let (found, expected) = match (desc.has_albedo, self.albedo.is_some()) {
            (true, false) => ("None", "the albedo of every pixel, because has_albedo is set"),
            (false, true) => ("given", "None; or set has_albedo"),
            _ => return Ok(()),
        };
        Err(FrameError::Value { value: FrameValue::Albedo, view: 0, found: found.into(), expected })
    }

    /// Rejects a missing noise input if the settings require one, and a noise input if they do not.
    fn check_noise(&self, settings: &Settings) -> Result<(), FrameError> {
        let (found, expected) = match (settings.noisy, self.noise.is_some()) {
            (true, false) => ("None", "a noise input, because Settings::noisy is set"),
            (false, true) => ("given", "None; or set Settings::noisy"),
            _ => return Ok(()),
        };
        Err(FrameError::Value { value: FrameValue::Noise, view: 0, found: found.into(), expected })
    }
}
