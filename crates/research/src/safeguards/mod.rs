//! `cargo research safeguards`: what each part of the passes that keeps them safe costs, and what is lost without it.
//!
//! Makes the table of `docs/sweep.md`, "Parts of the passes: cost and benefit"; the command is there. Two minutes.

mod invalid_colors;

use crate::parts::{PARTS, shader_without};
use afterimage::ViewGeometry;
use afterimage::internal::{DepthTest, Foveation, Method, MethodKind, Pyramid, Settings};
use afterimage_lab::clock::Quartiles;
use afterimage_lab::device::{Backend, Headless};
use afterimage_lab::frame::{FoveatedFrame, RenderedFrame};
use afterimage_lab::metric::{References, Scorer, Scores, encode};
use afterimage_lab::pipeline::{Pipeline, RunKind};
use afterimage_lab::scanpath::{FrameGaze, GazeMap, read_csv};
use afterimage_lab::source::{self, ReadLimits, SceneOptions};
use afterimage_program::failure::Failure;
use afterimage_program::progress;
use clap::Args;

/// Frames before times count: histories fill, pipelines compile.
const WARM_UP: usize = 8;
/// Frame rate, in frames per second.
const FPS: f64 = 60.0;

/// Parts of the passes left out, one at a time, on frames with invalid pixels; on a GPU adapter
#[derive(Args, Clone, Debug)]
#[command(after_help = "Example:\n  cargo research safeguards sponza_lateral/ --gaze viewing.csv --start 1")]
pub struct SafeguardsArgs {
    /// Frames or a still, as for run
    pub input: String,
    /// Scanpath, as for run
    #[arg(long, value_name = "FILE.csv")]
    pub gaze: String,
    /// Start time in the scanpath, seconds
    #[arg(long, default_value_t = 0.0, value_name = "S")]
    pub start: f64,
    /// Number of frames, at least 9; the first 8 are not timed
    #[arg(long, default_value_t = 40, value_name = "N", value_parser = clap::value_parser!(u64).range(9..=100_000))]
    pub frames: u64,
    /// Block edge in the middle region, pixels
    #[arg(long, default_value_t = 4, value_name = "N")]
    pub rate_mid: u32,
    /// Block edge in the periphery, pixels
    #[arg(long, default_value_t = 8, value_name = "N")]
    pub rate_far: u32,
    /// Share of the pixels of each foveated frame that are NaN, infinite, huge or negative, 0 to 1
    #[arg(long, default_value_t = 0.0001, value_name = "SHARE", value_parser = share)]
    pub invalid: f32,
}

fn share(text: &str) -> Result<f32, String> {
    text.parse().ok().filter(|share| (0.0..=1.0).contains(share)).ok_or_else(|| "expected a share, 0 to 1".into())
}

/// The whole method, then the method without each of its parts.
fn runs(kind: MethodKind, foveation: Foveation) -> Vec<(&'static str, RunKind)> {
    let whole = Settings { method: kind.into(), foveation, ..Settings::default() };
    let mut runs = vec![("whole", RunKind::PostProcess(whole))];
    let parts = PARTS.iter().filter(|part| part.methods.contains(&kind));
    runs.extend(parts.map(|part| (part.name, RunKind::WithShader(whole, shader_without(part, kind).into()))));
    let without = |change: fn(&mut Settings)| {
        let mut changed = whole;
        change(&mut changed);
        RunKind::PostProcess(changed)
    };
    runs.push(("depth test", without(|s| s.depth_test = None)));
    runs.push((
        "slope in the depth test",
        without(|s| s.depth_test = s.depth_test.map(|test| DepthTest { slope_px: 0.0, ..test })),
    ));
    match kind {
        MethodKind::Wrs => runs.push(("gate", without(|s| with_wrs(s, |wrs| wrs.gate = None)))),
        MethodKind::Smr => runs.push(("relighting", without(|s| with_smr(s, |smr| smr.relight = false)))),
        _ => {}
    }
    runs
}

fn with_wrs(settings: &mut Settings, change: impl Fn(&mut afterimage::internal::Wrs)) {
    if let Method::Wrs(wrs) = &mut settings.method {
        change(wrs);
    }
}

