//! What a comparison writes and prints.

use super::plan::{CompareArgs, Plan};
use super::score::{LowestCrop, Results, TestResult};
use crate::clip::run_report::JodDisplay;
use crate::clip::title;
use crate::output::{Output, WriteError};
use crate::report::frame_plot::{FramePlot, Quantity, Series};
use crate::report::plot::png;
use afterimage::internal::MethodKind;
use afterimage_eval::metric::{BandScores, FrameErrors, Scores};
use afterimage_eval::report::sheet::{Column, Sheet};
use afterimage_metric::Display;
use serde::{Serialize, Serializer};

/// Files of a comparison; the first one marks the folder.
pub const FILES: [&str; 8] =
    ["report.json", "frames.csv", "gaze.csv", "sheet.png", "jod.svg", "jod.png", "psnr.svg", "psnr.png"];

/// Diameter of the circle that marks the gaze in the sheet, degrees: the band `fovea`.
const FOVEA_DEG: f32 = 5.0;

#[derive(Serialize)]
struct Report<'a> {
    tool: &'static str,
    version: &'static str,
    command: &'static str,
    /// The reference.
    input: &'a str,
    size: [u32; 2],
    frames: usize,
    fps: f32,
    hfov_deg: f32,
    exposure_ev: f32,
    gaze: &'a str,
    gaze_map: &'a str,
    start_s: f64,
    flip_pixels_per_degree: Option<f32>,
    jod_display: Option<JodDisplay>,
    /// Pixels of the reference that were NaN or infinite and count as black.
    nonfinite_reference: u64,
    methods: Tests<'a>,
}

#[derive(Serialize)]
struct TestReport<'a> {
    input: &'a str,
    #[serde(flatten)]
    scores: Scores,
    worst_crop: Option<LowestCrop>,
    nonfinite_in: u64,
}

/// Tests in the order of the command line, as a JSON map.
struct Tests<'a>(Vec<(&'a str, TestReport<'a>)>);

impl Serialize for Tests<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().map(|(name, report)| (name, report)))
    }
}

/// Writes all but `frames.csv`.
pub fn write(args: &CompareArgs, plan: &Plan, results: &Results, out: &Output) -> Result<(), WriteError> {
    write_sheet(args, plan, results, out)?;
    write_plots(plan, results, out)?;
    out.gaze("gaze.csv", &plan.gaze_px)?;
    let mut methods = vec![];
    for ((name, frames), result) in plan.inputs.tests.iter().zip(&results.tests) {
        let &TestResult { scores, worst_crop, nonfinite: nonfinite_in, .. } = result;
        methods.push((name.as_str(), TestReport { input: frames.name(), scores, worst_crop, nonfinite_in }));
    }
    let report = Report {
        tool: "afterimage",
        version: env!("CARGO_PKG_VERSION"),
        command: "compare",
        input: &args.reference,
        size: plan.inputs.size(),
        frames: plan.frames,
        fps: plan.fps,
        hfov_deg: plan.hfov_deg,
        exposure_ev: plan.exposure.ev,
        gaze: &plan.gaze,
        gaze_map: plan.gaze_map,
        start_s: args.start,
        flip_pixels_per_degree: plan.flip.as_ref().map(|flip| flip.pixels_per_degree()),
        jod_display: plan.viewing.map(|viewing| viewing.display.into()),
        nonfinite_reference: results.nonfinite_reference,
        methods: Tests(methods),
    };
    out.json("report.json", &report)
}

fn write_sheet(args: &CompareArgs, plan: &Plan, results: &Results, out: &Output) -> Result<(), WriteError> {
    let mut columns = vec![Column { name: "reference", shown: &results.reference, scores: None, visible_jod: None }];
    for ((name, _), result) in plan.inputs.tests.iter().zip(&results.tests) {
        let (scores, visible_jod) = (Some(result.scores), result.visible_jod.clone());
        columns.push(Column { name, shown: &result.shown, scores, visible_jod });
    }
    let seen = format!("{} degrees wide", plan.hfov_deg);
    let sheet = Sheet {
        title: title(&args.reference, plan.inputs.size(), plan.frames, plan.fps, &seen),
        columns: &columns,
        geometry: plan.geometry,
        gaze_px: &plan.gaze_px,
        fovea_deg: FOVEA_DEG,
    };
    out.root_picture("sheet.png", &sheet.draw())
}

