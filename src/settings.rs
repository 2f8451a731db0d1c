//! Settings of the post-process.

use crate::error::{SettingsError, check};
use crate::foveation::Foveation;

/// Method: how history is stored and combined with the foveated frame. Default: [`Smr`](Self::Smr).
///
/// ```
/// use afterimage::{Method, Settings};
///
/// let settings = Settings { method: Method::Taa, ..Settings::default() };
/// assert_eq!(settings.method.name(), "taa");
/// assert_eq!(Method::from_name("smr"), Some(Method::Smr));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
#[non_exhaustive]
pub enum Method {
    /// No method: the foveated frame unchanged, except that non-finite pixels are black. No history.
    None,
    /// Temporal antialiasing, which ignores gaze: a baseline for comparison.
    Taa,
    /// Scale-matched reservoirs: the sharpest sample of each surface point is shown as long as it explains the foveated
    /// frame.
    #[default]
    Smr,
    /// Weighted reservoirs (Cantory et al., MIG 2025): a random sample of each surface point, weighted by retinal
    /// acuity.
    Wrs,
    /// Temporal upsampling, which ignores gaze but knows where a sparse frame has its samples: a baseline for
    /// comparison.
    Taau,
}

/// Sampler of [`Method::Wrs`]: rule by which a reservoir chooses between its sample and the candidate. Both give the
/// same probability to each candidate. Default: [`AChao`](Self::AChao). Example: [`Settings`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
#[non_exhaustive]
pub enum Sampler {
    /// A-Chao, as in the paper: each frame draws anew against the ratio of weight sums.
    #[default]
    AChao,
    /// A-ES, for comparison: each candidate draws a key once. Needs 8 more bytes of memory and of memory traffic a
    /// pixel. Not with [`GateScale::Candidate`].
    AEs,
    /// The expectation of A-Chao: keeps and shows the mean of history and candidate by the probabilities of A-Chao
    /// instead of drawing, so that nothing speckles. Means may be interpolated, so history is read between pixels by
    /// Catmull-Rom weights; samples are read from the nearest pixel.
    AChaoMean,
}

/// Bias of [`Method::Wrs`]: decay of history's weight, without which new candidates would hardly ever be taken.
/// Default: [`Bernoulli`](Self::Bernoulli). Example: [`Settings`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
#[non_exhaustive]
pub enum Bias {
    /// Bernoulli survival (eq. 5 of the paper): weight sums grow like a square root instead of linearly.
    #[default]
    Bernoulli,
    /// Exponential decay: weight sums are multiplied by `exp(-lambda)` each frame.
    Exponential {
        /// Decay rate per frame, 0 to 80. More adapts sooner, and keeps less detail.
        lambda: f32,
    },
    /// No decay, for comparison: the n-th candidate is taken with a probability of 1/n. Ghosts when something changes.
    None,
}

/// Color difference that a [`Gate`] measures. Default: [`DeltaE94`](Self::DeltaE94). Example: [`Gate`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
#[non_exhaustive]
pub enum GateMetric {
    /// Delta E 94: lightness, chroma and hue.
    #[default]
    DeltaE94,
    /// Difference of L\* alone: does not see changes of hue.
    Lightness,
}

/// Scale at which a [`Gate`] compares colors. Default: [`Sample`](Self::Sample). Example: [`Gate`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
#[non_exhaustive]
pub enum GateScale {
    /// The stored sample with the candidate, as in the paper: a sharp sample differs from the blurred candidate of the
    /// same surface, so that the gate also closes on detail.
    #[default]
    Sample,
    /// The candidate with the reference that is stored beside the sample: the first candidate of the same level of
    /// detail since the sample was taken. Closes only where something changed. The level is that of
    /// the frame's input `lod`, of [`Settings::foveation`] without that, or of the lattices. Needs 8 more bytes of
    /// memory and of memory traffic a pixel.
    Candidate,
}

/// Color gate of [`Method::Wrs`] (eq. 7 of the paper): history loses weight in proportion to its color difference from
/// the candidate.
///
/// ```
/// use afterimage::{Gate, Settings};
///
/// // Follows changes of light sooner than the default.
/// let settings = Settings { gate: Some(Gate { divisor: 30.0, ..Gate::default() }), ..Settings::paper() };
/// settings.validate()?;
/// # Ok::<(), afterimage::SettingsError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
pub struct Gate {
    /// Measure of the color difference. Default [`GateMetric::DeltaE94`].
    pub metric: GateMetric,
    /// What is compared with the candidate. Default [`GateScale::Sample`].
    pub scale: GateScale,
    /// Difference above `offset` at which history loses all weight, in Delta E: 0.001 to 1e6. Less follows changes of
    /// light sooner and keeps less detail, because a sharp sample differs from the blurred candidate of the same
    /// surface. Default 100.
    pub divisor: f32,
    /// Difference up to which history loses no weight, in Delta E: 0 to 1e6. Default 0.
    pub offset: f32,
}

