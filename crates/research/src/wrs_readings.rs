//! Readings of the weighted reservoir method on a still: gain over the foveated frame, in the mean and in the last
//! frame, and how fresh the fovea is.

use crate::options::WrsTableArgs;
use crate::parts::{STORED_BIAS, shader_without};
use afterimage::internal::{Bias, Foveation, Gate, GateScale, Method, Sampler, Settings, Wrs};
use afterimage::{Image, ViewGeometry};
use afterimage_cli::sweep::grid::command_line;
use afterimage_lab::device::Backend;
use afterimage_lab::metric::{References, Scorer, encode};
use afterimage_lab::pipeline::{Pipeline, RunKind};
use afterimage_lab::scanpath::{FrameGaze, GazeMap, read_csv};
use afterimage_lab::source::{self, ReadLimits, SceneOptions};
use afterimage_program::failure::Failure;
use afterimage_program::progress;

/// Frame rate, in frames per second.
const FPS: f64 = 60.0;
/// Frames after which the fovea is compared with the full-rate frame: 250 ms of fixation.
const FIXATION_FRAMES: u64 = 15;
/// Motion of the gaze from frame to frame in degrees, above which a fixation ends: 60 degrees a second.
const SACCADE_DEG: f32 = 1.0;
/// Largest difference of a channel, sRGB-encoded in \[0, 1\], between a fresh pixel and the full-rate frame.
const FRESH: f32 = 1.0 / 255.0;

/// wrs with these settings.
fn settings(wrs: Wrs) -> Settings {
    Settings { method: Method::Wrs(wrs), ..Settings::default() }
}

/// The readings: settings that differ from the paper's in one part or several; on a device also one that is not a
/// setting.
fn readings(backend: &Backend) -> Vec<(&'static str, RunKind)> {
    let [paper, weighted] = [Wrs::default(), Wrs::weighted()];
    let ungated = Wrs { gate: None, ..paper };
    let same_scale = Wrs { gate: Some(Gate { scale: GateScale::Candidate, ..Gate::default() }), ..paper };
    let run = |wrs| RunKind::PostProcess(settings(wrs));
    let mut runs = vec![
        ("literal eq. 7", run(paper)),
        ("gate at the candidate's scale", run(same_scale)),
        ("no gate", run(ungated)),
        ("plain A-Chao (no gate, no bias)", run(Wrs { bias: Bias::None, ..ungated })),
    ];
    runs.extend(
        with_bias_in_comparison(settings(ungated), backend).map(|run| ("no gate, bias in the comparison only", run)),
    );
    runs.extend([
        ("weights to the third power", run(Wrs { weight_exponent: 3, ..paper })),
        ("no gate, weights to the third power", run(Wrs { weight_exponent: 3, ..ungated })),
        ("gate at the candidate's scale, third power", run(Wrs { weight_exponent: 3, ..same_scale })),
        ("gate at the candidate's scale, eighth power", run(Wrs { weight_exponent: 8, ..same_scale })),
        ("`Settings::weighted()`, but weights by eccentricity alone", run(Wrs { rate_exponent: 0, ..weighted })),
        ("`Settings::weighted()`, but samples", run(Wrs { sampler: Sampler::AChao, ..weighted })),
        ("`Settings::weighted()`", run(weighted)),
        ("oracle", RunKind::Oracle),
    ]);
    runs
}

/// A run that stores unbiased weight sums, on a device.
fn with_bias_in_comparison(settings: Settings, backend: &Backend) -> Option<RunKind> {
    let shader = || shader_without(&STORED_BIAS, settings.method.kind());
    matches!(backend, Backend::Gpu(_)).then(|| RunKind::WithShader(settings, shader().into()))
}

/// Result of a reading.
struct Outcome {
    /// Gain over the foveated frame in dB, of the mean.
    mean_gain_db: f64,
    /// The same in the last frame.
    last_gain_db: f64,
    /// Share of the fovea's pixels that equal the full-rate frame's, after 250 ms of each fixation.
    fresh: f64,
}

/// Number of the fovea's pixels, and of those that are fresh.
fn fresh_pixels(shown: &Image<[f32; 3]>, full: &Image<[f32; 3]>, ecc_deg: &Image<f32>, radius_deg: f32) -> [u64; 2] {
    let is_fresh = |a: &[f32; 3], b: &[f32; 3]| (0..3).all(|i| (a[i] - b[i]).abs() <= FRESH);
    let mut counts = [0; 2];
    for ((a, b), e_deg) in shown.pixels().iter().zip(full.pixels()).zip(ecc_deg.pixels()) {
        if *e_deg <= radius_deg {
            counts[0] += 1;
            counts[1] += u64::from(is_fresh(a, b));
        }
    }
    counts
}

