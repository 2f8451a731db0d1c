//! Tunables of the post-process, with units, ranges and what more and less does.

use crate::error::{SettingsError, check};
use crate::foveation::Foveation;

/// Method of the post-process: what it does with history.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Method {
    /// The foveated frame as it came; non-finite pixels are black. Keeps no history.
    None,
    /// Temporal antialiasing, which knows nothing of gaze: the rival.
    Taa,
    /// Scale-matched reservoirs: the sharpest sample of each surface point, shown while it explains the renderer's frame.
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
}