impl Default for Gate {
    fn default() -> Self {
        Self { metric: GateMetric::DeltaE94, scale: GateScale::Sample, divisor: 100.0, offset: 0.0 }
    }
}

/// Depth test: rejects history at occlusions and disocclusions. Applies to frames with a depth input.
///
/// ```
/// use afterimage::{DepthTest, Settings};
///
/// // Tolerates more depth noise than the default.
/// let test = DepthTest { relative: 0.05, ..DepthTest::default() };
/// let settings = Settings { depth_test: Some(test), ..Settings::default() };
/// settings.validate()?;
/// # Ok::<(), afterimage::SettingsError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
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

/// Settings of [`Method::Smr`], scale-matched reservoirs.
///
/// ```
/// use afterimage::{Settings, Smr};
///
/// // Averages coarse regions over fewer frames than the default.
/// let settings = Settings { smr: Smr { accumulate: 0.8, ..Smr::default() }, ..Settings::default() };
/// settings.validate()?;
/// # Ok::<(), afterimage::SettingsError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
pub struct Smr {
    /// Share of equally coarse history in the output: 0 to 0.98. More reduces the flicker of coarse regions in motion,
    /// and follows changes of light later. Default 0.9.
    pub accumulate: f32,
    /// Factor on the tolerated color difference of candidate and history: 0.1 to 10. More keeps detail in spite of
    /// noise and imprecise motion vectors; less rejects outdated history sooner. Default 1.
    pub tolerance: f32,
    /// Whether history is scaled to follow changes of light, instead of being rejected. Default true.
    pub relight: bool,
}

impl Default for Smr {
    fn default() -> Self {
        Self { accumulate: 0.9, tolerance: 1.0, relight: true }
    }
}

/// Settings of a context: method, foveation and tunables. They can be changed between frames (`set_settings` of either
/// executor).
///
/// The default is [`Settings::steady`], which measures best on real frames. Other presets are
/// [`responsive`](Self::responsive), [`traced`](Self::traced), [`weighted`](Self::weighted) and [`paper`](Self::paper).
///
/// ```
/// use afterimage::{Bias, ContextDesc, Sampler, Settings};
///
/// let mut desc = ContextDesc::new([1920, 1080]);
/// desc.settings = Settings { seed: 7, ..Settings::responsive() };
///
/// // A variant of the paper's method.
/// let bias = Bias::Exponential { lambda: 0.1 };
/// let variant = Settings { sampler: Sampler::AEs, bias, ..Settings::paper() };
/// variant.validate()?;
/// # Ok::<(), afterimage::SettingsError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
pub struct Settings {
    /// Method: how history is stored and combined with the frame. Default [`Method::Smr`].
    pub method: Method,
    /// Foveation of the renderer: level of detail by eccentricity. Set it as your renderer foveates.
    pub foveation: Foveation,
    /// Settings of [`Method::Smr`].
    pub smr: Smr,
    /// Sampler of [`Method::Wrs`]. Default [`Sampler::AChao`].
    pub sampler: Sampler,
    /// Exponent of the candidate weights of [`Method::Wrs`], 1 to 8: a candidate outside the fovea weighs
    /// `(d(e) / d(r_f))^k`, with the density of retinal ganglion cells `d` (eq. 4 of the paper). More protects samples
    /// of the fovea longer from coarser candidates, and lets the fovea replace coarse samples sooner. Default 1.
    pub weight_exponent: u32,
    /// Exponent of the number of samples a pixel in the candidate weights of [`Method::Wrs`], 0 to 4: at level of
    /// detail `l`, weights are multiplied by `4^-kl`. More replaces coarse samples sooner once the gaze arrives, also
    /// where eccentricity hardly changed. Not on sparse frames, whose candidates count by the place of their sample.
    /// Default 0, as published.
    pub rate_exponent: u32,
    /// Decay of history's weight in [`Method::Wrs`]. Default [`Bias::Bernoulli`].
    pub bias: Bias,
    /// Color gate of [`Method::Wrs`]; `None` compares no colors, which keeps more detail and ghosts under changing
    /// light. Default on.
    pub gate: Option<Gate>,
    /// Depth test; `None` compares no depths. Default on.
    pub depth_test: Option<DepthTest>,
    /// Whether frames are noisy, that is path-traced with few samples a pixel. Each frame must then have a noise input
    /// ([`Frame::noise`](crate::Frame::noise)), so that noise does not pass for a change. wrs weights a candidate by
    /// its number of samples; smr averages history in the fovea, too, compares means of 8x8 candidates, and stores 8
    /// more bytes a pixel and a mip chain of the candidates. On sparse frames it compares nine samples, needs the 8
    /// bytes alone, and does not follow changes of light by gains. Default false.
    pub noisy: bool,
    /// Seed of the random numbers. The same seed and the same frames give the same bytes. Default 0.
    pub seed: u64,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            method: Method::default(),
            foveation: Foveation::default(),
            smr: Smr::default(),
            sampler: Sampler::default(),
            weight_exponent: 1,
            rate_exponent: 0,
            bias: Bias::default(),
            gate: Some(Gate::default()),
            depth_test: Some(DepthTest::default()),
            noisy: false,
            seed: 0,
        }
    }
}

