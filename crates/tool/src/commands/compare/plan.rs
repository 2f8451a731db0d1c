//! Options of a comparison, and its plan.

use super::inputs::Inputs;
use crate::args::display::DisplayArgs;
use crate::args::gaze::{GazeArgs, Track};
use crate::args::gaze_log::GazeLogArgs;
use crate::args::{by_name, parse_exposure, parse_fps, parse_frames, parse_hfov};
use crate::failure::{Failure, warn};
use afterimage::ViewGeometry;
use afterimage_eval::exposure::{Chosen, Exposure};
use afterimage_lab::scanpath::GazeMap;
use afterimage_lab::source::ReadLimits;
use afterimage_metric::{Flip, Viewing};
use clap::Args;
use std::path::PathBuf;

/// Score frames of any renderer against its full-rate frames
///
/// Color alone is read: no depth, no motion.
#[derive(Args, Clone, Debug)]
#[command(
    after_help = "Examples:\n  afterimage compare full/ foveated/ --gaze 960,540 --hfov 90 --fps 90 --out out/compare\n  \
    afterimage compare full/ a/ b/ --gaze viewing.csv --display-peak 100 --display-ambient 200 --out out/compare\n  \
    afterimage compare out/run/reference out/run/none out/run/smr --gaze out/run/gaze.csv --out out/compare\n  \
    afterimage compare full.mp4 foveated.mp4 --hfov 40 --video out/both.mp4 --out out/video\n  \
    afterimage compare full.png denoised.png --gaze 100,80 --out out/still\n\n\
    Prints and writes JOD, PSNR, SSIM and FLIP (docs/metrics.md) of all frames, by eccentricity from the gaze, and in\n\
    the worst crop of 64x64 pixels: OUT/report.json, OUT/frames.csv (by frame), OUT/sheet.png (with maps of the error),\n\
    OUT/jod.svg, jod.png, psnr.svg and psnr.png (by frame), OUT/gaze.csv."
)]
pub struct CompareArgs {
    /// Full-rate frames: a folder of numbered .exr (linear) or .png (sRGB) frames, one picture, or a video: .y4m, or
    /// .mp4, .mkv, .webm and .mov, which need an installed ffmpeg
    #[arg(value_name = "REFERENCE")]
    pub reference: String,
    /// Frames to score, of the same size and number, such as foveated ones; the first with the first, in the order of
    /// their numbers
    #[arg(value_name = "TEST", required = true)]
    pub tests: Vec<String>,
    /// Output folder
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
    /// Layer that has the color of .exr frames; default: by its name (docs/renderers.md)
    #[arg(long, value_name = "NAME")]
    pub color: Option<String>,
    /// Where the eye looks: scanpath or export of an eye tracker (FILE; docs/gaze-logs.md), gaze.csv of a run, one
    /// fixed frame pixel (X,Y), or synthetic[:SEED]; default: the middle of the frame
    #[arg(long, value_name = "GAZE", allow_hyphen_values = true)]
    pub gaze: Option<String>,
    /// Map from screen to frame: keep visual angles, or stretch; default: angle if the file states the screen's
    /// geometry
    #[arg(long, value_parser = by_name::<GazeMap>())]
    pub gaze_map: Option<GazeMap>,
    /// Start time in the scanpath, seconds: that of the first frame
    #[arg(long, default_value_t = 0.0, value_name = "S")]
    pub start: f64,
    #[command(flatten)]
    pub log: GazeLogArgs,
    /// Number of frames, from the first on; default: all
    #[arg(long, value_parser = parse_frames, value_name = "N")]
    pub frames: Option<u64>,
    /// Frames per second; default: what cameras.json, EXR files, videos or report.json of a run say, else 60
    #[arg(long, value_parser = parse_fps, value_name = "F")]
    pub fps: Option<f32>,
    /// Horizontal field of view of the flat view, degrees; default: what cameras.json or report.json of a run says,
    /// else 70
    #[arg(long, value_parser = parse_hfov, value_name = "DEG")]
    pub hfov: Option<f32>,
    #[command(flatten)]
    pub display: DisplayArgs,
    /// Exposure of linear frames (.exr) before sRGB encoding, stops, or auto: what makes the mean of the first frame
    /// middle grey. Above 1 is white
    #[arg(long, default_value = "0", value_parser = parse_exposure, value_name = "EV|auto", allow_negative_numbers = true)]
    pub exposure: Exposure,
    /// Also write a video of reference and tests side by side: .y4m, or .mp4, which needs an installed ffmpeg
    #[arg(long, value_name = "FILE")]
    pub video: Option<PathBuf>,
    /// Score pixels that are NaN or infinite as black, and count them, instead of refusing their frame
    #[arg(long)]
    pub nonfinite_as_black: bool,
    /// Skip FLIP, which takes a third of a second per megapixel on one core
    #[arg(long)]
    pub no_flip: bool,
    /// Skip JOD, the foveated video metric
    #[arg(long)]
    pub no_jod: bool,
    /// Limit on the size of input images, million pixels
    #[arg(long, default_value_t = 64, value_name = "N")]
    pub max_megapixels: u32,
}

