//! `afterimage run`: foveate frames, run methods on them, score the results.

pub mod plan;
mod plot;

use crate::args::backend::BackendName;
use crate::args::display::DisplayArgs;
use crate::args::gaze::GazeArgs;
use crate::args::head::head_path;
use crate::args::input::{FoveatedSampling, InputArgs, Rendering, SourceName};
use crate::args::pattern::{SamplingArgs, SamplingName};
use crate::args::{
    FilterName, FormatName, FoveationArgs, MethodArgs, MethodName, Named, by_name, parse_exposure, parse_frame_range,
    parse_frames, parse_latency, parse_pixel, parse_samples, print_exposure,
};
use crate::clip::pixel::ExplainedPixel;
use crate::clip::run_report::{RunFacts, write_report};
use crate::clip::{Clip, ClipReport, FrameResult, REPORTS};
use crate::failure::Failure;
use crate::output::{Output, WriteError};
use crate::progress;
use crate::report::cameras::cameras_json;
use crate::video::SideBySide;
use afterimage::DebugView;
use afterimage::internal::{FoveationKind, MethodKind};
use afterimage_eval::exposure::Exposure;
use afterimage_eval::metric;
use afterimage_lab::device::Backend;
use afterimage_lab::quad_views::QuadViewLayout;
use afterimage_lab::scanpath::HeadPath;
use afterimage_lab::source::{AlbedoLayer, FrameSource};
use afterimage_trace::sampling::Sampling;
use clap::{Args, Parser};
use glam::DMat4;
use std::ffi::OsString;
use std::path::PathBuf;