impl Settings {
    /// The paper's method (Cantory et al., MIG 2025) as published: weighted reservoirs, A-Chao, Bernoulli survival,
    /// Delta E 94 gate. Looks like the foveated frame with scattered sharp pixels, more of them the longer the eye
    /// stayed. The cheapest preset.
    pub fn paper() -> Self {
        Self { method: Method::Wrs, ..Self::default() }
    }

    /// Weighted reservoirs that reach the paper's gains: the gate compares at the candidate's scale, weights fall with
    /// the eighth power of the density and the third of the samples a pixel, and reservoirs keep means. Keeps most of
    /// the detail that [`steady`](Self::steady) keeps of a still view, and less of it in motion.
    pub fn weighted() -> Self {
        Self {
            sampler: Sampler::AChaoMean,
            weight_exponent: 8,
            rate_exponent: 3,
            gate: Some(Gate { scale: GateScale::Candidate, divisor: 10.0, offset: 3.0, ..Gate::default() }),
            ..Self::paper()
        }
    }

    /// smr for a steady image: sharp where the eye has been, coarse regions averaged over time, so that they do not
    /// flicker. The default.
    pub fn steady() -> Self {
        Self { method: Method::Smr, smr: Smr::default(), ..Self::default() }
    }

    /// smr that rejects outdated history sooner and averages over fewer frames: moving objects and changes of light
    /// flicker less, but less detail survives a moving camera (2 dB of what was retained on Sponza). The same cost as
    /// [`steady`](Self::steady).
    pub fn responsive() -> Self {
        Self { method: Method::Smr, smr: Smr { accumulate: 0.7, tolerance: 0.6, ..Smr::default() }, ..Self::default() }
    }

    /// smr for frames that are path-traced with few samples a pixel: averages over twice as many frames as
    /// [`steady`](Self::steady). Each frame must have a noise input ([`Frame::noise`](crate::Frame::noise)).
    pub fn traced() -> Self {
        Self { noisy: true, smr: Smr { accumulate: 0.95, ..Smr::default() }, ..Self::steady() }
    }

    /// Checks the range of every setting.
    ///
    /// # Errors
    /// [`SettingsError`] for the first setting that is out of range.
    pub fn validate(&self) -> Result<(), SettingsError> {
        self.foveation.validate()?;
        check("smr.accumulate", self.smr.accumulate, 0.0..=0.98, "")?;
        check("smr.tolerance", self.smr.tolerance, 0.1..=10.0, "")?;
        if let Bias::Exponential { lambda } = self.bias {
            check("bias lambda", lambda, 0.0..=80.0, "per frame")?;
        }
        check("weight_exponent", self.weight_exponent as f32, 1.0..=8.0, "")?;
        check("rate_exponent", self.rate_exponent as f32, 0.0..=4.0, "")?;
        if let Some(gate) = self.gate {
            if gate.scale == GateScale::Candidate && self.sampler == Sampler::AEs {
                return Err(SettingsError {
                    setting: "gate scale",
                    found: "the candidate's with the sampler A-ES".into(),
                    expected: "the sample's, or another sampler: keys are stored in the place of references".into(),
                });
            }
            check("gate divisor", gate.divisor, 1e-3..=1e6, "Delta E")?;
            check("gate offset", gate.offset, 0.0..=1e6, "Delta E")?;
        }
        if let Some(test) = self.depth_test {
            check("depth_test.relative", test.relative, 1e-4..=0.999, "")?;
            check("depth_test.slope_px", test.slope_px, 0.0..=64.0, "pixels")?;
        }
        Ok(())
    }
}
