//! Compares all methods and presets on a clip, on the same foveated frames, with the metrics that the documents quote:
//! PSNR, SSIM, retention, flicker, the worst frame against the foveated one, and PSNR on `analytic:scroll`'s panel.
//!
//! `cargo research methods INPUT SCANPATH.csv [FRAMES [mip|gauss|block RATE_MID RATE_FAR]]`
//!
//! Makes figures of `docs/method.md`, with the clips that it names.

use crate::error::AnyError;
use afterimage::ViewGeometry;
use afterimage::internal::{Foveation, FoveationKind, Method, Settings};
use afterimage_lab::device::Backend;
use afterimage_lab::metric::{References, Scorer, encode};
use afterimage_lab::pipeline::{Pipeline, RunKind};
use afterimage_lab::scanpath::{FrameGaze, GazeMap, read_csv};
use afterimage_lab::source;
use afterimage_lab::source::{AnalyticSource, ReadLimits, SceneOptions};
use clap::{Args, ValueEnum};

/// All methods and presets on a clip, on the same foveated frames
#[derive(Args, Clone, Debug)]
pub struct MethodsArgs {
    /// Scene, clip or folder of frames, as for `afterimage run`
    pub input: String,
    /// Scanpath
    #[arg(value_name = "SCANPATH.csv")]
    pub scanpath: String,
    /// Frames of the clip
    #[arg(default_value_t = 90, value_parser = clap::value_parser!(u64).range(1..=100_000))]
    pub frames: u64,
    /// How frames are foveated
    #[arg(value_enum, default_value = "mip")]
    pub foveation: Blur,
    /// Rate in the middle region
    #[arg(default_value_t = 8)]
    pub rate_mid: u32,
    /// Rate in the periphery
    #[arg(default_value_t = 16)]
    pub rate_far: u32,
}

/// Simulators of foveated frames.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum Blur {
    Mip,
    Gauss,
    Block,
}

pub fn bench(args: &MethodsArgs) -> Result<(), AnyError> {
    let (input, rate_mid, rate_far) = (&args.input, args.rate_mid, args.rate_far);
    let kind = match args.foveation {
        Blur::Mip => FoveationKind::Mip,
        Blur::Gauss => FoveationKind::Gauss,
        Blur::Block => FoveationKind::Block,
    };
    let foveation = Foveation { kind, rate_mid, rate_far, ..Foveation::default() };

    let mut source = source::open(input, &ReadLimits::default(), &SceneOptions::default())?;
    let info = source.info().clone();
    let (hfov, fps) = (info.hfov_deg.unwrap_or(70.0), info.fps.unwrap_or(60.0));
    let geometry = ViewGeometry::flat(info.size, hfov)?;
    let gaze = FrameGaze::new(&read_csv(&args.scanpath)?, &geometry, GazeMap::Angle, 1.0, fps.into())?;
    let runs = [
        ("none", Settings { method: Method::None, ..Settings::default() }),
        ("taa", Settings { method: Method::Taa, ..Settings::default() }),
        ("wrs", Settings::paper()),
        ("smr steady", Settings::steady()),
        ("smr responsive", Settings::responsive()),
    ];
    let kinds = runs.map(|run| RunKind::PostProcess(run.1));
    let mut pipeline = Pipeline::new(geometry, foveation, &kinds, info.still, &[], &Backend::Cpu)?;
    let scene = input.strip_prefix("analytic:").map(|n| AnalyticSource::new(n, info.size, hfov, fps)).transpose()?;
    let mut scorers = runs.map(|_| Scorer::default());
    let mut references = References::default();
    let mut worst = [f64::INFINITY; 5];
    let mut panel = [(0.0, 0.0); 5];
    for index in 0..args.frames {
        let frame = source.render(&pipeline.request(index, gaze.px(index)))?;
        let step = pipeline.step(&frame)?;
        let full = encode(&frame.reference.color, 0.0);
        let reference = references.next(&full, &step.tracked, &step.ecc_deg);
        let mask = scene.as_ref().and_then(|s| s.panel_mask(index));
        let mut foveated = None;
        for (i, shown) in step.outputs.iter().enumerate() {
            let shown = encode(&shown.image, 0.0);
            let mse = scorers[i].push(&reference, &shown, &step.tracked, &step.ecc_deg).mse;
            let gain = 10.0 * (*foveated.get_or_insert(mse) / mse).log10();
            // Skip the first two frames, which have almost no history.
            if index > 1 {
                worst[i] = gain.min(worst[i]);
            }
            for (k, _) in mask.iter().flat_map(|m| m.pixels()).enumerate().filter(|(_, on)| **on) {
                let (a, b) = (shown.pixels()[k], full.pixels()[k]);
                let squared: f32 = (0..3).map(|c| (a[c] - b[c]).powi(2)).sum();
                panel[i] = (panel[i].0 + f64::from(squared) / 3.0, panel[i].1 + 1.0);
            }
        }
    }
    say!("{input}, {kind:?} {rate_mid}/{rate_far}");
    say!("method             PSNR dB    SSIM  retained  flicker  least gain  panel dB");
    for (i, (name, _)) in runs.iter().enumerate() {
        let s = scorers[i].scores();
        let or = |v: Option<f64>| v.unwrap_or(f64::NAN);
        say!(
            "{name:16} {:9.2} {:7.4} {:9.2} {:8.2} {:11.3} {:9.2}",
            or(s.whole.psnr_db),
            or(s.whole.ssim),
            or(s.retained_psnr_db),
            or(s.flicker),
            worst[i],
            -10.0 * (panel[i].0 / panel[i].1).log10()
        );
    }
    Ok(())
}
