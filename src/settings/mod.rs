//! Settings of the post-process.

mod wrs;

pub use wrs::{Bias, Gate, GateMetric, GateScale, Sampler, Wrs};

use crate::error::{SettingsError, check};
use crate::foveation::Foveation;
#[cfg(feature = "bevy-0-20")]
use bevy_reflect::{Reflect, std_traits::ReflectDefault};

/// Method with its settings: how history is stored and combined with the foveated frame. Default:
/// [`Smr`](Self::Smr).
///
/// ```
/// use afterimage::internal::{Method, MethodKind, Settings, Smr};
///
/// let settings = Settings { method: Method::Taa, ..Settings::default() };
/// assert_eq!(settings.method.name(), "taa");
/// assert_eq!(Method::from(MethodKind::Smr), Method::Smr(Smr::default()));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
#[cfg_attr(feature = "bevy-0-20", derive(Reflect), reflect(Default))]
#[non_exhaustive]
pub enum Method {
    /// No method: the foveated frame unchanged, except that non-finite pixels are black. No history.
    None,
    /// Temporal antialiasing, which ignores gaze: a baseline for comparison.
    Taa,
    /// Temporal upsampling, which ignores gaze but uses the positions of a planned frame's samples: a baseline for
    /// comparison.
    Taau,
    /// Scale-matched reservoirs: the sharpest sample of each surface point is shown as long as it explains the foveated
    /// frame.
    Smr(Smr),
    /// Weighted reservoirs (Cantory et al., MIG 2025): a random sample of each surface point, weighted by retinal
    /// acuity.
    Wrs(Wrs),
}

impl Default for Method {
    fn default() -> Self {
        Self::Smr(Smr::default())
    }
}

/// A [`Method`] without its settings, for lists and names. Default: [`Smr`](Self::Smr).
///
/// ```
/// use afterimage::internal::MethodKind;
///
/// assert_eq!(MethodKind::from_name("smr"), Some(MethodKind::Smr));
/// assert!(MethodKind::ALL.into_iter().all(|kind| MethodKind::from_name(kind.name()) == Some(kind)));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum MethodKind {
    /// [`Method::None`].
    None,
    /// [`Method::Taa`].
    Taa,
    /// [`Method::Taau`].
    Taau,
    /// [`Method::Smr`].
    #[default]
    Smr,
    /// [`Method::Wrs`].
    Wrs,
}

/// Settings of [`Method::Smr`], scale-matched reservoirs.
///
/// ```
/// use afterimage::internal::{Method, Settings, Smr};
///
/// // Averages coarse regions over fewer frames than the default.
/// let method = Method::Smr(Smr { accumulate: 0.8, ..Smr::default() });
/// let settings = Settings { method, ..Settings::default() };
/// settings.validate()?;
/// # Ok::<(), afterimage::SettingsError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
#[cfg_attr(feature = "bevy-0-20", derive(Reflect), reflect(Default))]
pub struct Smr {
    /// Share of equally coarse history in the output: 0 to 0.98. A larger share reduces the flicker of coarse regions
    /// in motion, and follows changes of light later. Default 0.9.
    pub accumulate: f32,
    /// Factor on the tolerated color difference of candidate and history: 0.1 to 10. More keeps detail in spite of
    /// noise and imprecise motion vectors; less rejects outdated history sooner. Default 1.
    pub tolerance: f32,
    /// Whether history is scaled to follow changes of light, instead of being rejected. Default true.
    pub relight: bool,
    /// Whether planned frames ([`Filter::Quads`](crate::internal::Filter::Quads)) are antialiased: their projection is
    /// jittered ([`ViewFrame::jitter_px`](crate::internal::ViewFrame::jitter_px), best [`Foveation::jitter_px`]), and
    /// history stores means of samples instead of single ones. Set it in place of other temporal antialiasing, and only
    /// for jittered frames. It has no effect on noisy frames, which are averaged in any case, or on other frames.
    /// Default false.
    pub antialias: bool,
}

impl Default for Smr {
    fn default() -> Self {
        Self { accumulate: 0.9, tolerance: 1.0, relight: true, antialias: false }
    }
}

impl Smr {
    /// The smr settings of [`Settings::responsive`].
    pub fn responsive() -> Self {
        Self { accumulate: 0.7, tolerance: 0.6, ..Self::default() }
    }

    /// The smr settings of [`Settings::traced`].
    pub fn traced() -> Self {
        Self { accumulate: 0.95, ..Self::default() }
    }

    fn validate(&self) -> Result<(), SettingsError> {
        check("smr.accumulate", self.accumulate, 0.0..=0.98, "")?;
        check("smr.tolerance", self.tolerance, 0.1..=10.0, "")
    }
}

/// Depth test: rejects history at occlusions and disocclusions. Applies to frames with a depth input.
///
/// ```
/// use afterimage::internal::{DepthTest, Settings};
///
/// // Tolerates more depth noise than the default.
/// let test = DepthTest { relative: 0.05, ..DepthTest::default() };
/// let settings = Settings { depth_test: Some(test), ..Settings::default() };
/// settings.validate()?;
/// # Ok::<(), afterimage::SettingsError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
#[cfg_attr(feature = "bevy-0-20", derive(Reflect), reflect(Default))]
pub struct DepthTest {
    /// Largest relative difference of distance within one surface: 0.0001 to 0.999. Less rejects valid history where
    /// motion or depth is imprecise; more lets surfaces at similar distance bleed into each other. Default 0.02.
    pub relative: f32,
    /// Reprojection error in pixels along each axis that the test tolerates: 0 to 64. The tolerance grows by the
    /// surface's slope over that distance, so that history on grazing planes is not rejected. Default 1: half for
    /// rounding to the nearest texel, half for the position of the depth sample within its pixel.
    pub slope_px: f32,
}