/// A comparison, checked before its first frame is scored.
pub struct Plan {
    pub inputs: Inputs,
    pub frames: usize,
    pub fps: f32,
    pub hfov_deg: f32,
    pub geometry: ViewGeometry,
    pub gaze_px: Vec<[f32; 2]>,
    pub gaze: String,
    pub gaze_map: &'static str,
    pub exposure: Chosen,
    pub flip: Option<Flip>,
    pub viewing: Option<Viewing>,
}

/// Opens the inputs and checks the options.
pub fn plan(args: &CompareArgs) -> Result<Plan, Failure> {
    let limits = ReadLimits::from_megapixels(args.max_megapixels);
    let inputs = Inputs::open(&args.reference, &args.tests, &limits, args.frames, args.color.as_deref())?;
    let frames = inputs.frames(args.frames)?;
    let stated = inputs.stated();
    let fps = args.fps.or(stated.fps).unwrap_or(60.0);
    let hfov_deg = args.hfov.or(stated.hfov_deg).unwrap_or(70.0);
    let geometry = ViewGeometry::flat(inputs.size(), hfov_deg)?;
    let (gaze, track) = track(args, &geometry, fps, frames)?;
    let exposure = inputs.exposure(args.exposure)?;
    let viewing = Viewing { geometry, display: args.display.display(), fps };
    Ok(Plan {
        frames,
        fps,
        gaze_px: held(&track.px, &geometry),
        gaze,
        gaze_map: track.map,
        exposure,
        flip: (!args.no_flip).then(|| Flip::for_view(&geometry)),
        viewing: (!args.no_jod).then_some(viewing),
        hfov_deg,
        geometry,
        inputs,
    })
}

/// The gaze as an option of `run`, and its positions.
fn track(args: &CompareArgs, geometry: &ViewGeometry, fps: f32, frames: usize) -> Result<(String, Track), Failure> {
    let [x, y] = middle_px(geometry);
    let gaze = args.gaze.clone().unwrap_or(format!("{x},{y}"));
    let options = GazeArgs { gaze, gaze_map: args.gaze_map, start: args.start, log: args.log.clone() };
    let track = options.resolve(geometry, fps, Some(frames as u64), None, 0.0)?;
    if let Some(recorded) = track.recorded.filter(|recorded| *recorded < frames as u64) {
        warn(&[format!(
            "{}: covers {recorded} of {frames} frames at {fps} frames a second; its last position is held",
            options.gaze
        )]);
    }
    Ok((options.gaze, track))
}

/// Pixels lie at whole numbers.
fn middle_px(geometry: &ViewGeometry) -> [f32; 2] {
    geometry.size_px().map(|side| 0.5 * (side as f32 - 1.0))
}

/// The last known gaze of each frame; the middle before there is one.
fn held(px: &[Option<[f32; 2]>], geometry: &ViewGeometry) -> Vec<[f32; 2]> {
    let mut last = middle_px(geometry);
    let hold = |px: &Option<[f32; 2]>| {
        last = px.unwrap_or(last);
        last
    };
    px.iter().map(hold).collect()
}
