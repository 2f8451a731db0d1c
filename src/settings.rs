//! Tunables of the post-process, with units, ranges and what more and less does.

use crate::error::{FrameError, SettingsError};
use crate::foveation::{Filter, Foveation};
use crate::kernel::noise::NOISY_LEVELS;
use crate::kernel::{acuity, matched, reservoir, wrs};

/// What the post-process does with history.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Method {
    /// Nothing: the foveated frame as it came, non-finite pixels made black.
    None,
    /// Temporal antialiasing, which knows nothing of gaze: the rival.
    Taa,
    /// Scale-matched reservoir: the sharpest sample of each surface point, shown while it explains what the renderer delivers.
    #[default]
    Smr,
    /// Weighted reservoirs (Cantory et al., MIG 2025).
    Wrs,
}

/// How a reservoir picks between its sample and the candidate. Both follow the same law; only the use of chance differs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Sampler {
    /// A-Chao, the paper's choice: a fresh draw each frame against the ratio of weight sums.
    #[default]
    AChao,
    /// A-ES, for comparison: each candidate draws a key once. Costs 8 more bytes of memory and traffic a pixel.
    AEs,
}

/// How history is forgotten, so that new candidates keep a chance.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Bias {
    /// Bernoulli survival (eq. 5), the paper's choice: weight sums grow like a square root instead of linearly.
    #[default]
    Bernoulli,
    /// Weight sums lose a constant share each frame. More `lambda` forgets sooner.
    Exponential {
        /// Per frame, >= 0; the factor is `exp(-lambda)`.
        lambda: f32,
    },
    /// Never forgets: after n frames a candidate has a chance of 1/n. For comparison; ghosts under change.
    None,
}

/// What the gate compares.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum GateMetric {
    /// Delta E 94 of the whole color.
    #[default]
    DeltaE94,
    /// L\* alone: blind to changes of hue.
    Lightness,
}

/// The luminance gate of eq. 7: history whose color differs from the candidate's loses weight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gate {
    /// What is compared.
    pub metric: GateMetric,
    /// Difference above the offset at which all weight is lost, in Delta E, > 0. Less follows changes of light sooner and
    /// keeps less detail, because a sharp sample differs from the blurred candidate of the same surface. Default 100.
    pub divisor: f32,
    /// Difference that costs nothing, in Delta E, >= 0. Default 0.
    pub offset: f32,
}

impl Default for Gate {
    fn default() -> Self {
        Self { metric: GateMetric::DeltaE94, divisor: 100.0, offset: 0.0 }
    }
}

/// The depth test that empties reservoirs at occlusions and disocclusions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DepthTest {
    /// Relative difference of distance that still is the same surface, in (0, 1). Less flushes on vector and depth noise, more
    /// lets things at similar distance bleed into each other. Default 0.02.
    pub relative: f32,
    /// Pixels that reprojection may be off along each axis, >= 0: the tolerance grows by the surface's own slope over that
    /// distance, so that grazing planes do not flush. Default 1: half for rounding to the nearest texel, half for the
    /// position of the depth sample within its pixel.
    pub slope_px: f32,
}

impl Default for DepthTest {
    fn default() -> Self {
        Self { relative: 0.02, slope_px: 1.0 }
    }
}

/// Tunables of the scale-matched reservoir.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Smr {
    /// Share of equally coarse history in what is shown, in \[0, 0.98\]. More calms the crawling of coarse blocks under motion and
    /// lags behind light. Default 0.9.
    pub accumulate: f32,
    /// Factor on the differences of candidate and history that are tolerated, in \[0.1, 10\]. More keeps detail through noise and
    /// imprecise vectors, less lets go of it sooner. Default 1.
    pub tolerance: f32,
    /// Whether history follows changes of light by its gain. Default true.
    pub relight: bool,
}

impl Default for Smr {
    fn default() -> Self {
        Self { accumulate: 0.9, tolerance: 1.0, relight: true }
    }
}

