//! Settings as the passes take them, of full-size and of planned frames. `levels::Settings` documents what full-size
//! frames have of them.

mod wrs;

pub use wrs::{Bias, Gate, GateMetric, GateScale, Sampler, Wrs};

use crate::error::{SettingsError, check};
use crate::foveation::Foveation;
#[cfg(feature = "bevy-0-20")]
use bevy_reflect::{Reflect, std_traits::ReflectDefault};

/// Method with its settings: those of [`levels::Method`](crate::levels::Method), and a baseline for planned frames.
/// Default: [`Smr`](Self::Smr).
///
/// ```
/// use afterimage::internal::{Method, MethodKind, Smr};
///
/// assert_eq!(Method::from(MethodKind::Smr), Method::Smr(Smr::default()));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
#[cfg_attr(feature = "bevy-0-20", derive(Reflect), reflect(Default))]
#[non_exhaustive]
pub enum Method {
    /// No method: the frame unchanged, except that non-finite pixels are black.
    None,
    /// Temporal antialiasing, which ignores gaze: a baseline for comparison.
    Taa,
    /// Temporal upsampling, which ignores gaze but uses the positions of a planned frame's samples: a baseline for
    /// comparison.
    Taau,
    /// Scale-matched reservoirs.
    Smr(Smr),
    /// Weighted reservoirs (Cantory et al., MIG 2025).
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

/// Settings of [`Method::Smr`], as in [`levels::Smr`](crate::levels::Smr).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
#[cfg_attr(feature = "bevy-0-20", derive(Reflect), reflect(Default))]
pub struct Smr {
    /// Share of equally coarse history in the output: 0 to 0.98. Default 0.9.
    pub accumulate: f32,
    /// Factor on the tolerated color difference of candidate and history: 0.1 to 10. Default 1.
    pub tolerance: f32,
    /// Whether history is scaled to follow changes of light, instead of being rejected. Default true.
    pub relight: bool,
    /// Whether planned frames ([`FoveationKind::Quads`](crate::internal::FoveationKind::Quads)) are antialiased: their
    /// projection is jittered ([`ViewFrame::jitter_px`](crate::internal::ViewFrame::jitter_px), best
    /// [`Foveation::jitter_px`]), and history stores means of samples instead of single ones. Set it in place of other
    /// temporal antialiasing, and only for jittered frames. It has no effect on noisy frames, which are averaged in any
    /// case, or on other frames. Default false.
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

/// Settings of a context: method, foveation and tunables. Presets of full-size frames are those of
/// [`levels::Settings`](crate::levels::Settings); those of planned frames are [`screen`](Self::screen) and
/// [`headset`](Self::headset).
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
    /// Whether frames are noisy, as [`levels::Settings::noisy`](crate::levels::Settings::noisy). The reconstruction of
    /// planned frames then compares means of samples, stores 8 more bytes a pixel and does not relight history. Default
    /// false.
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
    /// [`levels::Settings::paper`](crate::levels::Settings::paper).
    pub fn paper() -> Self {
        Self { method: Method::Wrs(Wrs::default()), ..Self::default() }
    }

    /// [`levels::Settings::weighted`](crate::levels::Settings::weighted).
    pub fn weighted() -> Self {
        Self { method: Method::Wrs(Wrs::weighted()), ..Self::default() }
    }

    /// [`levels::Settings::steady`](crate::levels::Settings::steady), the default.
    pub fn steady() -> Self {
        Self::default()
    }

    /// [`levels::Settings::responsive`](crate::levels::Settings::responsive).
    pub fn responsive() -> Self {
        Self { method: Method::Smr(Smr::responsive()), ..Self::default() }
    }

    /// [`levels::Settings::traced`](crate::levels::Settings::traced).
    pub fn traced() -> Self {
        Self { method: Method::Smr(Smr::traced()), noisy: true, ..Self::default() }
    }

    /// Antialiased frames shaded by quads ([`FoveationKind::Quads`](crate::internal::FoveationKind::Quads)), for
    /// screens about 40 degrees wide: a coarser even pattern and twice the budget of [`Foveation::quads`], 11 % of the
    /// pixels. Frames must be jittered ([`Foveation::jitter_px`]). `docs/quads.md` has the scores.
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
