//! `afterimage trace`: render a scene.

pub mod pattern;
mod report;
pub mod setup;

use crate::args::parse_size;
use crate::failure::Failure;
use crate::output::Output;
use crate::run::BackendName;
use afterimage::image::Image;
use afterimage::kernel::color::srgb_encode;
use afterimage::report::clock::Stopwatch;
use afterimage::report::picture::to_rgb8;
use afterimage::source::exr_file::{self, FrameToWrite};
use afterimage::trace::effects::Effects;
use afterimage::trace::film::Film;
use afterimage::trace::sampling::Sampling;
use afterimage::trace::settings::{Bsdf, Integrator, TraceSettings};
use afterimage::trace::surfaces::Surfaces;
use afterimage::trace::view::View;
use afterimage::trace::work::Spans;
use clap::{Args, ValueEnum};
use indicatif::{ProgressBar, ProgressStyle};
use pattern::PatternArgs;
use report::Report;
use setup::Setup;
use std::io::IsTerminal;
use std::ops::Range;
use std::path::PathBuf;

/// Render a scene by path tracing
#[derive(Args, Clone, Debug)]
#[command(after_help = "Examples:\n  afterimage trace builtin:cornell --size 512x512 --spp 64 --out out/cornell\n  \
    afterimage trace scene.glb --frames 60 --aov depth,motion --out out/scene\n  \
    afterimage trace scene.glb --sampling regions --region-spp 32,8,4 --gaze viewing.csv --frames 60 --out out/foveated\n\n\
    Writes OUT/color/000000.exr and .png ..., OUT/depth, OUT/motion ... on request, OUT/gaze.csv of foveated frames, OUT/cameras.json\n\
    and OUT/trace.json.\n\
    With --aov depth,motion the folder OUT/color is an input for `afterimage run`.")]
pub struct TraceArgs {
    /// A scene: .gltf, .glb, or builtin:NAME with NAME one of cornell, furnace, control, bunny-low, bunny-high, cubes,
    /// mirror-room, courtyard
    pub scene: String,
    /// Folder for everything that is written
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
    /// Size of the frames, pixels
    #[arg(long, value_parser = parse_size, default_value = "640x360", value_name = "WxH")]
    pub size: [u32; 2],
    /// Frames
    #[arg(long, default_value_t = 1, value_name = "N")]
    pub frames: u64,
    /// Frames per second, for animated scenes and camera paths; default: the camera file's, else 60
    #[arg(long, value_name = "F")]
    pub fps: Option<f32>,
    /// Horizontal field of view, degrees; default: the camera's
    #[arg(long, value_name = "DEG")]
    pub hfov: Option<f32>,
    /// A camera of the scene by name; still (the scene's first camera, else one that frames the scene), lateral, orbit; or a file: a
    /// cameras.json, or a path {"keyframes": [{"time_s", "position", "target"}]}; default: still
    #[arg(long, value_name = "NAME|FILE.json")]
    pub camera: Option<String>,
    /// Which of the scene's animations plays, by name or number; default: the first
    #[arg(long, value_name = "NAME")]
    pub clip: Option<String>,
    /// Samples per pixel (of the fovea, where foveated; regions have --region-spp)
    #[arg(long, default_value_t = 32, value_name = "N")]
    pub spp: u32,
    #[command(flatten)]
    pub pattern: PatternArgs,
    /// Most scattering events after the camera ray, 0 to 64
    #[arg(long, default_value_t = 3, value_name = "N")]
    pub max_depth: u32,
    /// How paths find light: both ways, by looking for lights, or by chance (the thesis' way)
    #[arg(long, value_enum, default_value = "mis")]
    pub integrator: IntegratorName,
    /// How surfaces scatter: the principled model, or the thesis' Lambert and Phong
    #[arg(long, value_enum, default_value = "auto")]
    pub bsdf: BsdfName,
    /// Environment light: none, a radiance R,G,B, or an .exr with longitude along x; default: none for a scene with light of its
    /// own, else a soft white
    #[arg(long, value_name = "none|R,G,B|FILE.exr")]
    pub sky: Option<String>,
    /// What the kernels are specialised to: what the scene needs, all, or a list of names (-v prints them)
    #[arg(long, default_value = "auto", value_name = "auto|all|LIST")]
    pub effects: String,
    /// More images, separated by commas; also written into the colour's .exr
    #[arg(long, value_enum, value_delimiter = ',', value_name = "LIST")]
    pub aov: Vec<AovName>,
    /// What traces: a GPU if there is one, else the CPU; the CPU; or any adapter, software too
    #[arg(long, value_enum, default_value = "auto")]
    pub backend: BackendName,
    /// Seed of the random numbers: same seed, same bytes
    #[arg(long, default_value_t = 0, value_name = "N")]
    pub seed: u64,
    /// File format of the colour: linear half-float EXR, 8-bit sRGB PNG; default: both
    #[arg(long, value_enum)]
    pub format: Option<crate::args::FormatName>,
    /// Exposure before tone mapping, stops
    #[arg(long, default_value_t = 0.0, value_name = "EV", allow_negative_numbers = true)]
    pub exposure: f32,
    /// Tone mapping; default: reinhard for png, none for exr
    #[arg(long, value_enum)]
    pub tonemap: Option<TonemapName>,
    /// Say what is compiled in and why
    #[arg(short, long)]
    pub verbose: bool,
}