/// Foveate frames, run methods on them, score the results
#[derive(Args, Clone, Debug)]
#[command(
    after_help = "Example:\n  afterimage run frames/ --gaze viewing.csv --start 1 --frames 120 --method none,wrs --out out/run\n  \
    afterimage run scene.glb --foveation layers --rate-mid 2 --rate-far 4 --frames 60 --method none,smr --out out/layers\n  \
    afterimage run scene.glb --foveation uniform --scale 1.5 --frames 60 --method none --out out/uniform\n  \
    afterimage run frames/ --frames 60 --method smr --pixel 320,180 --pixel-frames 58..59 --out out/pixel\n\n\
    Writes OUT/<method>/000000.png ..., OUT/sheet.png, OUT/psnr.svg and OUT/psnr.png (PSNR by\n\
    frame), OUT/gaze.csv, OUT/frames.csv and OUT/report.json. Of scenes, the latter two also have the time of rendering\n\
    the frames and that of the whole frame, renderer and method. With --camera head also OUT/scanpath.csv, the\n\
    head's scanpath as --gaze takes it, and the camera of each frame: OUT/pose.csv (meters and a quaternion x, y, z, w in\n\
    the scene's axes; x right, y up, looking along -z) and OUT/cameras.json, also beside frames in EXR."
)]
pub struct RunArgs {
    /// Output folder
    #[arg(long, value_name = "DIR", help_heading = "Output")]
    pub out: PathBuf,
    #[command(flatten)]
    pub gaze: GazeArgs,
    /// Number of frames; default: the whole input, for stills and analytic scenes the whole scanpath (5 s of a
    /// synthetic or fixed gaze)
    #[arg(long, value_parser = parse_frames, value_name = "N")]
    pub frames: Option<u64>,
    #[command(flatten)]
    pub input: InputArgs,
    /// Samples per pixel of the full-rate frames that are the reference for scores, in scenes and analytic clips, and
    /// which simulators foveate without --jitter. Default: 16 in rasterised scenes and jittered analytic clips, 64 with
    /// --sampling, else what the input has
    #[arg(long, value_parser = parse_samples, value_name = "N", help_heading = "Scores")]
    pub reference_samples: Option<u32>,
    /// First frame that counts in scores; frames.csv and the pictures have all. Without history, the first frames of a
    /// clip are another question
    #[arg(long, default_value_t = 0, value_name = "N", help_heading = "Scores")]
    pub score_from: usize,
    /// Latency of the eye tracker, milliseconds: the renderer and the methods see the gaze of so long ago, scores and
    /// gaze.csv have the true one; at most 1000
    #[arg(long, default_value_t = 0.0, value_parser = parse_latency, value_name = "MS", help_heading = "Gaze")]
    pub gaze_latency: f64,
    /// Keep the fovea in the middle of the frame, as without an eye tracker: the renderer and the methods see that
    /// gaze, scores and gaze.csv have the true one
    #[arg(long, conflicts_with = "gaze_latency", help_heading = "Gaze")]
    pub fixed_fovea: bool,
    #[command(flatten)]
    pub sampling: SamplingArgs,
    #[command(flatten)]
    pub foveation: FoveationArgs,
    /// Methods, separated by commas
    #[arg(
        long, value_parser = by_name::<MethodName>(), value_delimiter = ',', default_value = "none,wrs,smr", value_name = "LIST"
    )]
    pub method: Vec<MethodName>,
    #[command(flatten)]
    pub method_settings: MethodArgs,
    /// Give smr the albedo of every pixel of planned frames: it interpolates and remembers light, and texture is the
    /// pixel's own. scene: of the surfaces of a rasterised scene, with --jitter halton; else a layer of EXR frames,
    /// by default one of a known name (docs/renderers.md); off: none
    #[arg(long, value_name = "scene|NAME|off")]
    pub albedo: Option<AlbedoName>,
    /// Give the methods a mask of pixels that move without motion vectors, if the scene has one (analytic:scroll)
    #[arg(long)]
    pub trust: bool,
    /// Device that runs the methods
    #[arg(long, value_enum, default_value = "auto")]
    pub backend: BackendName,
    /// Seed of the random numbers: same seed, same bytes
    #[arg(long, default_value_t = 0, value_name = "N")]
    pub seed: u64,
    /// File format of frames: 8-bit sRGB PNG, or linear half-float EXR
    #[arg(long, value_enum, default_value = "png", help_heading = "Output")]
    pub format: FormatName,
    /// Exposure before sRGB encoding, stops, or auto: what makes the mean of the first frame middle grey
    #[arg(long, default_value = "0", value_parser = parse_exposure, value_name = "EV|auto", allow_negative_numbers = true, help_heading = "Output")]
    pub exposure: Exposure,
    /// Also write the full-rate frames
    #[arg(long, help_heading = "Output")]
    pub reference: bool,
    /// Also write a video of reference and methods side by side: .y4m, or .mp4, which needs an installed ffmpeg
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    pub video: Option<PathBuf>,
    /// Skip FLIP, which takes a third of a second per megapixel on one core
    #[arg(long, help_heading = "Scores")]
    pub no_flip: bool,
    /// Skip JOD, the foveated video metric
    #[arg(long, help_heading = "Scores")]
    pub no_jod: bool,
    #[command(flatten)]
    pub display: DisplayArgs,
    /// Debug views to write as images, separated by commas
    #[arg(long, value_parser = by_name::<DebugView>(), value_delimiter = ',', value_name = "LIST", help_heading = "Output")]
    pub debug: Vec<DebugView>,
    /// Print how each method computes this pixel, value by value: inputs, texels of history, verdict, comparison,
    /// gains, shares, what is shown and stored; also into OUT/pixel.csv. (0,0) is the top-left pixel, y down. Methods
    /// run on the CPU
    #[arg(long, value_parser = parse_pixel, value_name = "X,Y", allow_hyphen_values = true, help_heading = "Output")]
    pub pixel: Option<[u32; 2]>,
    /// Frames in which --pixel is printed, from A to B, both included; default: the last one
    #[arg(long, value_parser = parse_frame_range, requires = "pixel", value_name = "A..B", help_heading = "Output")]
    pub pixel_frames: Option<[usize; 2]>,
}

/// Values of `--albedo`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum AlbedoName {
    /// Of the surfaces of a rasterised scene.
    Scene,
    /// A layer of EXR frames.
    Layer(String),
    /// None, even if EXR frames have one.
    Off,
}

impl From<&str> for AlbedoName {
    fn from(text: &str) -> Self {
        match text {
            "scene" => Self::Scene,
            "off" => Self::Off,
            layer => Self::Layer(layer.to_owned()),
        }
    }
}

impl RunArgs {
    /// Parses the words of a command line after `run`.
    pub fn from_words(words: impl IntoIterator<Item = impl Into<OsString> + Clone>) -> Result<Self, Failure> {
        #[derive(Parser)]
        #[command(name = "run", no_binary_name = true)]
        struct Run {
            #[command(flatten)]
            args: RunArgs,
        }
        Ok(Run::try_parse_from(words).map_err(|e| Failure::usage(&e))?.args.with_defaults())
    }