fn with_smr(settings: &mut Settings, change: impl Fn(&mut afterimage::internal::Smr)) {
    if let Method::Smr(smr) = &mut settings.method {
        change(smr);
    }
}

/// The frame as a simulator foveates it, with invalid colors.
pub fn with_invalid_colors(
    frame: RenderedFrame,
    geometry: &ViewGeometry,
    foveation: &Foveation,
    share: f32,
) -> RenderedFrame {
    let lod = foveation.lod_map(geometry, frame.gaze_px);
    let pyramid = Pyramid::new(frame.reference.color.clone(), foveation.max_level());
    let color = invalid_colors::among(foveation.render(&pyramid, &lod), share, frame.index as u32);
    frame.foveated(FoveatedFrame { color, lod, noise: None, samples: vec![], rays: 0, nonfinite: 0 })
}

/// Makes the table.
pub fn bench(args: &SafeguardsArgs) -> Result<(), Failure> {
    let gpu = Headless::find(true)
        .ok_or_else(|| Failure::Input("no GPU adapter, and parts are left out of shaders".into()))?;
    let backend = Backend::Gpu(gpu);
    println!(
        "| method | without | ms | retained dB | SSIM | weighted PSNR dB | flicker |\n|---|---|---|---|---|---|---|"
    );
    for kind in [MethodKind::Taa, MethodKind::Wrs, MethodKind::Smr] {
        for (name, ms, scores) in measured(args, kind, &backend)? {
            let dash = |value: Option<f64>, digits: usize| value.map_or("-".into(), |v| format!("{v:.digits$}"));
            println!(
                "| {} | {name} | {ms:.1} | {} | {} | {} | {} |",
                kind.name(),
                dash(scores.retained_psnr_db, 2),
                dash(scores.whole.ssim, 4),
                dash(scores.weighted_psnr_db, 2),
                dash(scores.flicker, 2),
            );
        }
    }
    println!();
    for part in PARTS {
        println!("- Without {}: {}.", part.name, part.instead);
    }
    Ok(())
}

/// Each run of a method: its name, median cost a frame in milliseconds, scores.
fn measured(
    args: &SafeguardsArgs,
    kind: MethodKind,
    backend: &Backend,
) -> Result<Vec<(&'static str, f64, Scores)>, Failure> {
    let mut source = source::open(&args.input, &ReadLimits::default(), &SceneOptions::default())?;
    let info = source.info().clone();
    let geometry = ViewGeometry::flat(info.size, info.hfov_deg.unwrap_or(70.0))?;
    let samples = read_csv(&args.gaze)?;
    let gaze = FrameGaze::new(&samples, &geometry, GazeMap::Angle, args.start, FPS)?;
    let foveation = Foveation { rate_mid: args.rate_mid, rate_far: args.rate_far, ..Foveation::default() };
    let runs = runs(kind, foveation);
    let kinds: Vec<_> = runs.iter().map(|run| run.1.clone()).collect();
    let mut pipeline = Pipeline::new(geometry, foveation, &kinds, false, &[], backend)?;
    let mut references = References::default();
    let mut figures: Vec<(Vec<f64>, Scorer)> = runs.iter().map(|_| Default::default()).collect();
    let bar = progress::bar(args.frames, "frames");
    for index in 0..args.frames {
        let request = pipeline.request(index, gaze.px(index));
        let frame = source.render(&request)?;
        let frame = with_invalid_colors(frame, &geometry, &foveation, args.invalid);
        let step = pipeline.step(&frame)?;
        let full = encode(&frame.reference.color, 0.0);
        let reference = references.next(&full, &step.tracked, &step.ecc_deg);
        for ((times, scorer), output) in figures.iter_mut().zip(&step.outputs) {
            times.push(output.elapsed.cost_ms());
            scorer.push(&reference, &encode(&output.image, 0.0), &step.tracked, &step.ecc_deg);
        }
        bar.inc(1);
    }
    let median = |times: &[f64]| Quartiles::of(&times[WARM_UP..]).map_or(f64::NAN, |q| q.median);
    let rows = runs.iter().zip(figures).map(|((name, _), (times, scorer))| (*name, median(&times), scorer.scores()));
    Ok(rows.collect())
}
