//! Methods and their tunables.

use afterimage::{Bias, DepthTest, Gate, GateMetric, Method, Sampler, Settings, Smr};
use clap::{Args, ValueEnum};

/// Names of methods.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum MethodName {
    /// The foveated frame alone
    None,
    /// Temporal antialiasing of the foveated frame
    Taa,
    /// Scale-matched reservoir
    Smr,
    /// Weighted reservoirs: A-Chao with Bernoulli bias
    Wrs,
    /// Best level of detail ever shown; stills only
    Oracle,
}

impl MethodName {
    /// As typed, and as folders are named.
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Taa => "taa",
            Self::Smr => "smr",
            Self::Wrs => "wrs",
            Self::Oracle => "oracle",
        }
    }
}

/// Ablations of the reservoir method.
#[derive(Args, Clone, Debug)]
pub struct WrsArgs {
    /// How a reservoir picks its sample
    #[arg(long, value_enum, default_value = "a-chao")]
    pub wrs_sampler: SamplerName,
    /// How history is forgotten: bernoulli, exponential:LAMBDA (per frame), or none
    #[arg(long, default_value = "bernoulli", value_parser = parse_bias, value_name = "BIAS")]
    pub wrs_bias: Bias,
    /// Color difference at which the gate is shut, Delta E 94 above the offset
    #[arg(long, default_value_t = 100.0, value_name = "X")]
    pub gate_divisor: f32,
    /// Color difference that costs nothing, Delta E 94
    #[arg(long, default_value_t = 0.0, value_name = "X")]
    pub gate_offset: f32,
    /// What the gate compares: the whole color, or its lightness alone
    #[arg(long, value_enum, default_value = "delta-e94")]
    pub gate_metric: GateMetricName,
    /// Never look at color
    #[arg(long)]
    pub no_gate: bool,
    /// smr: largest share of equally coarse history in what is shown, 0 to 0.98; default: 0.9, of frames traced with --sampling 0.95
    #[arg(long, value_name = "X")]
    pub smr_accumulate: Option<f32>,
    /// smr: factor on the differences from history that are tolerated, 0.1 to 10
    #[arg(long, default_value_t = Smr::default().tolerance, value_name = "X")]
    pub smr_tolerance: f32,
    /// smr: do not follow changes of light
    #[arg(long)]
    pub no_relight: bool,
    /// Relative difference of distance that is still the same surface, above 0 and below 1
    #[arg(long, default_value_t = DepthTest::default().relative, value_name = "X")]
    pub depth_relative: f32,
    /// Pixels of a surface's own slope that its distance may be off, 0 to 64; 0: the test knows no slope
    #[arg(long, default_value_t = DepthTest::default().slope_px, value_name = "PX")]
    pub depth_slope: f32,
    /// Never look at depth
    #[arg(long)]
    pub no_flush: bool,
}

impl WrsArgs {
    /// The library's form of a method.
    pub fn settings(&self, method: Method, seed: u64, noisy: bool) -> Settings {
        let preset = if noisy { Settings::traced() } else { Settings::default() };
        Settings {
            method,
            sampler: match self.wrs_sampler {
                SamplerName::AChao => Sampler::AChao,
                SamplerName::AEs => Sampler::AEs,
            },
            bias: self.wrs_bias,
            gate: (!self.no_gate).then_some(Gate {
                divisor: self.gate_divisor,
                offset: self.gate_offset,
                metric: match self.gate_metric {
                    GateMetricName::DeltaE94 => GateMetric::DeltaE94,
                    GateMetricName::Lightness => GateMetric::Lightness,
                },
            }),
            depth_test: (!self.no_flush)
                .then_some(DepthTest { relative: self.depth_relative, slope_px: self.depth_slope }),
            smr: Smr {
                accumulate: self.smr_accumulate.unwrap_or(preset.smr.accumulate),
                tolerance: self.smr_tolerance,
                relight: !self.no_relight,
            },
            seed,
            ..preset
        }
    }
}

/// Names of samplers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum SamplerName {
    /// By the ratio of weight sums
    AChao,
    /// By the larger key
    AEs,
}

/// Names of what the gate compares.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum GateMetricName {
    /// The whole color
    #[value(name = "delta-e94")]
    DeltaE94,
    /// Lightness alone: blind to changes of hue
    Lightness,
}

fn parse_bias(text: &str) -> Result<Bias, String> {
    let expected = "expected bernoulli, exponential:LAMBDA with LAMBDA >= 0, or none";
    match text.split_once(':') {
        None if text == "bernoulli" => Ok(Bias::Bernoulli),
        None if text == "none" => Ok(Bias::None),
        Some(("exponential", lambda)) => lambda
            .parse()
            .map(|lambda| Bias::Exponential { lambda })
            .map_err(|_| format!("lambda '{lambda}' is not a number: {expected}")),
        _ => Err(expected.into()),
    }
}