    /// Fills in defaults that depend on other options.
    #[must_use]
    pub fn with_defaults(self) -> Self {
        let is_scene = self.input.is_scene();
        let default = match is_scene && self.sampling.sampling == SamplingName::Uniform {
            true => FoveationKind::Quads,
            false => FoveationKind::Mip,
        };
        let is_traced = is_scene && !self.input.is_rasterised();
        let mut args = Self { foveation: self.foveation.with_defaults(default, is_traced), ..self };
        args.input.channels.albedo = args.albedo_layer();
        args
    }

    /// The layer of EXR frames that is read as albedo.
    fn albedo_layer(&self) -> AlbedoLayer {
        let is_used = self.foveation.is_quads() && self.method.contains(&MethodName::Post(MethodKind::Smr));
        match &self.albedo {
            None if is_used => AlbedoLayer::Recognised,
            Some(AlbedoName::Layer(name)) => AlbedoLayer::Named(name.clone()),
            _ => AlbedoLayer::Skip,
        }
    }

    /// Whether smr gets an albedo, of an input that has one or not.
    fn takes_albedo(&self, has_albedo: bool) -> bool {
        match self.albedo {
            None => has_albedo && !self.input.is_scene(),
            Some(AlbedoName::Off) => false,
            Some(_) => has_albedo,
        }
    }

    /// The head that moves the camera, with `--camera head`.
    pub fn head(&self) -> Result<Option<HeadPath>, Failure> {
        head_path(self.input.camera.as_deref(), &self.gaze, &self.input.name, self.input.fps, self.frames)
    }

    /// Settings for rendering a scene on `backend`.
    pub fn rendering(&self, backend: &Backend, head: Option<&HeadPath>) -> Result<Rendering, Failure> {
        // Methods choose the pixels of quads; a pattern has none of its own.
        let pattern = self.sampling()?.or(self.foveation.is_quads().then_some(Sampling::Uniform));
        let foveated = pattern
            .map(|pattern| FoveatedSampling { pattern, reference_samples: self.reference_samples.unwrap_or(64) });
        Ok(Rendering { backend: backend.clone(), seed: self.seed, foveated, head: head.cloned() })
    }

    /// Sampling pattern of traced frames; `None` if a simulator foveates full-rate frames.
    pub fn sampling(&self) -> Result<Option<Sampling>, Failure> {
        let is_traced = self.input.source == Some(SourceName::Trace);
        if self.sampling.sampling == SamplingName::Uniform {
            // Frames without foveation: their error is noise alone.
            return Ok((is_traced && self.foveation.filter() == FilterName::Of(FoveationKind::Off))
                .then_some(Sampling::Uniform));
        }
        if !is_traced {
            return Err(Failure::Input(format!(
                "--sampling {}: applies to traced frames only; add --source trace, or use --foveation",
                self.sampling.sampling.name()
            )));
        }
        Ok(Some(self.sampling.sampling()?))
    }

    /// Samples a pixel of rasterised and analytic references; `None`: what the input has.
    pub fn reference_samples(&self) -> Result<Option<u32>, Failure> {
        let default = (self.input.is_rasterised() || self.foveation.is_jittered()).then_some(16);
        if self.input.is_rasterised() || self.input.is_analytic() {
            return Ok(self.reference_samples.or(default));
        }
        if self.reference_samples.is_some() && !self.input.is_scene() {
            return Err(Failure::Input(format!(
                "--reference-samples: {} has frames already; give a scene (.gltf, .glb, builtin:NAME) or analytic:NAME, or \
                 leave the option out",
                self.input.name
            )));
        }
        Ok(None)
    }

    /// Whether methods choose the pixels that a path tracer traces.
    pub fn is_traced_by_plan(&self) -> bool {
        self.input.source == Some(SourceName::Trace) && self.foveation.is_quads()
    }
}

/// The subcommand.
pub fn run(args: &RunArgs) -> Result<(), Failure> {
    let args = args.clone().with_defaults();
    let report = execute(&args)?;
    print_summary(&args, &report);
    Ok(())
}

