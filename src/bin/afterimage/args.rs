//! Options that several subcommands share, and how their values are read.

use afterimage::DebugView;
use afterimage::foveation::{Filter, Foveation};
use afterimage::settings::{Bias, DepthTest, Gate, GateMetric, Method, Sampler, Settings, Smr};
use clap::{Args, ValueEnum};
use std::str::FromStr;

/// Where a frame is how coarse.
#[derive(Args, Clone, Debug)]
pub struct FoveationArgs {
    /// Foveation simulator: box mip levels, Gaussian blur, point-sampled blocks, or none
    #[arg(long = "foveation", value_enum, default_value = "mip")]
    pub filter: FilterName,
    /// Diameter of the full-rate region, degrees
    #[arg(long, default_value_t = 5.0, value_name = "DEG")]
    pub fovea: f32,
    /// Diameter of the middle region, degrees
    #[arg(long, default_value_t = 15.0, value_name = "DEG")]
    pub mid: f32,
    /// Width of the linear blend outside each radius, degrees
    #[arg(long, default_value_t = 1.0, value_name = "DEG")]
    pub blend: f32,
    /// Block edge in the middle region, pixels, a power of two
    #[arg(long, default_value_t = 8, value_name = "N")]
    pub rate_mid: u32,
    /// Block edge beyond, pixels, a power of two
    #[arg(long, default_value_t = 16, value_name = "N")]
    pub rate_far: u32,
}

impl FoveationArgs {
    /// The library's form.
    pub fn foveation(&self) -> Foveation {
        Foveation {
            filter: match self.filter {
                FilterName::Mip => Filter::Mip,
                FilterName::Gauss => Filter::Gauss,
                FilterName::Block => Filter::Block,
                FilterName::Off => Filter::Off,
            },
            fovea_deg: self.fovea,
            mid_deg: self.mid,
            blend_deg: self.blend,
            rate_mid: self.rate_mid,
            rate_far: self.rate_far,
        }
    }
}

/// Names of foveation simulators.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum FilterName {
    /// Box mip levels, trilinear
    Mip,
    /// Gaussian blur growing with eccentricity
    Gauss,
    /// One point sample a block
    Block,
    /// Full rate everywhere
    Off,
}

impl FilterName {
    /// As typed.
    pub fn name(self) -> &'static str {
        match self {
            Self::Mip => "mip",
            Self::Gauss => "gauss",
            Self::Block => "block",
            Self::Off => "off",
        }
    }
}

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
    /// Colour difference at which the gate is shut, Delta E 94 above the offset
    #[arg(long, default_value_t = 100.0, value_name = "X")]
    pub gate_divisor: f32,
    /// Colour difference that costs nothing, Delta E 94
    #[arg(long, default_value_t = 0.0, value_name = "X")]
    pub gate_offset: f32,
    /// What the gate compares: the whole colour, or its lightness alone
    #[arg(long, value_enum, default_value = "delta-e94")]
    pub gate_metric: GateMetricName,
    /// Never look at colour
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
    /// The whole colour
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

/// Names of debug views.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum DebugName {
    /// Weight sum of the reservoir; of smr the sharpness stored
    Weight,
    /// Frames since the shown sample was shaded; wrs only
    Age,
    /// Share of the history's weight that survived
    Survival,
    /// What became of the history
    Flush,
    /// Gate value
    Gate,
    /// Motion
    Motion,
}

impl DebugName {
    /// As typed, and as folders are named.
    pub fn name(self) -> &'static str {
        match self {
            Self::Weight => "weight",
            Self::Age => "age",
            Self::Survival => "survival",
            Self::Flush => "flush",
            Self::Gate => "gate",
            Self::Motion => "motion",
        }
    }

    /// The library's form.
    pub fn view(self) -> DebugView {
        match self {
            Self::Weight => DebugView::Weight,
            Self::Age => DebugView::Age,
            Self::Survival => DebugView::Survival,
            Self::Flush => DebugView::Flush,
            Self::Gate => DebugView::Gate,
            Self::Motion => DebugView::Motion,
        }
    }
}

/// File format of frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum FormatName {
    /// sRGB, 8 bit
    Png,
    /// Linear half float
    Exr,
}

/// `WxH` in pixels.
pub fn parse_size(text: &str) -> Result<[u32; 2], String> {
    let expected = "expected WxH in pixels, such as 1280x720";
    let (w, h) = text.split_once('x').ok_or(expected)?;
    match (w.parse(), h.parse()) {
        (Ok(w), Ok(h)) if w > 0 && h > 0 => Ok([w, h]),
        _ => Err(expected.into()),
    }
}

/// Samples a pixel.
pub fn parse_samples(text: &str) -> Result<u32, String> {
    within(text, "1 to 1048576 samples", |v| (1..=1 << 20).contains(v))
}

/// Number of frames: at most two days at 60 frames a second.
pub fn parse_frames(text: &str) -> Result<u64, String> {
    within(text, "1 to 10000000 frames", |v| (1..=10_000_000).contains(v))
}

/// Frames per second.
pub fn parse_fps(text: &str) -> Result<f32, String> {
    within(text, "above 0 and at most 100000 frames per second", |v| *v > 0.0 && *v <= 100_000.0)
}

/// Horizontal field of view in degrees.
pub fn parse_hfov(text: &str) -> Result<f32, String> {
    within(text, "above 0 and below 180 degrees", |v| *v > 0.0 && *v < 180.0)
}

/// Exposure in stops.
pub fn parse_exposure(text: &str) -> Result<f32, String> {
    within(text, "-64 to 64 stops", |v| (-64.0..=64.0).contains(v))
}

fn within<T: FromStr>(text: &str, range: &str, is_within: impl Fn(&T) -> bool) -> Result<T, String> {
    text.parse().ok().filter(is_within).ok_or_else(|| format!("expected {range}"))
}
