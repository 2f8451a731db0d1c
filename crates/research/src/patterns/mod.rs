//! `cargo research patterns`: errors of sampling patterns at equal numbers of samples.
//!
//! Makes the table of patterns in `docs/path-tracing.md`; the command is there.

mod equal;

use afterimage::kernel::debug_view::heat;
use afterimage::{Image, ViewGeometry};
use afterimage_cli::args::backend::BackendName;
use afterimage_cli::args::{parse_samples, parse_size, parse_stops};
use afterimage_eval::output::{Output, write_json};
use afterimage_lab::metric::{Flip, References, Scorer, Scores, Tracked, encode};
use afterimage_lab::picture::to_rgb8;
use afterimage_lab::pipeline::{Processor, ProcessorInfo};
use afterimage_lab::source::exr_file;
use afterimage_lab::source::exr_file::FrameToWrite;
use afterimage_lab::source::{FrameSource, Light, ReadLimits, SceneChoice, SceneOptions, StillSource, ViewedScene};
use afterimage_lab::view::View;
use afterimage_program::failure::{Failure, warn};
use afterimage_trace::Tracer;
use afterimage_trace::film::Film;
use afterimage_trace::settings::TraceSettings;
use afterimage_trace::work::Spans;
use afterimage_trace::world::World;
use clap::Args;
use equal::Candidate;
use serde::Serialize;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// Compare errors of sampling patterns of the path tracer at equal numbers of camera samples
#[derive(Args, Clone, Debug)]
#[command(
    after_help = "Example:\n  cargo research patterns builtin:courtyard --region-spp 8,4,2 --out out/patterns\n\n\
    Writes OUT/patterns.md, the first frame of each pattern and its FLIP map, OUT/reference.png and OUT/reference.exr."
)]
pub struct PatternsArgs {
    /// A scene: .gltf, .glb, or builtin:NAME
    scene: String,
    /// Output folder
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Camera of the scene: one of its cameras by name, still, framing, or a .json file; default: its first camera
    #[arg(long, value_name = "NAME|FILE.json")]
    camera: Option<String>,
    /// Size of a frame, pixels
    #[arg(long, value_parser = parse_size, default_value = "640x360", value_name = "WxH")]
    size: [u32; 2],
    /// Horizontal field of view, degrees; default: the camera's
    #[arg(long, value_name = "DEG")]
    hfov: Option<f32>,
    /// Gaze, pixels; default: the center
    #[arg(long, value_delimiter = ',', num_args = 1, value_name = "X,Y")]
    gaze: Option<Vec<f32>>,
    /// Samples of the pattern regions: per pixel in the fovea, per 2x2 block in the middle, per 4x4 block outside. The
    /// other patterns are fitted to the same total, within 2 %
    #[arg(long, value_delimiter = ',', default_value = "8,4,2", value_name = "A,B,C")]
    region_spp: Vec<u32>,
    /// Number of scored frames of each pattern
    #[arg(long, default_value_t = 8, value_name = "N")]
    frames: u64,
    /// Samples per pixel of the reference
    #[arg(long, default_value_t = 256, value_parser = parse_samples, value_name = "N")]
    reference_samples: u32,
    /// Reference that this command wrote earlier for the same view; default: trace one
    #[arg(long, value_name = "FILE.exr")]
    reference: Option<PathBuf>,
    /// Exposure before tone mapping (x / (1 + x)), stops
    #[arg(long, default_value_t = 0.0, value_parser = parse_stops, value_name = "EV", allow_negative_numbers = true)]
    exposure: f32,
    /// Device that traces
    #[arg(long, value_enum, default_value = "auto")]
    backend: BackendName,
    /// Also write the results as JSON
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

/// Frame number of the reference, so that its random numbers differ from those of all test frames.
const REFERENCE_FRAME: u64 = 1 << 30;
/// Samples per pixel that are traced at a time.
const REFERENCE_STEP: u32 = 8;

#[derive(Serialize)]
struct PatternsReport<'a> {
    tool: &'static str,
    version: &'static str,
    scene: &'a str,
    size: [u32; 2],
    hfov_deg: f32,
    gaze_px: [f32; 2],
    frames: u64,
    /// `null` if the reference was read from a file.
    reference_samples: Option<u32>,
    flip_pixels_per_degree: f32,
    backend: ProcessorInfo,
    patterns: Vec<PatternScores>,
}