/// All tunables. The default is [`Settings::steady`], which measures best on real frames.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// What is done with history.
    pub method: Method,
    /// How the renderer foveates: where its frame is how coarse. Candidates inside the fovea have weight 1.
    pub foveation: Foveation,
    /// Tunables of [`Method::Smr`].
    pub smr: Smr,
    /// Sampler of [`Method::Wrs`].
    pub sampler: Sampler,
    /// How history is forgotten.
    pub bias: Bias,
    /// Color gate; `None` never looks at color: keeps more detail and ghosts under changing light.
    pub gate: Option<Gate>,
    /// Depth test; `None` never looks at depth.
    pub depth_test: Option<DepthTest>,
    /// Frames are noisy, path-traced with few samples, and say how noisy ([`Frame::noise`](crate::gpu::Frame::noise)): noise is no
    /// change then. wrs weighs a candidate by its samples; smr averages equally fine history where the eye looks, too, and compares
    /// means of 8x8 samples. smr keeps 8 more bytes a pixel for it, and a chain of the candidates. Default false.
    pub noisy: bool,
    /// Seed of the random numbers. Same seed, same frames: same bytes.
    pub seed: u64,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            method: Method::default(),
            foveation: Foveation::default(),
            smr: Smr::default(),
            sampler: Sampler::default(),
            bias: Bias::default(),
            gate: Some(Gate::default()),
            depth_test: Some(DepthTest::default()),
            noisy: false,
            seed: 0,
        }
    }
}

impl Settings {
    /// The paper's method (Cantory et al., MIG 2025), literally: weighted reservoirs, A-Chao, Bernoulli survival, Delta E 94 gate.
    /// Looks like the foveated frame with single sharp pixels strewn in, more of them the longer the eye stayed. The cheapest.
    pub fn paper() -> Self {
        Self { method: Method::Wrs, ..Self::default() }
    }

    /// smr for calm: sharp where the eye has been, coarse blocks averaged over time, so that they do not crawl.
    pub fn steady() -> Self {
        Self { method: Method::Smr, smr: Smr::default(), ..Self::default() }
    }

    /// smr that lets go of history sooner where it no longer fits, and averages less: moving things and changes of light flicker less,
    /// and less detail outlives a moving camera (2 dB of what was retained on Sponza). Costs the same.
    pub fn responsive() -> Self {
        Self { method: Method::Smr, smr: Smr { accumulate: 0.7, tolerance: 0.6, ..Smr::default() }, ..Self::default() }
    }

    /// smr for frames that are path-traced with few samples: noise is averaged away, over twice as many frames as coarse blocks are by
    /// [`steady`](Self::steady). Every frame brings its noise.
    pub fn traced() -> Self {
        Self { noisy: true, smr: Smr { accumulate: 0.95, ..Smr::default() }, ..Self::steady() }
    }

    /// Checks every range.
    ///
    /// # Errors
    /// Names the first setting outside its range.
    pub fn validate(&self) -> Result<(), SettingsError> {
        self.foveation.validate()?;
        check("smr.accumulate", self.smr.accumulate, 0.0..=0.98, "")?;
        check("smr.tolerance", self.smr.tolerance, 0.1..=10.0, "")?;
        if let Bias::Exponential { lambda } = self.bias {
            check("bias lambda", lambda, 0.0..=80.0, "per frame")?;
        }
        if let Some(gate) = self.gate {
            check("gate divisor", gate.divisor, 1e-3..=1e6, "Delta E")?;
            check("gate offset", gate.offset, 0.0..=1e6, "Delta E")?;
        }
        if let Some(test) = self.depth_test {
            check("depth_test.relative", test.relative, 1e-4..=0.999, "")?;
            check("depth_test.slope_px", test.slope_px, 0.0..=64.0, "pixels")?;
        }
        Ok(())
    }

    /// Refuses a view that brings noise where none is expected, and the other way round.
    pub(crate) fn check_noise(&self, view: usize, given: bool) -> Result<(), FrameError> {
        let expected = match (self.noisy, given) {
            (true, false) => "a texture, as Settings::noisy is set",
            (false, true) => "none, or Settings::noisy set",
            _ => return Ok(()),
        };
        let found = if given { "a texture" } else { "None" };
        Err(FrameError::Value { what: "noise", view, found: found.into(), expected })
    }

    /// Whether reservoirs need a key besides their weight sum.
    pub(crate) fn uses_keys(&self) -> bool {
        self.sampler == Sampler::AEs
    }

    /// What the method keeps between frames.
    pub(crate) fn history_layout(&self) -> HistoryLayout {
        match self.method {
            Method::None => HistoryLayout::Nothing,
            Method::Wrs => HistoryLayout::Reservoirs { keys: self.uses_keys() },
            Method::Taa => HistoryLayout::Surfaces { levels: 0, noisy: false },
            // Two beyond the candidate's: one for its contrast, one to blend with; blocks are compared one level coarser.
            Method::Smr => {
                let shift = if self.foveation.filter == Filter::Block { 3 } else { 2 };
                let shift = if self.noisy { 2 + NOISY_LEVELS as u32 } else { shift };
                HistoryLayout::Surfaces { levels: self.foveation.max_level() + shift, noisy: self.noisy }
            }
        }
    }