/// Names of integrators.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum IntegratorName {
    /// Both ways, weighted by the power heuristic
    Mis,
    /// By looking for lights
    Nee,
    /// By chance
    Naive,
}

impl From<IntegratorName> for Integrator {
    fn from(name: IntegratorName) -> Self {
        match name {
            IntegratorName::Mis => Self::Mis,
            IntegratorName::Nee => Self::Nee,
            IntegratorName::Naive => Self::Naive,
        }
    }
}

/// Names of scattering models.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum BsdfName {
    /// The principled model
    Auto,
    /// Lambert and Phong
    Phong,
}

/// Names of further images.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum AovName {
    /// Distance along the view axis, metres; 1e10 where there is nothing
    Depth,
    /// Pixels, y down, previous minus current
    Motion,
    /// Variance of each pixel's mean; of uniform sampling
    Variance,
    /// Level of detail, log2 of the distance of samples in pixels
    Lod,
}

/// Names of tone mappings.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum TonemapName {
    /// x / (1 + x)
    Reinhard,
    /// Cut off at 1
    None,
}

/// Depth of what is nothing, in files.
const NOTHING_M: f32 = 1e10;

/// Work items that are traced between two looks at the progress bar.
const STEP_ITEMS: u64 = 1 << 20;

/// The subcommand.
pub fn trace(args: &TraceArgs) -> Result<(), Failure> {
    let mut setup = Setup::new(args)?;
    let out = Output::create(&args.out, &folders(args), "trace.json")?;
    let mut report = Report::new();
    if args.verbose {
        report.print_effects(&setup);
    }
    let sampling = args.pattern.of.sampling()?;
    let bar = progress(args.frames * u64::from(args.size[1]));
    let mut previous: Option<View> = None;
    let mut gaze: Option<Vec<[f32; 2]>> = None;
    for frame in 0..args.frames {
        let time_s = frame as f64 / f64::from(setup.fps);
        let view = setup.pose(frame, time_s)?;
        let clock = Stopwatch::start();
        let picture = if sampling == Sampling::Uniform {
            let mut film = Film::new(args.size);
            for (rows, samples) in steps(args) {
                if samples.start == 0 {
                    bar.inc(u64::from(rows.end - rows.start));
                }
                let spans = Spans::uniform(args.size[0], rows, samples);
                setup.tracer.trace(&setup.world, &view, frame, &spans, &mut film);
            }
            report.count_film(&film, &clock);
            Picture { color: film.color(), variance: Some(film.variance()), lod: Image::filled(args.size, 0.0) }
        } else {
            if gaze.is_none() {
                gaze = Some(args.pattern.gaze(view.geometry(), setup.fps, args.frames)?);
            }
            let at = gaze.as_ref().map_or([0.0; 2], |g| g[frame as usize]);
            let plan = sampling.plan(view.geometry(), at, args.spp, frame);
            let done = plan.trace(&setup.tracer, &setup.world, &view, frame);
            bar.inc(u64::from(args.size[1]));
            report.count_foveated(
                &done,
                args.pattern.of.ideal_samples(&sampling, view.geometry(), at, args.spp),
                &clock,
            );
            Picture { color: done.color, variance: None, lod: done.lod }
        };
        write(args, &out, &setup, frame as usize, &picture, &view, previous.as_ref().unwrap_or(&view))?;
        report.cameras.push(view);
        previous = Some(view);
    }
    if let Some(gaze) = &gaze {
        out.gaze("gaze.csv", gaze)?;
    }
    bar.finish_and_clear();
    out.text("cameras.json", &report.cameras_json(args, &setup))?;
    out.text("color/cameras.json", &report.cameras_json(args, &setup))?;
    out.text("trace.json", &report.json(args, &setup))?;
    report.print_summary(args, &setup);
    Ok(())
}

/// A frame as it is written.
struct Picture {
    color: Image<[f32; 3]>,
    variance: Option<Image<[f32; 3]>>,
    lod: Image<f32>,
}