/// Runs the clip and writes its files; prints nothing.
fn execute(args: &RunArgs) -> Result<ClipReport, Failure> {
    let Backends { renderer, methods } = Backends::open(args)?;
    let head = args.head()?;
    let mut source = args.input.open(&args.rendering(&renderer, head.as_ref())?)?;
    let plan = plan::plan(args, source.info(), methods, head.as_ref())?;
    // The input can be read, or nothing is written.
    let playback = plan.clip.start(source.as_mut())?;
    print_exposure(playback.exposure());
    let mut video = start_video(args, &plan)?;
    let cameras: Vec<String> = folders(args).iter().map(|folder| format!("{folder}/cameras.json")).collect();
    let reports: Vec<&str> = REPORTS.into_iter().chain(OF_HEAD).chain(cameras.iter().map(String::as_str)).collect();
    let out = Output::create(&args.out, &folders(args), &reports)?;
    let bar = progress::of_frames(plan.clip.gaze.len() as u64);
    let report = playback.write(&out, &mut |result| {
        if let Some(pixel) = &plan.clip.pixel {
            bar.suspend(|| say_pixel(pixel, result, &plan.clip));
        }
        bar.inc(1);
        video.as_mut().map_or(Ok(()), |video| Ok(show(video, result)?))
    })?;
    bar.finish_and_clear();
    video.map_or(Ok(()), SideBySide::finish)?;
    if let Some(head) = &head {
        write_head(args, head, source.as_ref(), &plan, &out)?;
    }
    plot::write(&plan, plan::simulator(args), &report, &out)?;
    let facts = RunFacts {
        input: &args.input.name,
        fps: plan.fps,
        seed: args.seed,
        simulator: plan::simulator(args),
        geometry: args.foveation.quad_views().map(|_| args.foveation.geometry().name()),
        scale: match args.foveation.quad_views() {
            Some(QuadViewLayout::Uniform { step }) => Some(step),
            _ => None,
        },
        gaze: &args.gaze.gaze,
        gaze_map: plan.gaze_map,
        start_s: args.gaze.start,
        gaze_latency_ms: args.gaze_latency,
        fixed_fovea: args.fixed_fovea,
    };
    write_report(&facts, &plan.clip, &report, &out)?;
    out.finish()?;
    Ok(report)
}

/// Starts the video of `--video`.
fn start_video(args: &RunArgs, plan: &plan::Plan) -> Result<Option<SideBySide>, Failure> {
    let Some(path) = &args.video else { return Ok(None) };
    let names = plan.clip.methods.iter().map(|method| method.0);
    SideBySide::create(path, ["reference"].into_iter().chain(names), plan.clip.geometry.size_px(), plan.fps).map(Some)
}

/// Adds a frame to the video.
fn show(video: &mut SideBySide, result: &FrameResult<'_>) -> Result<(), WriteError> {
    let encode = |image| metric::encode(image, result.exposure_ev);
    let shown: Vec<_> = result.step.outputs.iter().map(|output| encode(&output.image)).collect();
    video.push([result.reference.encoded()].into_iter().chain(&shown), result.step.gaze_px)
}

/// Prints all that is known of a pixel of a frame, in the frames in which it is explained.
fn say_pixel(pixel: &ExplainedPixel, result: &FrameResult<'_>, clip: &Clip) {
    for ((name, _), output) in clip.methods.iter().zip(&result.step.outputs) {
        if !output.notes.is_empty() {
            say!("{}", pixel.lines(result.index, name, &output.notes));
        }
    }
}

/// Devices of a run.
struct Backends {
    renderer: Backend,
    methods: Backend,
}

impl Backends {
    /// Opens them. A pixel is explained on the CPU; scenes may still be rendered on a device.
    fn open(args: &RunArgs) -> Result<Self, Failure> {
        if args.pixel.is_none() {
            let renderer = args.backend.open_for(&args.input.name)?;
            return Ok(Self { methods: renderer.clone(), renderer });
        }
        if args.backend == BackendName::Gpu {
            let text = "--pixel: the CPU explains a pixel, and its frames equal those of --backend gpu bit for bit on \
                        software Vulkan; leave --backend gpu out";
            return Err(Failure::Input(text.into()));
        }
        let renders = args.input.is_scene();
        let renderer = if renders { args.backend.open_for(&args.input.name)? } else { Backend::Cpu };
        Ok(Self { renderer, methods: Backend::Cpu })
    }
}

/// Files of a run whose camera is a head.
const OF_HEAD: [&str; 3] = ["scanpath.csv", "pose.csv", "cameras.json"];