    /// The kernel's form of smr's tunables.
    pub(crate) fn smr_params(&self) -> matched::SmrParams {
        // Noise is more than what point samples alias.
        let blocks = self.foveation.filter == Filter::Block && !self.noisy;
        matched::SmrParams {
            accumulate: self.smr.accumulate,
            // Coarse history is only a mean, so a stricter fit costs little, but the noise of point samples needs the mean.
            accumulate_tolerance: if blocks { 1.0 } else { 0.5 },
            tolerance: self.smr.tolerance,
            blocks,
            relight: self.smr.relight,
            noisy: self.noisy,
        }
    }

    /// Bytes that the pass reads and writes a pixel, for which of depth, motion and trust are given, stored as engines store them.
    pub fn traffic_bytes_per_pixel(&self, given: [bool; 3]) -> u32 {
        let (color, output) = (8, 8);
        let history = match self.method {
            Method::None => return color + output,
            Method::Wrs => 2 * if self.uses_keys() { 16 } else { 12 },
            Method::Taa => 2 * 8,
            // The chain, a third of the pixels at 8 bytes: read once by the pass, written, and read again but for its first level.
            Method::Smr => 2 * 8 + 8,
        };
        let inputs: u32 = given.iter().zip([4, 4, 1]).map(|(&given, bytes)| if given { bytes } else { 0 }).sum();
        let noise = match (self.noisy, self.method) {
            (true, Method::Wrs) => 4,
            // The candidates' chain reads color and noise, and is written, read for its own levels and read by the pass like the other
            // one; noise itself, and 4 bytes of it remembered.
            (true, Method::Smr) => (8 + 4 + 8) + 4 + 2 * 4,
            _ => 0,
        };
        color + inputs + noise + history + output
    }

    /// `1 / cell_density(fovea radius)`, the scale of candidate weights outside the fovea.
    pub(crate) fn inv_density_at_fovea(&self) -> f32 {
        1.0 / acuity::cell_density(0.5 * self.foveation.fovea_deg)
    }

    /// The kernel's form of the method's tunables.
    pub(crate) fn wrs_params(&self) -> wrs::WrsParams {
        let (bias, exponential_survival) = match self.bias {
            Bias::Bernoulli => (wrs::BiasCode::Bernoulli, 1.0),
            Bias::Exponential { lambda } => (wrs::BiasCode::Exponential, reservoir::exponential_survival(lambda)),
            Bias::None => (wrs::BiasCode::None, 1.0),
        };
        let gate = self.gate.unwrap_or_default();
        wrs::WrsParams {
            sampler: match self.sampler {
                Sampler::AChao => wrs::SamplerCode::AChao,
                Sampler::AEs => wrs::SamplerCode::AEs,
            },
            bias,
            exponential_survival,
            gate: match (self.gate, gate.metric) {
                (None, _) => wrs::GateCode::Off,
                (_, GateMetric::DeltaE94) => wrs::GateCode::DeltaE94,
                (_, GateMetric::Lightness) => wrs::GateCode::Lightness,
            },
            gate_offset: gate.offset,
            inv_gate_divisor: 1.0 / gate.divisor,
        }
    }
}

/// What is kept between frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum HistoryLayout {
    /// Nothing.
    Nothing,
    /// Packed reservoirs ([`pack`](crate::kernel::pack)), and keys for A-ES.
    Reservoirs {
        /// Whether there are keys.
        keys: bool,
    },
    /// Packed surfaces ([`surface`](crate::kernel::surface)), and coarser levels of them.
    Surfaces {
        /// Levels beyond the full-rate one.
        levels: u32,
        /// Whether there is noise ([`noise`](crate::kernel::noise)), and a chain of the candidates.
        noisy: bool,
    },
}

/// Refuses a number outside `range`, NaN included.
pub(crate) fn check(
    setting: &'static str,
    value: f32,
    range: std::ops::RangeInclusive<f32>,
    unit: &str,
) -> Result<(), SettingsError> {
    if range.contains(&value) {
        Ok(())
    } else {
        let (low, high) = (range.start(), range.end());
        Err(SettingsError {
            setting,
            found: value.to_string(),
            expected: format!("{low} to {high} {unit}").trim_end().to_owned(),
        })
    }
}
