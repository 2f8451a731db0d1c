//! Ablation of the reservoir method on one clip: the gate, the bias, the weights and the sampler, one by one.
//!
//! `cargo research parts-of-wrs INPUT SCANPATH.csv [angle|fit [FRAMES [FOVEA_DEG]]]`
//!
//! Prints PSNR over none at several lengths of the clip: whole frame, and retained pixels (sampled at full rate
//! earlier).
//!
//! Makes a table of `docs/wrs-findings.md`, whose command is there.

use crate::error::AnyError;
use afterimage::ViewGeometry;
use afterimage::internal::{Bias, Foveation, Gate, GateMetric, Method, Sampler, Settings, Wrs};
use afterimage_lab::device::Backend;
use afterimage_lab::metric::{References, Scorer, encode};
use afterimage_lab::pipeline::{Pipeline, RunKind};
use afterimage_lab::scanpath::{FrameGaze, GazeMap, read_csv};
use afterimage_lab::source;
use afterimage_lab::source::{ReadLimits, SceneOptions};
use clap::{Args, ValueEnum};

fn variants() -> Vec<(&'static str, RunKind)> {
    let paper = Wrs::default();
    let wrs = |wrs| Settings { method: Method::Wrs(wrs), ..Settings::default() };
    let gate = |divisor, offset| Some(Gate { divisor, offset, ..Gate::default() });
    let ungated = Wrs { gate: None, ..paper };
    let list = [
        ("none", Settings { method: Method::None, ..Settings::default() }),
        ("paper: gate dE/100, Bernoulli, A-Chao", wrs(paper)),
        ("gate dE/20", wrs(Wrs { gate: gate(20.0, 0.0), ..paper })),
        ("gate dE/500", wrs(Wrs { gate: gate(500.0, 0.0), ..paper })),
        ("gate (dE - 5)/30", wrs(Wrs { gate: gate(30.0, 5.0), ..paper })),
        ("gate L*/100", wrs(Wrs { gate: Some(Gate { metric: GateMetric::Lightness, ..Gate::default() }), ..paper })),
        ("no gate", wrs(ungated)),
        ("no gate, exponential 0.02", wrs(Wrs { bias: Bias::Exponential { lambda: 0.02 }, ..ungated })),
        ("no gate, exponential 0.005", wrs(Wrs { bias: Bias::Exponential { lambda: 0.005 }, ..ungated })),
        ("no gate, no bias", wrs(Wrs { bias: Bias::None, ..ungated })),
        ("weights to the third power", wrs(Wrs { weight_exponent: 3, ..paper })),
        ("no gate, weights to the third power", wrs(Wrs { weight_exponent: 3, ..ungated })),
        ("no gate, weights to the eighth power", wrs(Wrs { weight_exponent: 8, ..ungated })),
        ("weighted", Settings::weighted()),
        ("paper with A-ES", wrs(Wrs { sampler: Sampler::AEs, ..paper })),
    ];
    let mut runs: Vec<_> = list.map(|(name, s)| (name, RunKind::PostProcess(s))).into();
    runs.push(("oracle: upper bound of any reuse", RunKind::Oracle));
    runs
}

/// Ablation of the reservoir method on one clip: the gate, the bias, the weights and the sampler, one by one
#[derive(Args, Clone, Debug)]
pub struct PartsOfWrsArgs {
    /// Scene, clip or folder of frames, as for `afterimage run`
    pub input: String,
    /// Scanpath
    #[arg(value_name = "SCANPATH.csv")]
    pub scanpath: String,
    /// How gaze is mapped to pixels
    #[arg(value_enum, default_value = "angle")]
    pub map: Map,
    /// Frames of the clip
    #[arg(default_value_t = 300, value_parser = clap::value_parser!(u64).range(1..=100_000))]
    pub frames: u64,
    /// Radius of the fovea, degrees
    #[arg(default_value_t = 5.0)]
    pub fovea_deg: f32,
}

/// Maps of gaze.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Map {
    /// Visual angles of the recording
    Angle,
    /// The recorded screen, stretched over the picture
    Fit,
}

pub fn bench(args: &PartsOfWrsArgs) -> Result<(), AnyError> {
    let PartsOfWrsArgs { input, scanpath, fovea_deg, .. } = args;

    let mut source = source::open(input, &ReadLimits::default(), &SceneOptions::default())?;
    let info = source.info().clone();
    let geometry = ViewGeometry::flat(info.size, info.hfov_deg.unwrap_or(70.0))?;
    let map = if args.map == Map::Fit { GazeMap::Fit } else { GazeMap::Angle };
    let gaze = FrameGaze::new(&read_csv(scanpath)?, &geometry, map, 1.0, 60.0)?;
    let foveation = Foveation { fovea_deg: *fovea_deg, ..Foveation::default() };

    let mut runs = variants();
    if !info.still {
        runs.pop();
    }
    let kinds: Vec<_> = runs.iter().map(|run| run.1.clone()).collect();
    let mut pipeline = Pipeline::new(geometry, foveation, &kinds, info.still, &[], &Backend::Cpu)?;
    let mut scorers = vec![Scorer::without_ssim(); runs.len()];
    let mut references = References::default();
    say!("{input}, {scanpath} by {map:?}, fovea {fovea_deg} degrees");
    for index in 0..args.frames {
        let frame = source.render(&pipeline.request(index, gaze.px(index)))?;
        let step = pipeline.step(&frame)?;
        let full = encode(&frame.reference.color, 0.0);
        let reference = references.next(&full, &step.tracked, &step.ecc_deg);
        let mut last = vec![];
        for (scorer, shown) in scorers.iter_mut().zip(&step.outputs) {
            let errors = scorer.push(&reference, &encode(&shown.image, 0.0), &step.tracked, &step.ecc_deg);
            last.push(-10.0 * errors.mse.log10());
        }
        if [60, 150, 300, 540].contains(&(index + 1)) || index + 1 == args.frames {
            say!("\nafter {} frames            PSNR dB   gain  last frame's gain  retained dB", index + 1);
            let base = scorers[0].scores().whole.psnr_db.unwrap_or(f64::NAN);
            for (i, (name, _)) in runs.iter().enumerate() {
                let s = scorers[i].scores();
                let psnr = s.whole.psnr_db.unwrap_or(f64::NAN);
                say!(
                    "{name:40} {psnr:7.2} {:+6.2} {:+6.2} {:8.2}",
                    psnr - base,
                    last[i] - last[0],
                    s.retained_psnr_db.unwrap_or(f64::NAN)
                );
            }
        }
    }
    Ok(())
}
