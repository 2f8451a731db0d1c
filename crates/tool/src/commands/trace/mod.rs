//! `afterimage trace`: render a scene by path tracing.

mod eye_frame;
mod eyes;
mod frames;
mod report;
pub mod setup;

use crate::args::backend::BackendName;
use crate::args::paths::PathArgs;
use crate::args::pattern::PatternArgs;
use crate::args::{parse_exposure, parse_fps, parse_frames, parse_hfov, parse_samples, parse_size, print_exposure};
use crate::failure::Failure;
use crate::output::Output;
use crate::progress;
use afterimage_eval::exposure::Exposure;
use afterimage_lab::clock::Stopwatch;
use afterimage_lab::scanpath::Scanpath;
use afterimage_lab::view::View;
use afterimage_trace::sampling::Sampling;
use clap::{Args, ValueEnum};
use eye_frame::EyeFrame;
use eyes::{Eyes, below};
use frames::{Place, folders, write};
use report::TraceReport;
use setup::Setup;
use std::path::PathBuf;

/// Render a scene by path tracing
#[derive(Args, Clone, Debug)]
#[command(after_help = "Examples:\n  afterimage trace builtin:cornell --size 512x512 --spp 64 --out out/cornell\n  \
    afterimage trace scene.glb --frames 60 --aov depth,motion --out out/scene\n  \
    afterimage trace scene.glb --sampling regions --region-spp 32,8,4 --gaze viewing.csv --frames 60 --out out/foveated\n  \
    afterimage trace scene.glb --sampling layers --lens-deg 45 --hfov 90 --stereo 0.063 --out out/stereo\n\n\
    Writes OUT/color/000000.exr and .png ..., OUT/depth, OUT/motion ... (--aov), OUT/gaze.csv (foveated frames), OUT/cameras.json\n\
    and OUT/trace.json.\n\
    With --aov depth,motion the folder OUT/color is an input for `afterimage run`, with --aov depth,motion,albedo one with albedo.\n\n\
    With --stereo, OUT/left and OUT/right hold the frames of each eye, its cameras.json, gaze.csv and scanpath.csv (the same gaze as input\n\
    for `run --gaze`). OUT/cameras.json and OUT/gaze.csv are those of the head, which --camera and --gaze control. Both eyes look at the\n\
    same point in space: the first surface behind the head's gaze pixel, or infinity if there is none.")]
pub struct TraceArgs {
    /// A scene: .gltf, .glb, or builtin:NAME with NAME one of cornell, furnace, control, bunny-low, bunny-high, cubes,
    /// mirror-room, courtyard, interior
    pub scene: String,
    /// Output folder
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
    /// Size of the frames, pixels
    #[arg(long, value_parser = parse_size, default_value = "640x360", value_name = "WxH")]
    pub size: [u32; 2],
    /// Number of frames
    #[arg(long, default_value_t = 1, value_parser = parse_frames, value_name = "N")]
    pub frames: u64,
    /// Frames per second, for animated scenes and camera paths; default: the camera file's, else 60
    #[arg(long, value_parser = parse_fps, value_name = "F")]
    pub fps: Option<f32>,
    /// Horizontal field of view, degrees; default: the camera's
    #[arg(long, value_parser = parse_hfov, value_name = "DEG")]
    pub hfov: Option<f32>,
    /// A camera of the scene by name; still (the scene's first camera, else one that frames the scene), lateral, orbit,
    /// walk, head (the poses of the head in --gaze FILE.csv, or somebody who looks around with head and eye with --gaze
    /// synthetic:SEED), head-walk (the same, walking); or a .json file (cameras.json, transforms.json,
    /// keyframes ...; docs/cameras.md), or another scene (.gltf, .glb) for its first camera; default: still
    #[arg(long, value_name = "NAME|FILE")]
    pub camera: Option<String>,
    /// Animation of the scene, by name or number from 0; default: the first. It starts at its first key, and loops
    #[arg(long, visible_alias = "clip", value_name = "NAME|N")]
    pub animation: Option<String>,
    /// Samples per pixel; in the fovea with --sampling layers or acuity (for regions see --region-spp)
    #[arg(long, default_value_t = 32, value_parser = parse_samples, value_name = "N")]
    pub spp: u32,
    #[command(flatten)]
    pub pattern: PatternArgs,
    /// Render two eyes with this distance between the pupils, meters (typical 0.063; at most 0.2); parallel axes,
    /// centered on the camera; default: one eye at the camera
    #[arg(long, value_name = "IPD_M", allow_negative_numbers = true)]
    pub stereo: Option<f64>,
    #[command(flatten)]
    pub paths: PathArgs,
    /// Environment light: none, a radiance R,G,B, or an .exr with longitude along x; default: none for a scene with its
    /// own lights, else uniform white
    #[arg(long, value_name = "none|R,G,B|FILE.exr")]
    pub sky: Option<String>,
    /// Additional images to write, separated by commas; depth, motion and albedo also as channels of the color .exr
    #[arg(long, value_enum, value_delimiter = ',', value_name = "LIST")]
    pub aov: Vec<AovName>,
    /// Device that traces
    #[arg(long, value_enum, default_value = "auto")]
    pub backend: BackendName,
    /// Seed of the random numbers: same seed, same bytes
    #[arg(long, default_value_t = 0, value_name = "N")]
    pub seed: u64,
    /// File format of color: linear half-float EXR or 8-bit sRGB PNG; default: both
    #[arg(long, value_enum)]
    pub format: Option<crate::args::FormatName>,
    /// Exposure before tone mapping and encoding, stops, or auto: what makes the mean of the first frame middle grey
    #[arg(long, default_value = "0", value_parser = parse_exposure, value_name = "EV|auto", allow_negative_numbers = true)]
    pub exposure: Exposure,
    /// Tone mapping; default: reinhard for png, none for exr
    #[arg(long, value_enum)]
    pub tonemap: Option<TonemapName>,
    /// Print which effects are compiled into the kernels, and why
    #[arg(short, long)]
    pub verbose: bool,
}