#[derive(Serialize)]
struct PatternScores {
    pattern: &'static str,
    settings: String,
    /// Mean camera samples per frame.
    samples: f64,
    /// Mean rays of all kinds per frame.
    rays: f64,
    /// Samples divided by those of the pattern regions.
    samples_of_regions: f64,
    #[serde(flatten)]
    scores: Scores,
}

/// A scene with view and tracer.
struct Stage {
    world: World,
    view: View,
    tracer: Tracer,
    gaze_px: [f32; 2],
    exposure: f32,
}

/// The subcommand.
pub fn bench(args: &PatternsArgs) -> Result<(), Failure> {
    let region_spp = check(args)?;
    let of = ViewedScene::open(&SceneChoice {
        camera: Some(args.camera.as_deref().unwrap_or("still")),
        light: Light::IfDark,
        options: SceneOptions { size: Some(args.size), hfov_deg: args.hfov, fps: None },
        ..SceneChoice::new(&args.scene)
    })?;
    warn(of.warnings());
    let ([view, _], _) = of.views(0);
    let geometry = *view.geometry();
    let middle = args.size.map(|s| 0.5 * (s as f32 - 1.0));
    let gaze_px = args.gaze.as_ref().map_or(middle, |g| [g[0], g[1]]);
    let patterns = equal::candidates(&geometry, gaze_px, region_spp)?;
    let backend = args.backend.open_for_scenes()?;
    let world = World::new(&of.scene);
    let tracer = Tracer::new(&backend, &world, TraceSettings::default())
        .map_err(|e| Failure::Input(format!("{}: {e}; use --backend cpu", args.scene)))?;
    let stage = Stage { world, view, tracer, gaze_px, exposure: args.exposure.exp2() };
    let given = args.reference.as_deref().map(|path| read(path, args.size)).transpose()?;
    let out = Output::create(&args.out, &[], &["patterns.md"])?;
    let linear = given.unwrap_or_else(|| stage.converged(args.reference_samples));
    out.root_picture("reference.png", &to_rgb8(&stage.display(&linear)))?;
    let path = args.out.join("reference.exr");
    exr_file::write(&path, &FrameToWrite::color(&linear)).map_err(|e| Failure::writing(&path, e))?;
    let reports = stage.compare(&patterns, &stage.display(&linear), args.frames, &out)?;
    let table = markdown(&reports);
    out.text("patterns.md", &table)?;
    out.finish()?;
    let report = PatternsReport {
        tool: "afterimage",
        version: env!("CARGO_PKG_VERSION"),
        scene: &args.scene,
        size: args.size,
        hfov_deg: geometry.hfov_deg(),
        gaze_px,
        frames: args.frames,
        reference_samples: args.reference.is_none().then_some(args.reference_samples),
        flip_pixels_per_degree: Flip::for_view(&geometry).pixels_per_degree(),
        backend: backend.info(),
        patterns: reports,
    };
    write_json(args.json.as_deref(), &report)?;
    say!("{table}");
    say!("pictures and FLIP maps: {}", args.out.display());
    Ok(())
}

/// Checks the arguments; returns the samples of regions.
fn check(args: &PatternsArgs) -> Result<[u32; 3], Failure> {
    let refuse = |text: String| Err(Failure::Input(text));
    if args.size.iter().any(|s| !(16..=4096).contains(s)) {
        return refuse(format!("--size {}x{}: expected 16 to 4096 pixels a side", args.size[0], args.size[1]));
    }
    if args.gaze.as_ref().is_some_and(|g| g.len() != 2 || g.iter().any(|v| !v.is_finite())) {
        return refuse("--gaze: expected a pixel, such as 320,180".into());
    }
    if !(1..=10_000).contains(&args.frames) {
        return refuse(format!("--frames {}: expected 1 to 10000", args.frames));
    }
    match args.region_spp[..] {
        [a, b, c] if [a, b, c].iter().all(|v| (1..=4096).contains(v)) => Ok([a, b, c]),
        _ => refuse("--region-spp: expected three numbers of 1 to 4096, such as 8,4,2".into()),
    }
}

/// A reference of an earlier run.
fn read(path: &Path, size: [u32; 2]) -> Result<Image<[f32; 3]>, Failure> {
    let color = StillSource::open(path, &ReadLimits::default())?.frame(0)?.color;
    if color.size() == size {
        return Ok(color);
    }
    let [w, h] = color.size();
    Err(Failure::Input(format!("{}: is {w}x{h}; expected {}x{}, or another --size", path.display(), size[0], size[1])))
}

