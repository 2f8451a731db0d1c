//! Methods and their settings.

use super::{Named, by_name};
use afterimage::internal::{
    Bias, DepthTest, Gate, GateMetric, GateScale, Method, MethodKind, Sampler, Settings, Smr, Wrs,
};
use clap::{Args, ValueEnum};

/// Values of `--method`: the library's methods, and the upper bound of any reuse.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MethodName {
    /// A method of the post-process.
    Post(MethodKind),
    /// Best level of detail ever shown; stills only.
    Oracle,
}

impl Named for MethodName {
    fn rows() -> Vec<(Self, &'static str, &'static str)> {
        let posts = MethodKind::ALL.map(|method| (Self::Post(method), method.name(), method.summary()));
        let oracle = (Self::Oracle, "oracle", "best level of detail ever shown; stills only");
        posts.into_iter().chain([oracle]).collect()
    }
}

/// Heading of these options in the help.
const HEADING: &str = "Settings of methods";

/// Settings and ablations of the methods.
#[derive(Args, Clone, Debug)]
pub struct MethodArgs {
    /// wrs: the paper literally, or with a gate at the candidate's scale, sharper weights and means; the options below
    /// replace its parts
    #[arg(long, value_enum, default_value = "paper", help_heading = HEADING)]
    pub wrs_preset: WrsPresetName,
    /// Sampling algorithm of the reservoir; default: a-chao, for --wrs-preset weighted a-chao-mean
    #[arg(long, value_parser = by_name::<Sampler>(), help_heading = HEADING)]
    pub wrs_sampler: Option<Sampler>,
    /// Exponent of the density in candidate weights, 1 to 8; default: 1, for --wrs-preset weighted 8
    #[arg(long, value_name = "N", help_heading = HEADING)]
    pub wrs_exponent: Option<u32>,
    /// Exponent of the samples a pixel in candidate weights, 0 to 4; default: 0, for --wrs-preset weighted 3
    #[arg(long, value_name = "N", help_heading = HEADING)]
    pub wrs_rate_exponent: Option<u32>,
    /// Decay of the history's weight: bernoulli, exponential:LAMBDA (per frame), or none
    #[arg(long, default_value = "bernoulli", value_parser = parse_bias, value_name = "BIAS", help_heading = HEADING)]
    pub wrs_bias: Bias,
    /// What the color gate compares with the candidate: the stored sample, or the first candidate of the same level of
    /// detail since; default: sample, for --wrs-preset weighted candidate
    #[arg(long, value_parser = by_name::<GateScale>(), help_heading = HEADING)]
    pub gate_scale: Option<GateScale>,
    /// Color difference above the offset at which the gate closes, Delta E 94; default: 100, for --wrs-preset weighted
    /// 10
    #[arg(long, value_name = "X", help_heading = HEADING)]
    pub gate_divisor: Option<f32>,
    /// Color difference that the gate ignores, Delta E 94; default: 0, for --wrs-preset weighted 3
    #[arg(long, value_name = "X", help_heading = HEADING)]
    pub gate_offset: Option<f32>,
    /// Color difference of the gate: of the whole color, or of lightness alone
    #[arg(long, value_parser = by_name::<GateMetric>(), default_value = "delta-e94", help_heading = HEADING)]
    pub gate_metric: GateMetric,
    /// Turn the color gate off
    #[arg(long, help_heading = HEADING)]
    pub no_gate: bool,
    /// smr: largest weight of history at the same level of detail, 0 to 0.98; default: 0.9, for frames traced with
    /// --sampling 0.95
    #[arg(long, value_name = "X", help_heading = HEADING)]
    pub smr_accumulate: Option<f32>,
    /// smr: factor on the tolerated difference from history, 0.1 to 10
    #[arg(long, default_value_t = Smr::default().tolerance, value_name = "X", help_heading = HEADING)]
    pub smr_tolerance: f32,
    /// smr: do not adapt history to changes of light
    #[arg(long, help_heading = HEADING)]
    pub no_relight: bool,
    /// Depth test: relative depth difference within one surface, above 0 and below 1
    #[arg(long, default_value_t = DepthTest::default().relative, value_name = "X", help_heading = HEADING)]
    pub depth_relative: f32,
    /// Depth test: tolerated depth change along the surface's slope, in pixels of offset, 0 to 64; 0: ignore the slope
    #[arg(long, default_value_t = DepthTest::default().slope_px, value_name = "PX", help_heading = HEADING)]
    pub depth_slope: f32,
    /// Turn the depth test off: history is never rejected as disoccluded
    #[arg(long, visible_alias = "no-flush", help_heading = HEADING)]
    pub no_depth_test: bool,
}

impl MethodArgs {
    /// The library's settings for a method. `noisy`: the input is path traced.
    pub fn settings(&self, method: MethodKind, seed: u64, noisy: bool) -> Settings {
        Settings {
            method: match method {
                MethodKind::Smr => Method::Smr(self.smr(noisy)),
                MethodKind::Wrs => Method::Wrs(self.wrs()),
                other => other.into(),
            },
            depth_test: (!self.no_depth_test)
                .then_some(DepthTest { relative: self.depth_relative, slope_px: self.depth_slope }),
            noisy,
            seed,
            ..Settings::default()
        }
    }

    fn smr(&self, noisy: bool) -> Smr {
        let preset = if noisy { Smr::traced() } else { Smr::default() };
        Smr {
            accumulate: self.smr_accumulate.unwrap_or(preset.accumulate),
            tolerance: self.smr_tolerance,
            relight: !self.no_relight,
            ..preset
        }
    }

    fn wrs(&self) -> Wrs {
        let preset = match self.wrs_preset {
            WrsPresetName::Paper => Wrs::default(),
            WrsPresetName::Weighted => Wrs::weighted(),
        };
        let gate = preset.gate.unwrap_or_default();
        Wrs {
            sampler: self.wrs_sampler.unwrap_or(preset.sampler),
            weight_exponent: self.wrs_exponent.unwrap_or(preset.weight_exponent),
            rate_exponent: self.wrs_rate_exponent.unwrap_or(preset.rate_exponent),
            bias: self.wrs_bias,
            gate: (!self.no_gate).then_some(Gate {
                divisor: self.gate_divisor.unwrap_or(gate.divisor),
                offset: self.gate_offset.unwrap_or(gate.offset),
                metric: self.gate_metric,
                scale: self.gate_scale.unwrap_or(gate.scale),
            }),
        }
    }
}

/// Values of `--wrs-preset`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum WrsPresetName {
    /// As published
    Paper,
    /// With what it needs to reach the published gains
    Weighted,
}

impl Named for GateScale {
    fn rows() -> Vec<(Self, &'static str, &'static str)> {
        vec![
            (Self::Sample, "sample", "The stored sample, as published"),
            (Self::Candidate, "candidate", "A candidate of the same level of detail"),
        ]
    }
}

impl Named for Sampler {
    fn rows() -> Vec<(Self, &'static str, &'static str)> {
        vec![
            (Self::AChao, "a-chao", "A-Chao: replace with the ratio of weight to weight sum"),
            (Self::AEs, "a-es", "A-ES: keep the sample with the larger key"),
            (Self::AChaoMean, "a-chao-mean", "The expectation of A-Chao: keep the mean"),
        ]
    }
}

impl Named for GateMetric {
    fn rows() -> Vec<(Self, &'static str, &'static str)> {
        vec![
            (Self::DeltaE94, "delta-e94", "The whole color"),
            (Self::Lightness, "lightness", "Lightness alone, which ignores changes of hue"),
        ]
    }
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