impl Default for DepthTest {
    fn default() -> Self {
        Self { relative: 0.02, slope_px: 1.0 }
    }
}

/// Settings of a context: method, foveation and tunables. They can be changed between frames (`set_settings` of either
/// executor).
///
/// The default is [`Settings::steady`], which measures best on real frames. Other presets are
/// [`responsive`](Self::responsive), [`traced`](Self::traced), [`weighted`](Self::weighted) and [`paper`](Self::paper);
/// of frames shaded by quads, [`screen`](Self::screen) and [`headset`](Self::headset).
///
/// ```
/// use afterimage::internal::{ContextDesc, Settings};
///
/// let mut desc = ContextDesc::new([1920, 1080]);
/// desc.settings = Settings { seed: 7, ..Settings::responsive() };
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
#[cfg_attr(feature = "bevy-0-20", derive(Reflect), reflect(Default))]
pub struct Settings {
    /// Method with its settings: how history is stored and combined with the frame. Default [`Method::Smr`].
    pub method: Method,
    /// Foveation of the renderer: level of detail by eccentricity. Set it to match your renderer.
    pub foveation: Foveation,
    /// Depth test; `None` compares no depths. Default on.
    pub depth_test: Option<DepthTest>,
    /// Whether frames are noisy, that is path-traced with few samples a pixel. Each frame must then have a noise input
    /// ([`FrameInputs::noise`](crate::internal::FrameInputs::noise)), so that noise is not mistaken for a change. wrs
    /// weights a candidate by its number of samples; smr averages history in the fovea, too, compares means of 8x8
    /// candidates, and stores 8 more bytes a pixel and a mip chain of the candidates. On planned frames smr compares
    /// means of samples, stores the 8 bytes but no mip chain, and does not relight history. Default false.
    pub noisy: bool,
    /// Seed of the random numbers. The same seed and the same frames give the same bytes. Default 0.
    pub seed: u64,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            method: Method::default(),
            foveation: Foveation::default(),
            depth_test: Some(DepthTest::default()),
            noisy: false,
            seed: 0,
        }
    }
}

impl Settings {
    /// The paper's method (Cantory et al., MIG 2025) as published: weighted reservoirs, A-Chao, Bernoulli survival,
    /// Delta E 94 gate. The result looks like the foveated frame with scattered sharp pixels, and their number grows
    /// while the eye fixates. The cheapest preset.
    pub fn paper() -> Self {
        Self { method: Method::Wrs(Wrs::default()), ..Self::default() }
    }

    /// Weighted reservoirs that reach the gains that the paper reports: the gate compares at the candidate's scale,
    /// weights fall with the eighth power of the density and the third power of the samples a pixel, and reservoirs
    /// keep means. In a still view they keep most of the detail that [`steady`](Self::steady) keeps; in motion they
    /// keep less of it.
    pub fn weighted() -> Self {
        Self { method: Method::Wrs(Wrs::weighted()), ..Self::default() }
    }

    /// smr for a steady image: sharp where the eye has been, coarse regions averaged over time, so that they do not
    /// flicker. The default.
    pub fn steady() -> Self {
        Self::default()
    }

    /// smr that rejects outdated history sooner and averages over fewer frames: moving objects and changes of light
    /// flicker less, but less detail survives a moving camera (on Sponza, retained detail loses 2 dB). The same cost as
    /// [`steady`](Self::steady).
    pub fn responsive() -> Self {
        Self { method: Method::Smr(Smr::responsive()), ..Self::default() }
    }

    /// smr for frames that are path-traced with few samples a pixel: averages over twice as many frames as
    /// [`steady`](Self::steady). Each frame must have a noise input
    /// ([`FrameInputs::noise`](crate::internal::FrameInputs::noise)).
    pub fn traced() -> Self {
        Self { method: Method::Smr(Smr::traced()), noisy: true, ..Self::default() }
    }

    /// smr on antialiased frames shaded by quads ([`Filter::Quads`](crate::internal::Filter::Quads)), for screens about
    /// 40 degrees wide: a coarser even pattern and twice the budget of [`Foveation::quads`], 11 % of the pixels. Frames
    /// must be jittered ([`Foveation::jitter_px`]). `docs/quads.md` has the scores.
    pub fn screen() -> Self {
        let method = Method::Smr(Smr { antialias: true, ..Smr::default() });
        let foveation = Foveation { rate_mid: 8, budget: 0.05, ..Foveation::quads() };
        Self { method, foveation, ..Self::default() }
    }

    /// The same for headsets, about 100 degrees wide: a wider fovea, which costs few pixels there.
    pub fn headset() -> Self {
        let screen = Self::screen();
        Self { foveation: Foveation { fovea_deg: 10.0, ..screen.foveation }, ..screen }
    }

    /// Checks the range of every setting.
    ///
    /// # Errors
    /// [`SettingsError`] for the first setting that is out of range.
    pub fn validate(&self) -> Result<(), SettingsError> {
        self.foveation.validate()?;
        match &self.method {
            Method::Smr(smr) => smr.validate()?,
            Method::Wrs(wrs) => wrs.validate()?,
            Method::None | Method::Taa | Method::Taau => {}
        }
        if let Some(test) = self.depth_test {
            check("depth_test.relative", test.relative, 1e-4..=0.999, "")?;
            check("depth_test.slope_px", test.slope_px, 0.0..=64.0, "pixels")?;
        }
        Ok(())
    }
}