/// Rows and samples that are traced together.
fn steps(args: &TraceArgs) -> impl Iterator<Item = (Range<u32>, Range<u32>)> {
    let [w, h] = args.size;
    let samples = (STEP_ITEMS / u64::from(w)).clamp(1, u64::from(args.spp)) as u32;
    let rows = (STEP_ITEMS / (u64::from(w) * u64::from(samples))).clamp(1, u64::from(h)) as u32;
    ranges(h, rows).flat_map(move |rows| ranges(args.spp, samples).map(move |samples| (rows.clone(), samples)))
}

/// 0 to `end`, `step` at a time.
fn ranges(end: u32, step: u32) -> impl Iterator<Item = Range<u32>> {
    (0..end).step_by(step as usize).map(move |start| start..start.saturating_add(step).min(end))
}

fn folders(args: &TraceArgs) -> Vec<String> {
    let mut folders = vec!["color".to_owned()];
    for (aov, name) in
        [(AovName::Depth, "depth"), (AovName::Motion, "motion"), (AovName::Variance, "variance"), (AovName::Lod, "lod")]
    {
        if args.aov.contains(&aov) {
            folders.push(name.to_owned());
        }
    }
    folders
}

fn write(
    args: &TraceArgs,
    out: &Output,
    setup: &Setup,
    index: usize,
    picture: &Picture,
    view: &View,
    previous: &View,
) -> Result<(), Failure> {
    let color = &picture.color;
    let wants = |aov| args.aov.contains(&aov);
    let mut depth = None;
    let mut motion = None;
    if wants(AovName::Depth) || wants(AovName::Motion) {
        let seen = Surfaces::trace(&setup.world, view, previous, setup.tracer.effects(&setup.world));
        depth = wants(AovName::Depth).then(|| seen.depth.map(|d| if d.is_finite() { d } else { NOTHING_M }));
        motion = wants(AovName::Motion).then_some(seen.motion);
    }
    let scale = args.exposure.exp2();
    let mapped = |name: Option<TonemapName>, default: TonemapName| {
        let reinhard = name.unwrap_or(default) == TonemapName::Reinhard;
        color.map(|c| c.map(|v| if reinhard { v * scale / (1.0 + v * scale) } else { v * scale }))
    };
    let wants_format = |format| args.format.is_none_or(|f| f == format);
    if wants_format(crate::args::FormatName::Exr) {
        let color = mapped(args.tonemap, TonemapName::None);
        let frame = FrameToWrite { depth: depth.as_ref(), motion: motion.as_ref(), ..FrameToWrite::color(&color) };
        let path = out.path("color", index, "exr");
        exr_file::write(&path, &frame).map_err(|e| Failure::writing(&path, e))?;
    }
    if wants_format(crate::args::FormatName::Png) {
        let encoded = mapped(args.tonemap, TonemapName::Reinhard).map(|c| c.map(|v| srgb_encode(v.clamp(0.0, 1.0))));
        out.picture("color", index, &to_rgb8(&encoded))?;
    }
    let channels = |folder: &str, channels: &[(&str, &Image<f32>)]| {
        let path = out.path(folder, index, "exr");
        exr_file::write_channels(&path, channels).map_err(|e| Failure::writing(&path, e))
    };
    if let Some(depth) = &depth {
        channels("depth", &[("Z", depth)])?;
    }
    if let Some(motion) = &motion {
        channels("motion", &[("motion.X", &motion.map(|m| m[0])), ("motion.Y", &motion.map(|m| m[1]))])?;
    }
    if wants(AovName::Lod) {
        channels("lod", &[("lod", &picture.lod)])?;
    }
    if wants(AovName::Variance)
        && let Some(variance) = &picture.variance
    {
        let [r, g, b] = [0, 1, 2].map(|i| variance.map(|v| v[i]));
        channels("variance", &[("R", &r), ("G", &g), ("B", &b)])?;
    }
    Ok(())
}

/// What the library is told.
pub fn settings(args: &TraceArgs, effects: Option<Effects>) -> TraceSettings {
    TraceSettings {
        integrator: args.integrator.into(),
        bsdf: match args.bsdf {
            BsdfName::Auto => Bsdf::Principled,
            BsdfName::Phong => Bsdf::Phong,
        },
        max_depth: args.max_depth,
        seed: args.seed,
        effects,
    }
}

/// A bar on a terminal, nothing elsewhere.
fn progress(rows: u64) -> ProgressBar {
    if !std::io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let style = ProgressStyle::with_template("{bar:40} {percent} %, {eta} left").expect("the template is a constant");
    ProgressBar::new(rows).with_style(style)
}