impl Stage {
    fn geometry(&self) -> &ViewGeometry {
        self.view.geometry()
    }

    /// Reference: the frame with `samples` per pixel, traced in steps of [`REFERENCE_STEP`].
    fn converged(&self, samples: u32) -> Image<[f32; 3]> {
        let [w, h] = self.geometry().size_px();
        let mut film = Film::new([w, h]);
        for first in (0..samples).step_by(REFERENCE_STEP as usize) {
            let spans = Spans::uniform(w, 0..h, first..(first + REFERENCE_STEP).min(samples));
            self.tracer.trace(&self.world, &self.view, REFERENCE_FRAME, &spans, &mut film);
        }
        film.color()
    }

    /// Tone maps by x / (1 + x) and encodes as sRGB, like `trace`.
    fn display(&self, linear: &Image<[f32; 3]>) -> Image<[f32; 3]> {
        encode(&linear.map(|c| c.map(|v| v * self.exposure / (1.0 + v * self.exposure))), 0.0)
    }

    /// Traces and scores all patterns, and writes the first frame and FLIP map of each.
    fn compare(
        &self,
        patterns: &[Candidate],
        reference: &Image<[f32; 3]>,
        frames: u64,
        out: &Output,
    ) -> Result<Vec<PatternScores>, Failure> {
        let size = self.geometry().size_px();
        let ecc_deg = self.geometry().eccentricity_map(self.gaze_px);
        let tracked = Tracked::unknown(size);
        let flip = Flip::for_view(self.geometry());
        let mut references = References::with_flip(flip.clone());
        let full = references.next(reference, &tracked, &ecc_deg);
        let mut reports: Vec<PatternScores> = vec![];
        for pattern in patterns {
            let mut scorer = Scorer::default();
            let (mut samples, mut rays) = (0, 0);
            for frame in 0..frames {
                let plan = pattern.sampling.plan(self.geometry(), self.gaze_px, pattern.samples, frame);
                let done = plan.trace(&self.tracer, &self.world, &self.view, frame);
                samples += done.samples.iter().sum::<u64>();
                rays += done.rays;
                let shown = self.display(&done.color);
                scorer.push(&full, &shown, &tracked, &ecc_deg);
                if frame == 0 {
                    let map = flip.map(reference, &shown).map(|v| heat(v).to_array());
                    out.root_picture(&format!("{}.png", pattern.name), &to_rgb8(&shown))?;
                    out.root_picture(&format!("{}_flip.png", pattern.name), &to_rgb8(&map))?;
                }
            }
            let per_frame = |sum: u64| sum as f64 / frames as f64;
            let of_regions = reports.first().map_or(per_frame(samples), |r| r.samples);
            reports.push(PatternScores {
                pattern: pattern.name,
                settings: pattern.settings.clone(),
                samples: per_frame(samples),
                rays: per_frame(rays),
                samples_of_regions: per_frame(samples) / of_regions,
                scores: scorer.scores(),
            });
        }
        Ok(reports)
    }
}

/// Table with one row for each pattern.
fn markdown(reports: &[PatternScores]) -> String {
    let mut table = String::from(
        "| pattern | samples | weighted dB | PSNR dB: all, fovea, mid, periphery | SSIM | FLIP: all, fovea, mid, periphery |\n\
         |---|---|---|---|---|---|\n",
    );
    let digits = |value: Option<f64>, digits: usize| value.map_or("-".into(), |v| format!("{v:.digits$}"));
    for r in reports {
        let s = &r.scores;
        let list = |of: &dyn Fn(&afterimage_lab::metric::BandScores) -> String| {
            std::iter::once(&s.whole).chain(&s.bands).map(of).collect::<Vec<_>>().join(", ")
        };
        // Writing to a string cannot fail.
        let _ = writeln!(
            table,
            "| {}: {} | {:.0} | {} | {} | {} | {} |",
            r.pattern,
            r.settings,
            r.samples,
            digits(s.weighted_psnr_db, 2),
            list(&|b| digits(b.psnr_db, 2)),
            digits(s.whole.ssim, 4),
            list(&|b| digits(b.flip, 4)),
        );
    }
    table
}
