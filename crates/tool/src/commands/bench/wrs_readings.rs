//! Readings of the weighted reservoir method on a still: gain over the foveated frame, in the mean and in the last
//! frame.

use super::wrs_table::WrsTableArgs;
use crate::failure::Failure;
use crate::progress;
use afterimage::{Bias, Foveation, Gate, GateScale, Method, Sampler, Settings, ViewGeometry};
use afterimage_lab::device::Backend;
use afterimage_lab::metric::{References, Scorer, encode};
use afterimage_lab::pipeline::{Pipeline, RunKind};
use afterimage_lab::scanpath::{FrameGaze, GazeMap, read_csv};
use afterimage_lab::source;
use afterimage_lab::source::{ReadLimits, SceneOptions};

/// Frame rate, in frames per second.
const FPS: f64 = 60.0;

/// The readings: settings that differ from the paper's in one part or several.
fn readings() -> Vec<(&'static str, RunKind)> {
    let paper = Settings::paper();
    let weighted = Settings::weighted();
    let ungated = Settings { gate: None, ..paper };
    let same_scale = Settings { gate: Some(Gate { scale: GateScale::Candidate, ..Gate::default() }), ..paper };
    let list = [
        ("literal eq. 7", paper),
        ("gate at the candidate's scale", same_scale),
        ("no gate", ungated),
        ("plain A-Chao (no gate, no bias)", Settings { bias: Bias::None, ..ungated }),
        ("weights to the third power", Settings { weight_exponent: 3, ..paper }),
        ("no gate, weights to the third power", Settings { weight_exponent: 3, ..ungated }),
        ("gate at the candidate's scale, third power", Settings { weight_exponent: 3, ..same_scale }),
        ("gate at the candidate's scale, eighth power", Settings { weight_exponent: 8, ..same_scale }),
        ("`Settings::weighted()`, but samples", Settings { sampler: Sampler::AChao, ..weighted }),
        ("`Settings::weighted()`", weighted),
    ];
    let mut runs: Vec<_> = list.map(|(name, settings)| (name, RunKind::PostProcess(settings))).into();
    runs.push(("oracle", RunKind::Oracle));
    runs
}

/// Gains of each reading over the foveated frame in dB: of the mean, and in the last frame.
fn gains(args: &WrsTableArgs, scanpath: &str, map: GazeMap) -> Result<Vec<[f64; 2]>, Failure> {
    let input = |e: &dyn std::fmt::Display| Failure::Input(e.to_string());
    let mut source =
        source::open(&args.still, &ReadLimits::default(), &SceneOptions::default()).map_err(|e| input(&e))?;
    let info = source.info().clone();
    if !info.still {
        return Err(Failure::Input(format!("{}: expected a still", args.still)));
    }
    let geometry = ViewGeometry::flat(info.size, info.hfov_deg.unwrap_or(70.0)).map_err(|e| input(&e))?;
    let samples = read_csv(scanpath).map_err(|e| input(&e))?;
    let gaze = FrameGaze::new(&samples, &geometry, map, args.start, FPS).map_err(|e| input(&e))?;
    let foveation = Foveation { rate_mid: args.rate_mid, rate_far: args.rate_far, ..Foveation::default() };
    let none = RunKind::PostProcess(Settings { method: Method::None, ..Settings::paper() });
    let kinds: Vec<_> = std::iter::once(none).chain(readings().into_iter().map(|run| run.1)).collect();
    let mut pipeline = Pipeline::new(geometry, foveation, &kinds, true, &[], &Backend::Cpu).map_err(|e| input(&e))?;
    let mut scorers = vec![Scorer::without_ssim(); kinds.len()];
    let mut references = References::default();
    let mut last = vec![];
    let bar = progress::bar(args.frames, "frames");
    for index in 0..args.frames {
        let frame = source.frame(index).map_err(|e| input(&e))?;
        let step = pipeline.step(index, &frame, gaze.px(index)).map_err(|e| input(&e))?;
        let full = encode(&frame.color, 0.0);
        let reference = references.next(&full, &step.tracked);
        last.clear();
        for (scorer, shown) in scorers.iter_mut().zip(&step.outputs) {
            let errors = scorer.push(&reference, &encode(&shown.image, 0.0), &step.tracked, &step.ecc_deg);
            last.push(-10.0 * errors.mse.log10());
        }
        bar.inc(1);
    }
    let means: Vec<_> = scorers.iter().map(|s| s.scores().whole.psnr_db.unwrap_or(f64::NAN)).collect();
    Ok((1..kinds.len()).map(|i| [means[i] - means[0], last[i] - last[0]]).collect())
}

/// The table in Markdown.
pub fn table(args: &WrsTableArgs) -> Result<String, Failure> {
    let mut paths = vec![(&args.gaze, GazeMap::Angle, "by angle"), (&args.gaze, GazeMap::Fit, "by fit")];
    paths.extend(args.second_gaze.iter().map(|file| (file, GazeMap::Fit, "by fit")));
    let columns = paths.iter().map(|(file, map, _)| gains(args, file, *map)).collect::<Result<Vec<_>, _>>()?;
    let mut lines = vec![format!(
        "Readings on `{}`, blocks of {} and {}, {} frames: gain over none in dB, of the mean / in the last frame.\n",
        args.still, args.rate_mid, args.rate_far, args.frames
    )];
    let heads: Vec<_> = paths.iter().map(|(file, _, map)| format!(" `{file}` {map} |")).collect();
    lines.push(format!("| reading |{}", heads.concat()));
    lines.push(format!("|---|{}", "---|".repeat(paths.len())));
    for (row, (name, _)) in readings().iter().enumerate() {
        let cells: Vec<_> = columns.iter().map(|c| format!(" {:+.2} / {:+.2} |", c[row][0], c[row][1])).collect();
        lines.push(format!("| {name} |{}", cells.concat()));
    }
    lines.push(String::new());
    Ok(lines.join("\n"))
}