/// Writes the head's scanpath, from which the run can be repeated, and the camera of every frame.
fn write_head(
    args: &RunArgs,
    head: &HeadPath,
    source: &dyn FrameSource,
    plan: &plan::Plan,
    out: &Output,
) -> Result<(), WriteError> {
    out.scanpath("scanpath.csv", head.scanpath())?;
    let frames = 0..plan.clip.gaze.len() as u64;
    let pose = |frame| {
        let pose = source.camera_pose(frame)?;
        Some(DMat4::from_translation(pose.origin) * pose.world_from_camera)
    };
    let poses: Vec<_> = frames.filter_map(pose).collect();
    let mut table = out.table("pose.csv", "frame,x_m,y_m,z_m,qx,qy,qz,qw")?;
    for (frame, pose) in poses.iter().enumerate() {
        let (_, q, p) = pose.to_scale_rotation_translation();
        table.row(&format!("{frame},{:.6},{:.6},{:.6},{:.8},{:.8},{:.8},{:.8}", p.x, p.y, p.z, q.x, q.y, q.z, q.w))?;
    }
    table.finish()?;
    let view = &plan.clip.geometry;
    let cameras = cameras_json(view.size_px(), plan.fps, view.hfov_deg(), poses.into_iter());
    out.text("cameras.json", &cameras)?;
    // Other programs look for it beside EXR frames.
    let beside = folders(args).into_iter().filter(|f| args.format == FormatName::Exr && !f.starts_with("debug/"));
    for folder in beside {
        out.text(&format!("{folder}/cameras.json"), &cameras)?;
    }
    Ok(())
}

/// Folders of the run's frames.
fn folders(args: &RunArgs) -> Vec<String> {
    let mut folders: Vec<String> = args.method.iter().map(|m| m.name().to_owned()).collect();
    for method in args.method.iter().filter(|&&m| m != MethodName::Oracle) {
        folders.extend(args.debug.iter().map(|d| format!("debug/{}/{}", method.name(), d.name())));
    }
    if args.reference {
        folders.push("reference".into());
    }
    folders
}

fn print_summary(args: &RunArgs, report: &ClipReport) {
    let db = |v: Option<f64>| v.map_or("-".into(), |v| format!("{v:.2}"));
    let ms = |v: Option<f64>| v.map_or("-".into(), |v| format!("{v:.1}"));
    say!("{} frames, methods on the {}", report.gaze_px.len(), report.backend);
    say!(
        "method       JOD  PSNR dB    SSIM    FLIP   fovea     mid  periph  weighted  retained  flicker  of oracle  \
         render +   post =  total ms"
    );
    for (name, m) in &report.methods {
        let s = &m.scores;
        let bands = s.bands.map(|b| if b.mse == Some(0.0) { "exact".into() } else { db(b.psnr_db) });
        say!(
            "{name:8} {:>7} {:>8} {:>7} {:>7} {:>7} {:>7} {:>7} {:>9} {:>9} {:>8} {:>10} {:>7} {:>8} {:>9}",
            db(s.whole.jod),
            db(s.whole.psnr_db),
            s.whole.ssim.map_or("-".into(), |v| format!("{v:.4}")),
            s.whole.flip.map_or("-".into(), |v| format!("{v:.4}")),
            bands[0],
            bands[1],
            bands[2],
            db(s.weighted_psnr_db),
            db(s.retained_psnr_db),
            db(s.flicker),
            m.share_of_oracle.and_then(|s| s.psnr).map_or("-".into(), |v| format!("{:.0} %", 100.0 * v)),
            ms(m.frame.render.cost_ms()),
            ms(m.post_ms()),
            ms(m.total_ms()),
        );
    }
    say!("JOD: quality by a foveated video metric, 10 for no visible difference, docs/metrics.md");
    say!("weighted: PSNR with errors weighted by the density of retinal ganglion cells, docs/metrics.md");
    say!(
        "retained: PSNR of pixels that were sharp in an earlier frame; of oracle: share of the PSNR that reuse could gain"
    );
    say!("ms: median of a frame, CPU time of the process, or timestamps of a GPU; render: only of scenes");
    if let Some(full) = report.full_rate.and_then(|full| full.cost_ms()) {
        say!("rendering a frame at full rate: {full:.1} ms");
    }
    say!("contact sheet: {}", args.out.join("sheet.png").display());
    say!("PSNR by frame: {}", args.out.join("psnr.png").display());
}
