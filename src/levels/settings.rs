//! Settings of the post-process for frames with levels of detail.

use super::Foveation;
use crate::error::SettingsError;
use crate::settings::{self, DepthTest, Wrs};

/// Method with its settings: how history is stored and combined with the foveated frame. Default:
/// [`Smr`](Self::Smr).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
#[non_exhaustive]
pub enum Method {
    /// No method: the foveated frame unchanged, except that non-finite pixels are black. No history.
    None,
    /// Temporal antialiasing, which ignores gaze: a baseline for comparison.
    Taa,
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

/// Settings of [`Method::Smr`], scale-matched reservoirs.
///
/// ```
/// use afterimage::levels::{Method, Settings, Smr};
///
/// // Averages coarse regions over fewer frames than the default.
/// let method = Method::Smr(Smr { accumulate: 0.8, ..Smr::default() });
/// let settings = Settings { method, ..Settings::default() };
/// settings.validate()?;
/// # Ok::<(), afterimage::SettingsError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
pub struct Smr {
    /// Share of equally coarse history in the output: 0 to 0.98. A larger share reduces the flicker of coarse regions
    /// in motion, and follows changes of light later. Default 0.9.
    pub accumulate: f32,
    /// Factor on the tolerated color difference of candidate and history: 0.1 to 10. More keeps detail in spite of
    /// noise and imprecise motion vectors; less rejects outdated history sooner. Default 1.
    pub tolerance: f32,
    /// Whether history is scaled to follow changes of light, instead of being rejected. Default true.
    pub relight: bool,
}

impl Default for Smr {
    fn default() -> Self {
        settings::Smr::default().into()
    }
}

impl From<settings::Smr> for Smr {
    fn from(smr: settings::Smr) -> Self {
        let settings::Smr { accumulate, tolerance, relight, .. } = smr;
        Self { accumulate, tolerance, relight }
    }
}

/// Settings of a context: method, foveation and tunables. They can be changed between frames
/// ([`Afterimage::set_settings`](super::Afterimage::set_settings)).
///
/// The default is [`Settings::steady`], which measures best on real frames. Other presets are
/// [`responsive`](Self::responsive), [`traced`](Self::traced), [`weighted`](Self::weighted) and [`paper`](Self::paper).
///
/// ```
/// use afterimage::levels::Settings;
///
/// let settings = Settings { seed: 7, ..Settings::responsive() };
/// settings.validate()?;
/// # Ok::<(), afterimage::SettingsError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
pub struct Settings {
    /// Method with its settings: how history is stored and combined with the frame. Default [`Method::Smr`].
    pub method: Method,
    /// Foveation of the renderer: level of detail by eccentricity. Set it to match your renderer.
    pub foveation: Foveation,
    /// Depth test; `None` compares no depths. Default on.
    pub depth_test: Option<DepthTest>,
    /// Whether frames are noisy, that is path-traced with few samples a pixel. Each frame must then have a noise input
    /// ([`FrameInputs::noise`](super::FrameInputs::noise)), so that noise is not mistaken for a change. wrs weights a
    /// candidate by its number of samples; smr averages history in the fovea, too, compares means of 8x8 candidates,
    /// and stores 8 more bytes a pixel and a mip chain of the candidates. Default false.
    pub noisy: bool,
    /// Seed of the random numbers. The same seed and the same frames give the same bytes. Default 0.
    pub seed: u64,
}

impl Default for Settings {
    fn default() -> Self {
        Self::steady()
    }
}

impl Settings {
    /// The paper's method (Cantory et al., MIG 2025) as published: weighted reservoirs, A-Chao, Bernoulli survival,
    /// Delta E 94 gate. The result looks like the foveated frame with scattered sharp pixels, and their number grows
    /// while the eye fixates. The cheapest preset.
    pub fn paper() -> Self {
        Self::of(settings::Settings::paper())
    }

    /// Weighted reservoirs that reach the gains that the paper reports: the gate compares at the candidate's scale,
    /// weights fall with the eighth power of the density and the third power of the samples a pixel, and reservoirs
    /// keep means. In a still view they keep most of the detail that [`steady`](Self::steady) keeps; in motion they
    /// keep less of it.
    pub fn weighted() -> Self {
        Self::of(settings::Settings::weighted())
    }

    /// smr for a steady image: sharp where the eye has been, coarse regions averaged over time, so that they do not
    /// flicker. The default.
    pub fn steady() -> Self {
        Self::of(settings::Settings::steady())
    }

    /// smr that rejects outdated history sooner and averages over fewer frames: moving objects and changes of light
    /// flicker less, but less detail survives a moving camera (on Sponza, retained detail loses 2 dB). The same cost as
    /// [`steady`](Self::steady).
    pub fn responsive() -> Self {
        Self::of(settings::Settings::responsive())
    }

    /// smr for frames that are path-traced with few samples a pixel: averages over twice as many frames as
    /// [`steady`](Self::steady). Each frame must have a noise input
    /// ([`FrameInputs::noise`](super::FrameInputs::noise)).
    pub fn traced() -> Self {
        Self::of(settings::Settings::traced())
    }

    /// Checks the range of every setting.
    ///
    /// # Errors
    /// [`SettingsError`] for the first setting that is out of range.
    pub fn validate(&self) -> Result<(), SettingsError> {
        self.passes().validate()
    }

    /// A preset of the passes, with the default foveation.
    fn of(preset: settings::Settings) -> Self {
        let settings::Settings { method, depth_test, noisy, seed, .. } = preset;
        let method = match method {
            settings::Method::Wrs(wrs) => Method::Wrs(wrs),
            settings::Method::Smr(smr) => Method::Smr(smr.into()),
            other => unreachable!("no preset has {}", other.name()),
        };
        Self { method, foveation: Foveation::default(), depth_test, noisy, seed }
    }

    /// The settings as the passes take them.
    pub(super) fn passes(self) -> settings::Settings {
        let method = match self.method {
            Method::None => settings::Method::None,
            Method::Taa => settings::Method::Taa,
            Method::Smr(Smr { accumulate, tolerance, relight }) => {
                settings::Method::Smr(settings::Smr { accumulate, tolerance, relight, antialias: false })
            }
            Method::Wrs(wrs) => settings::Method::Wrs(wrs),
        };
        let Self { depth_test, noisy, seed, .. } = self;
        settings::Settings { method, foveation: self.foveation.passes(), depth_test, noisy, seed }
    }
}