/// Values of `--aov`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum AovName {
    /// Distance along the view axis, meters; 1e10 for the background
    Depth,
    /// Motion vectors in pixels, y down, previous minus current position
    Motion,
    /// Reflectance of the first surface that is neither a perfect mirror nor clear glass
    Albedo,
    /// Variance of each pixel's mean; uniform sampling only
    Variance,
    /// Level of detail: log2 of the sample spacing in pixels
    Lod,
}

/// Values of `--tonemap`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum TonemapName {
    /// x / (1 + x)
    Reinhard,
    /// Clamp at 1
    None,
}

/// The subcommand.
pub fn trace(args: &TraceArgs) -> Result<(), Failure> {
    let mut eyes = Eyes::new(args.stereo, args.size)?;
    let mut setup = Setup::new(args)?;
    let parts: Vec<String> = eyes.names().iter().flat_map(|eye| folders(args, eye)).collect();
    let out = Output::create(&args.out, &parts, &["trace.json"])?;
    let mut report = TraceReport::new(eyes.names().len());
    if args.verbose {
        report.print_effects(&setup);
    }
    let sampling = args.pattern.of.sampling()?;
    let bar = progress::bar(args.frames * eyes.names().len() as u64 * u64::from(args.size[1]), "{percent} %");
    let mut previous: Option<View> = None;
    let mut gaze = GazeTracks::default();
    let mut exposure_ev = None;
    for frame in 0..args.frames {
        let time_s = frame as f64 / f64::from(setup.of.fps);
        let head = setup.pose(frame, time_s)?;
        let views = eyes.views(&head);
        let before = eyes.views(previous.as_ref().unwrap_or(&head));
        if sampling != Sampling::Uniform {
            if gaze.head.is_empty() {
                let path = setup.of.camera.head_path();
                gaze.head = args.pattern.gaze(head.geometry(), setup.of.fps, args.frames, path)?;
            }
            let at = gaze.head[frame as usize];
            gaze.eyes.push(eyes.gaze(&setup, &head, &views, at));
        }
        for (eye, name) in eyes.names().iter().enumerate() {
            let clock = Stopwatch::start();
            // The eyes draw independent random numbers: noise shared by both would appear as a pattern floating in
            // space.
            let eye_frame = EyeFrame { view: views[eye], frame, draws: frame * views.len() as u64 + eye as u64 };
            let (picture, counts) = match gaze.eyes.last() {
                None => eye_frame.uniform(args, &setup, &bar),
                Some(gaze) => eye_frame.foveated(args, &setup, &sampling, gaze[eye], &bar),
            };
            setup.tracer.check()?;
            report.count(eye, &counts, &clock);
            let exposure_ev = *exposure_ev.get_or_insert_with(|| {
                let chosen = args.exposure.choose(&picture.color, args.white());
                bar.suspend(|| print_exposure(&chosen));
                chosen.ev
            });
            let place = Place { eye: name, index: frame as usize, exposure_ev };
            write(args, &out, &setup, &place, &picture, [&views[eye], &before[eye]])?;
        }
        report.heads.push(head);
        previous = Some(head);
    }
    bar.finish_and_clear();
    finish(args, &out, &setup, &report, &eyes, &gaze)?;
    Ok(out.finish()?)
}

/// Gaze of the head and of each eye, per frame, in pixels; empty with uniform sampling.
#[derive(Default)]
struct GazeTracks {
    head: Vec<[f32; 2]>,
    eyes: Vec<Vec<[f32; 2]>>,
}

/// Writes the files that need all frames, and prints the summary.
fn finish(
    args: &TraceArgs,
    out: &Output,
    setup: &Setup,
    report: &TraceReport,
    eyes: &Eyes,
    gaze: &GazeTracks,
) -> Result<(), Failure> {
    if !gaze.head.is_empty() {
        out.gaze("gaze.csv", &gaze.head)?;
    }
    out.text("cameras.json", &report.cameras_json(args, setup, |head| *head))?;
    for (eye, name) in eyes.names().iter().enumerate() {
        let cameras = report.cameras_json(args, setup, |head| eyes.views(head)[eye]);
        out.text(&below(name, "color/cameras.json"), &cameras)?;
        if eyes.ipd_m.is_some() {
            out.text(&below(name, "cameras.json"), &cameras)?;
            if !gaze.eyes.is_empty() {
                let of_eye: Vec<_> = gaze.eyes.iter().map(|gaze| gaze[eye]).collect();
                out.gaze(&below(name, "gaze.csv"), &of_eye)?;
                // The gaze of the eye, for `run --gaze`.
                let scanpath = Scanpath::of_frames(name, args.size, f64::from(setup.of.fps), &of_eye)?;
                out.scanpath(&below(name, "scanpath.csv"), &scanpath)?;
            }
        }
    }
    out.text("trace.json", &report.json(args, setup, eyes))?;
    report.print_summary(args, setup, eyes);
    Ok(())
}