fn write_plots(plan: &Plan, results: &Results, out: &Output) -> Result<(), WriteError> {
    let moved = |pair: &[[f32; 2]]| plan.geometry.eccentricity_deg(pair[1], pair[0]);
    let moves_deg: Vec<f32> = [0.0].into_iter().chain(plan.gaze_px.windows(2).map(moved)).collect();
    let names: Vec<&str> = plan.inputs.tests.iter().map(|(name, _)| name.as_str()).collect();
    let marks = marks(&names);
    let draw = |quantity, note, value: fn(&FrameErrors) -> f64| {
        let values: Vec<Vec<f64>> =
            results.tests.iter().map(|result| result.frames.iter().map(value).collect()).collect();
        let series: Vec<Series<'_>> =
            (0..names.len()).map(|i| Series { name: names[i], mark: marks[i], values: &values[i] }).collect();
        let (input, what) = (plan.inputs.reference.name(), "against this reference");
        FramePlot { quantity, input, what, note, fps: plan.fps, moves_deg: &moves_deg, series: &series }.svg()
    };
    let write = |name: &str, svg: &str| {
        out.text(&format!("{name}.svg"), svg)?;
        out.root_picture(&format!("{name}.png"), &png(svg))
    };
    let note = "the error of each frame alone, against the reference";
    write("psnr", &draw(Quantity::Psnr, note, |errors| errors.mse))?;
    if plan.viewing.is_some() {
        let note = "the score of a video in which every frame differs as much as this one";
        write("jod", &draw(Quantity::Jod, note, |errors| errors.jod.unwrap_or(f64::NAN)))?;
    }
    Ok(())
}

/// Methods whose marks the tests have in plots: a method its own, others the next that is free.
fn marks<'a>(names: &[&'a str]) -> Vec<&'a str> {
    let methods = MethodKind::ALL.map(MethodKind::name);
    let mut free = methods.into_iter().filter(|method| !names.contains(method));
    names.iter().map(|name| if methods.contains(name) { name } else { free.next().unwrap_or(name) }).collect()
}

/// Prints a table: each test as a whole, by eccentricity, and in its worst crop.
pub fn print(args: &CompareArgs, plan: &Plan, results: &Results) {
    let ([w, h], hfov_deg) = (plan.inputs.size(), plan.hfov_deg);
    say!("{} frames, {w}x{h} at {} fps, {hfov_deg} degrees wide, gaze {}", plan.frames, plan.fps, plan.gaze);
    if let Some(viewing) = plan.viewing {
        let Display { peak_nits, contrast, ambient_lux } = viewing.display;
        say!("display of JOD: {peak_nits} cd/m2, {contrast}:1, in a room of {ambient_lux} lux");
    }
    let names = plan.inputs.tests.iter().map(|(name, _)| name.as_str());
    let width = names.clone().map(|name| name.chars().count()).max().unwrap_or(0).max(4);
    say!("{:width$}  part             JOD  PSNR dB    SSIM    FLIP", "test");
    for (name, result) in names.zip(&results.tests) {
        let scores = &result.scores;
        let parts =
            ["all", "fovea", "mid", "periphery"].into_iter().zip([scores.whole].into_iter().chain(scores.bands));
        for (part, scores) in parts {
            let BandScores { psnr_db, mse, ssim, flip, jod } = scores;
            let psnr = if mse == Some(0.0) { "exact".into() } else { number(psnr_db, 2) };
            let [jod, ssim, flip] = [number(jod, 2), number(ssim, 4), number(flip, 4)];
            say!("{name:width$}  {part:13} {jod:>6} {psnr:>8} {ssim:>7} {flip:>7}");
        }
        if let Some(crop) = result.worst_crop {
            let LowestCrop { psnr_db, ssim, flip, lost_jod, frame, x_px, y_px, .. } = crop;
            let lost = lost_jod.map_or("-".into(), |lost| format!("{:.2}", -lost));
            let [psnr, ssim, flip] = [number(psnr_db, 2), number(ssim, 4), number(flip, 4)];
            let at = format!("frame {frame}, pixels from {x_px},{y_px}");
            say!("{name:width$}  {:13} {lost:>6} {psnr:>8} {ssim:>7} {flip:>7}  {at}", "worst 64x64");
        }
    }
    say!("JOD: 10 for no visible difference, of the worst 64x64 pixels the JOD lost there; docs/metrics.md");
    say!("fovea, mid, periphery: less than 2.5, 2.5 to 7.5, and more degrees from the gaze");
    say!("sheet with errors: {}", args.out.join("sheet.png").display());
}

fn number(value: Option<f64>, digits: usize) -> String {
    value.map_or("-".into(), |value| format!("{value:.digits$}"))
}
