//! Settings of weighted reservoirs.

use crate::error::{SettingsError, check};
#[cfg(feature = "bevy-0-20")]
use bevy_reflect::{Reflect, std_traits::ReflectDefault};

/// Sampler of [`Method::Wrs`](super::Method::Wrs): rule by which a reservoir chooses between its sample and the
/// candidate. A-Chao and A-ES give the same probability to each candidate. Default: [`AChao`](Self::AChao). Example:
/// [`Wrs`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
#[cfg_attr(feature = "bevy-0-20", derive(Reflect), reflect(Default))]
#[non_exhaustive]
pub enum Sampler {
    /// A-Chao, as in the paper: each frame draws anew against the ratio of weight sums.
    #[default]
    AChao,
    /// A-ES, for comparison: each candidate draws a key once. Needs 8 more bytes of memory and of memory traffic a
    /// pixel. Not with [`GateScale::Candidate`].
    AEs,
    /// The expectation of A-Chao: keeps and shows the mean of history and candidate by the probabilities of A-Chao
    /// instead of drawing, which avoids speckle. Means may be interpolated, so history is read between pixels with
    /// Catmull-Rom weights; the other samplers read the nearest pixel.
    AChaoMean,
}

/// Bias of [`Method::Wrs`](super::Method::Wrs): decay of history's weight, without which new candidates would hardly
/// ever be taken. Default: [`Bernoulli`](Self::Bernoulli). Example: [`Wrs`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
#[cfg_attr(feature = "bevy-0-20", derive(Reflect), reflect(Default))]
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
#[cfg_attr(feature = "bevy-0-20", derive(Reflect), reflect(Default))]
#[non_exhaustive]
pub enum GateMetric {
    /// Delta E 94: lightness, chroma and hue.
    #[default]
    DeltaE94,
    /// Difference of L\* alone; ignores changes of hue.
    Lightness,
}

/// Scale at which a [`Gate`] compares colors. Default: [`Sample`](Self::Sample). Example: [`Gate`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
#[cfg_attr(feature = "bevy-0-20", derive(Reflect), reflect(Default))]
#[non_exhaustive]
pub enum GateScale {
    /// Compares the stored sample with the candidate, as in the paper. A sharp sample differs from the blurred
    /// candidate of the same surface, so that the gate also closes on detail.
    #[default]
    Sample,
    /// Compares the candidate with a reference that is stored beside the sample: the first candidate of the same level
    /// of detail since the sample was taken. The gate closes only where something changed. The level is the frame's
    /// input `lod`, or the level of [`Settings::foveation`](super::Settings::foveation) without that; on planned frames
    /// that of a sample at its own pixel. Needs 8 more bytes of memory and of memory traffic a pixel.
    Candidate,
}

/// Color gate of [`Method::Wrs`](super::Method::Wrs) (eq. 7 of the paper): history loses weight in proportion to its
/// color difference from the candidate.
///
/// ```
/// use afterimage::internal::{Gate, Method, Settings, Wrs};
///
/// // Follows changes of light sooner than the default.
/// let gate = Some(Gate { divisor: 30.0, ..Gate::default() });
/// let settings = Settings { method: Method::Wrs(Wrs { gate, ..Wrs::default() }), ..Settings::default() };
/// settings.validate()?;
/// # Ok::<(), afterimage::SettingsError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
#[cfg_attr(feature = "bevy-0-20", derive(Reflect), reflect(Default))]
pub struct Gate {
    /// Measure of the color difference. Default [`GateMetric::DeltaE94`].
    pub metric: GateMetric,
    /// Scale of the comparison. Default [`GateScale::Sample`].
    pub scale: GateScale,
    /// Difference above `offset` at which history loses all weight, in Delta E: 0.001 to 1e6. A smaller divisor follows
    /// changes of light sooner and keeps less detail, because a sharp sample differs from the blurred candidate of the
    /// same surface. Default 100.
    pub divisor: f32,
    /// Difference up to which history loses no weight, in Delta E: 0 to 1e6. Default 0.
    pub offset: f32,
}

impl Default for Gate {
    fn default() -> Self {
        Self { metric: GateMetric::DeltaE94, scale: GateScale::Sample, divisor: 100.0, offset: 0.0 }
    }
}

/// Settings of [`Method::Wrs`](super::Method::Wrs), weighted reservoirs. The default is the paper's method.
///
/// ```
/// use afterimage::internal::{Bias, Method, Sampler, Settings, Wrs};
///
/// // A variant of the paper's method.
/// let wrs = Wrs { sampler: Sampler::AEs, bias: Bias::Exponential { lambda: 0.1 }, ..Wrs::default() };
/// let settings = Settings { method: Method::Wrs(wrs), ..Settings::default() };
/// settings.validate()?;
/// # Ok::<(), afterimage::SettingsError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
#[cfg_attr(feature = "bevy-0-20", derive(Reflect), reflect(Default))]
pub struct Wrs {
    /// Rule by which a reservoir chooses. Default [`Sampler::AChao`].
    pub sampler: Sampler,
    /// Exponent of the candidate weights, 1 to 8: a candidate outside the fovea weighs `(d(e) / d(r_f))^k`, with the
    /// density of retinal ganglion cells `d` (eq. 4 of the paper). A larger exponent protects samples of the fovea
    /// longer from coarser candidates, and lets the fovea replace coarse samples sooner. Default 1.
    pub weight_exponent: u32,
    /// Exponent of the number of samples a pixel in the candidate weights, 0 to 4: at level of detail `l`, weights are
    /// multiplied by `4^-kl`. A larger exponent replaces coarse samples sooner once the gaze arrives, even where
    /// eccentricity hardly changed. No effect on planned frames, where a candidate's weight depends on the place of its
    /// sample. Default 0, as published.
    pub rate_exponent: u32,
    /// Decay of history's weight. Default [`Bias::Bernoulli`].
    pub bias: Bias,
    /// Color gate; `None` compares no colors, which keeps more detail and ghosts under changing light. Default on.
    pub gate: Option<Gate>,
}

impl Default for Wrs {
    fn default() -> Self {
        Self {
            sampler: Sampler::default(),
            weight_exponent: 1,
            rate_exponent: 0,
            bias: Bias::default(),
            gate: Some(Gate::default()),
        }
    }
}

impl Wrs {
    /// The wrs settings of [`Settings::weighted`](super::Settings::weighted).
    pub fn weighted() -> Self {
        Self {
            sampler: Sampler::AChaoMean,
            weight_exponent: 8,
            rate_exponent: 3,
            gate: Some(Gate { scale: GateScale::Candidate, divisor: 10.0, offset: 3.0, ..Gate::default() }),
            ..Self::default()
        }
    }

    pub(super) fn validate(&self) -> Result<(), SettingsError> {
        if let Bias::Exponential { lambda } = self.bias {
            check("bias.lambda", lambda, 0.0..=80.0, "per frame")?;
        }
        check("weight_exponent", self.weight_exponent as f32, 1.0..=8.0, "")?;
        check("rate_exponent", self.rate_exponent as f32, 0.0..=4.0, "")?;
        let Some(gate) = self.gate else { return Ok(()) };
        if gate.scale == GateScale::Candidate && self.sampler == Sampler::AEs {
            return Err(SettingsError {
                setting: "gate.scale",
                found: "the candidate's with the sampler A-ES".into(),
                expected: "the sample's, or another sampler: keys are stored in the place of references".into(),
            });
        }
        check("gate.divisor", gate.divisor, 1e-3..=1e6, "Delta E")?;
        check("gate.offset", gate.offset, 0.0..=1e6, "Delta E")
    }
}