/// Outcomes of the readings.
fn outcomes(args: &WrsTableArgs, backend: &Backend, scanpath: &str, map: GazeMap) -> Result<Vec<Outcome>, Failure> {
    let mut source = source::open(&args.still, &ReadLimits::default(), &SceneOptions::default())?;
    let info = source.info().clone();
    if !info.still {
        return Err(Failure::Input(format!("{}: expected a still", args.still)));
    }
    let geometry = ViewGeometry::flat(info.size, info.hfov_deg.unwrap_or(70.0))?;
    let samples = read_csv(scanpath)?;
    let gaze = FrameGaze::new(&samples, &geometry, map, args.start, FPS)?;
    let foveation = Foveation { rate_mid: args.rate_mid, rate_far: args.rate_far, ..Foveation::default() };
    let none = RunKind::PostProcess(Settings { method: Method::None, ..Settings::paper() });
    let kinds: Vec<_> = std::iter::once(none).chain(readings(backend).into_iter().map(|run| run.1)).collect();
    let mut pipeline = Pipeline::new(geometry, foveation, &kinds, true, &[], backend)?;
    let mut scorers = vec![Scorer::without_ssim(); kinds.len()];
    let mut references = References::default();
    let mut last = vec![];
    let mut fovea = vec![[0; 2]; kinds.len()];
    let mut fixation_frames = 0;
    let mut past_gaze_px = None;
    let bar = progress::bar(args.frames, "frames");
    for index in 0..args.frames {
        let frame = source.render(&pipeline.request(index, gaze.px(index)))?;
        let step = pipeline.step(&frame)?;
        let full = encode(&frame.reference.color, 0.0);
        let reference = references.next(&full, &step.tracked, &step.ecc_deg);
        let shift_deg = |past_px| geometry.eccentricity_deg(step.gaze_px, past_px);
        fixation_frames =
            if past_gaze_px.is_some_and(|px| shift_deg(px) > SACCADE_DEG) { 0 } else { fixation_frames + 1 };
        past_gaze_px = Some(step.gaze_px);
        last.clear();
        for ((scorer, shown), fovea) in scorers.iter_mut().zip(&step.outputs).zip(&mut fovea) {
            let encoded = encode(&shown.image, 0.0);
            let errors = scorer.push(&reference, &encoded, &step.tracked, &step.ecc_deg);
            last.push(-10.0 * errors.mse.log10());
            if fixation_frames == FIXATION_FRAMES {
                let [all, fresh] = fresh_pixels(&encoded, &full, &step.ecc_deg, foveation.fovea_deg / 2.0);
                *fovea = [fovea[0] + all, fovea[1] + fresh];
            }
        }
        bar.inc(1);
    }
    let means: Vec<_> = scorers.iter().map(|s| s.scores().whole.psnr_db.unwrap_or(f64::NAN)).collect();
    let outcome = |i: usize| Outcome {
        mean_gain_db: means[i] - means[0],
        last_gain_db: last[i] - last[0],
        fresh: fovea[i][1] as f64 / fovea[i][0] as f64,
    };
    Ok((1..kinds.len()).map(outcome).collect())
}

fn cell(outcome: &Outcome) -> String {
    let Outcome { mean_gain_db, last_gain_db, fresh } = outcome;
    format!(" {mean_gain_db:+.2}/{last_gain_db:+.2}; {:.1} % |", 100.0 * fresh)
}

/// The table in Markdown.
pub fn table(args: &WrsTableArgs) -> Result<String, Failure> {
    let backend = args.backend.open()?;
    let mut paths = vec![(&args.gaze, GazeMap::Angle, "by angle"), (&args.gaze, GazeMap::Fit, "by fit")];
    paths.extend(args.second_gaze.iter().map(|file| (file, GazeMap::Fit, "by fit")));
    let columns =
        paths.iter().map(|(file, map, _)| outcomes(args, &backend, file, *map)).collect::<Result<Vec<_>, _>>()?;
    let mut lines = vec![
        format!("<!-- Generated by `{}`; do not edit. -->\n", command()),
        format!(
            "Readings on `{}`, blocks of {} and {}, {} frames.\n\
         Gain over none in dB, of the mean / in the last frame; share of the fovea's pixels within 1/255 of the\n\
         full-rate frame, 250 ms after each fixation began.\n",
            args.still, args.rate_mid, args.rate_far, args.frames
        ),
    ];
    let heads: Vec<_> = paths.iter().map(|(file, _, map)| format!(" `{file}` {map} |")).collect();
    lines.push(format!("| reading |{}", heads.concat()));
    lines.push(format!("|---|{}", "---|".repeat(paths.len())));
    for (row, (name, _)) in readings(&backend).iter().enumerate() {
        let cells: Vec<_> = columns.iter().map(|c| cell(&c[row])).collect();
        lines.push(format!("| {name} |{}", cells.concat()));
    }
    lines.push(String::new());
    Ok(lines.join("\n"))
}

/// The command that runs.
fn command() -> String {
    command_line().replacen("afterimage", "cargo research", 1)
}
