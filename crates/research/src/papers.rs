//! `cargo research papers`: savings of foveated path tracing, compared with the results of two papers.
//!
//! Makes the tables of `docs/performance.md`, "Foveated against uniform" and "Both papers' patterns beside sparse
//! frames with smr"; the commands are there.

use super::planned_smr::{CLIP_FRAMES, Comparer, Comparison, Shown};
use crate::options::TracedArgs;
use afterimage::ViewGeometry;
use afterimage_eval::output::write_json;
use afterimage_lab::device::{Backend, NO_ADAPTER};
use afterimage_lab::pipeline::{Processor, ProcessorInfo};
use afterimage_program::failure::{Failure, warn};
use afterimage_trace::measure::{Pattern, PatternReport, TracedView, UNIFORM_EVERY, UNIFORM_SAMPLES, measure, regions};
use afterimage_trace::sampling::{Layers, Regions, Sampling};
use afterimage_trace::settings::{Bsdf, Integrator, TraceSettings};
use serde::Serialize;

/// The display of Mohanto et al. 2023: size in pixels and in centimeters, and viewing distance.
const DISPLAY_PX: [u32; 2] = [3840, 2160];
const DISPLAY_CM: [f32; 2] = [70.848, 39.852];
const DISPLAY_AWAY_CM: f32 = 60.0;
/// The paper's radii of the regions, pixels.
const RADII_PX: [f32; 2] = [147.0, 482.0];

/// The paper's results: samples per block, million samples per frame, time reduction in Sponza. Without a GPU, we trace
/// a quarter of the samples where they are divisible by 4.
const TRIPLES: [Triple; 3] = [
    Triple { samples: [32, 16, 8], is_divisible: true, millions: 8.60, time: 23.93 },
    Triple { samples: [32, 8, 4], is_divisible: true, millions: 5.39, time: 35.33 },
    Triple { samples: [32, 2, 1], is_divisible: false, millions: 2.98, time: 56.13 },
];
const UNIFORM_MILLIONS: f64 = 265.4;
/// Time reduction of the first triple with halved radii.
const HALVED_TIME: f64 = 44.67;

/// Field of view of one eye, and of its lens, for the thesis, which does not specify its headset.
const EYE_HFOV_DEG: f32 = 100.0;
/// The thesis' scenes, with its speed-ups for gaze forward and into the corner. Its empty scene was limited by the
/// display's frame rate.
const SCENES: [(&str, Option<[f64; 2]>); 5] = [
    ("control", None),
    ("bunny-low", Some([1.99, 3.99])),
    ("bunny-high", Some([1.75, 8.83])),
    ("cubes", Some([5.11, 7.99])),
    ("mirror-room", Some([5.30, 5.49])),
];
const THESIS_DEPTH: u32 = 8;
const THESIS_SAMPLES: u32 = 4;

struct Triple {
    samples: [u32; 3],
    is_divisible: bool,
    millions: f64,
    time: f64,
}

#[derive(Serialize)]
struct PapersReport {
    tool: &'static str,
    version: &'static str,
    backend: ProcessorInfo,
    frames: u64,
    arithmetic: Vec<Arithmetic>,
    regions: PapersSceneReport,
    layers: Vec<PapersSceneReport>,
}

/// Samples per frame on the paper's display.
#[derive(Serialize)]
struct Arithmetic {
    pattern: String,
    million_samples: f64,
    reduction: f64,
    paper_million_samples: f64,
}

#[derive(Serialize)]
struct PapersSceneReport {
    scene: String,
    triangles: u32,
    size: [u32; 2],
    hfov_deg: f32,
    max_depth: u32,
    patterns: Vec<Compared>,
}

#[derive(Serialize)]
struct Compared {
    #[serde(flatten)]
    ours: PatternReport,
    /// Time reduction reported by the paper.
    paper_time_reduction: Option<f64>,
    /// The paper's time reduction divided by the ideal reduction on its display.
    paper_share_of_ideal: Option<f64>,
    /// The pattern's frames beside planned frames. Layers: without a lens.
    #[serde(flatten)]
    comparison: Comparison,
}

/// Measures both tables: the first with frames of `size`, the second with frames whose width is that height (1080x1200
/// for 1920x1080).
pub fn bench(args: &TracedArgs, size: [u32; 2], frames: u64) -> Result<(), Failure> {
    let backend = args.backend.open()?.pop().ok_or_else(|| Failure::Input(NO_ADAPTER.into()))?;
    let eye = [size[1], (size[1] * 10).div_ceil(9)];
    let layers = |(name, paper): &(&str, Option<[f64; 2]>)| layers_of(name, *paper, &backend, eye, frames);
    let report = PapersReport {
        tool: "afterimage",
        version: env!("CARGO_PKG_VERSION"),
        frames,
        arithmetic: arithmetic()?,
        regions: regions_of_a_scene(args, &backend, size, frames)?,
        layers: SCENES.iter().map(layers).collect::<Result<_, _>>()?,
        backend: backend.info(),
    };
    print(&report);
    Ok(write_json(args.json.as_deref(), &report)?)
}

fn display() -> Result<ViewGeometry, Failure> {
    let [x, y] = DISPLAY_CM.map(|cm| 0.5 * cm / DISPLAY_AWAY_CM);
    Ok(ViewGeometry::off_axis(DISPLAY_PX, [-x, x], [-y, y])?)
}

/// The pattern with the paper's radii in pixels instead of its angles.
fn with_its_radii(samples: [u32; 3], radius_scale: f32) -> Regions {
    let cm = DISPLAY_CM[0] / DISPLAY_PX[0] as f32;
    let diameters_deg = RADII_PX.map(|px| 2.0 * (px * cm / DISPLAY_AWAY_CM).atan().to_degrees());
    Regions { samples, diameters_deg, radius_scale, ..Regions::default() }
}

fn arithmetic() -> Result<Vec<Arithmetic>, Failure> {
    let display = display()?;
    let uniform = DISPLAY_PX.map(f64::from).iter().product::<f64>() * 32e-6;
    let row = |t: &Triple| {
        let million_samples = with_its_radii(t.samples, 1.0).ideal_samples(&display) * 1e-6;
        let reduction = uniform / million_samples;
        let pattern = t.samples.map(|s| s.to_string()).join(",");
        Arithmetic { pattern, million_samples, reduction, paper_million_samples: t.millions }
    };
    let all = Arithmetic {
        pattern: "uniform, 32".into(),
        million_samples: uniform,
        reduction: 1.0,
        paper_million_samples: UNIFORM_MILLIONS,
    };
    Ok(std::iter::once(all).chain(TRIPLES.iter().map(row)).collect())
}

/// The first table: the field of view of the paper's display, at any size in pixels.
fn regions_of_a_scene(
    args: &TracedArgs,
    backend: &Backend,
    size: [u32; 2],
    frames: u64,
) -> Result<PapersSceneReport, Failure> {
    let name = args.scene.first().map_or("builtin:courtyard", String::as_str);
    let subject = TracedView::open(name, size, args.camera.as_deref(), Some(display()?.hfov_deg()))?;
    warn(subject.warnings());
    let settings = TraceSettings::default();
    let (is_quartered, middle) = (!backend.is_real_gpu(), subject.middle_px());
    let pattern = |t: &Triple, radius_scale| regions(t.samples, t.is_divisible && is_quartered, radius_scale, middle);
    let patterns = TRIPLES.iter().map(|t| pattern(t, 1.0)).chain([pattern(&TRIPLES[0], 0.5)]);
    let display = display()?;
    let uniform = DISPLAY_PX.map(f64::from).iter().product::<f64>() * 32.0;
    let halved = uniform / with_its_radii(TRIPLES[0].samples, 0.5).ideal_samples(&display);
    let papers = TRIPLES.iter().map(|t| (t.time, UNIFORM_MILLIONS / t.millions)).chain([(HALVED_TIME, halved)]);
    let papers: Vec<_> = papers.map(|(time, ideal)| [Some(time), Some(time / ideal)]).collect();
    scene_report(&subject, settings, backend, frames, &patterns.collect::<Vec<_>>(), &papers, Pattern::clone)
}

/// Two rows of the second table.
fn layers_of(
    name: &str,
    paper: Option<[f64; 2]>,
    backend: &Backend,
    eye_px: [u32; 2],
    frames: u64,
) -> Result<PapersSceneReport, Failure> {
    let subject = TracedView::open(&format!("builtin:{name}"), eye_px, None, Some(EYE_HFOV_DEG))?;
    let settings = TraceSettings {
        integrator: Integrator::Naive,
        bsdf: Bsdf::Phong,
        max_depth: THESIS_DEPTH,
        ..TraceSettings::default()
    };
    let lens_deg = 0.5 * EYE_HFOV_DEG;
    let middle = subject.middle_px();
    // Distance of the lens' rim towards the top left: nothing is visible beyond.
    let rim = 0.5 * eye_px[0] as f32 * std::f32::consts::FRAC_1_SQRT_2;
    let pattern = |name: &str, gaze_px| Pattern {
        name: name.into(),
        sampling: Sampling::Layers(Layers { lens_deg: Some(lens_deg), ..Layers::default() }),
        samples: THESIS_SAMPLES,
        gaze_px,
    };
    let patterns = [pattern("forward", middle), pattern("corner", middle.map(|v| v - rim))];
    let papers = [0, 1].map(|i| [paper.map(|p| p[i]), None]);
    let without_lens = |pattern: &Pattern| Pattern { sampling: Sampling::Layers(Layers::default()), ..pattern.clone() };
    scene_report(&subject, settings, backend, frames, &patterns, &papers, without_lens)
}

/// Measures a scene. `papers`: the paper's time reduction with each pattern, and this divided by the ideal reduction;
/// `compared_as`: pattern of the filled frame that a planned one is compared with.
fn scene_report(
    subject: &TracedView,
    settings: TraceSettings,
    backend: &Backend,
    frames: u64,
    patterns: &[Pattern],
    papers: &[[Option<f64>; 2]],
    compared_as: impl Fn(&Pattern) -> Pattern,
) -> Result<PapersSceneReport, Failure> {
    let (tracer, by_wall) = (subject.tracer(backend, settings)?, backend.is_real_gpu());
    let measured = measure(subject, &tracer, patterns, frames, by_wall);
    let mut comparer = Comparer::new(subject, &tracer, backend, by_wall);
    let mut compared = vec![];
    for ((ours, pattern), &[paper_time_reduction, paper_share_of_ideal]) in
        measured.into_iter().zip(patterns).zip(papers)
    {
        let comparison = comparer.compare(&compared_as(pattern))?;
        compared.push(Compared { ours, paper_time_reduction, paper_share_of_ideal, comparison });
    }
    Ok(PapersSceneReport {
        scene: subject.name.rsplit('/').next().unwrap_or(&subject.name).to_owned(),
        triangles: subject.world.geometry.len(),
        size: subject.geometry().size_px(),
        hfov_deg: subject.geometry().hfov_deg(),
        max_depth: settings.max_depth,
        patterns: compared,
    })
}

/// Both tables as Markdown.
fn print(report: &PapersReport) {
    let ([w, h], [inner, outer]) = (DISPLAY_PX, RADII_PX);
    say!("Samples of a frame of {w}x{h} pixels, radii {inner} and {outer} pixels:\n");
    say!("| samples | million | reduction | the paper's million |\n|---|---|---|---|");
    for row in &report.arithmetic {
        let [ours, paper] = [row.million_samples, row.paper_million_samples];
        say!("| {} | {ours:.2} | {:.1}x | {paper} |", row.pattern, row.reduction);
    }
    print_regions(&report.regions);
    print_layers(&report.layers);
    let clock = report.regions.patterns.first().map_or("", |p| p.ours.clock);
    say!("\n{}, {clock} time, the median where frames are several; frames: {}.", report.backend.name, report.frames);
    if clock == "CPU" {
        say!("Uniform frames: {UNIFORM_SAMPLES} samples a pixel of every {UNIFORM_EVERY}th band of rows.");
    }
    say!("Quality is that of frame {CLIP_FRAMES} against a full-rate frame with as many samples a pixel as the fovea.");
}

fn print_regions(scene: &PapersSceneReport) {
    let ([w, h], hfov_deg, depth) = (scene.size, scene.hfov_deg, scene.max_depth);
    say!("\n{}, {} triangles, {w}x{h}, {hfov_deg:.1} degrees wide, depth {depth}:\n", scene.scene, scene.triangles);
    say!(
        "| pattern | ideal | of samples | of time | share of ideal | the paper's time | its share | frames a second \
         {COMPARED_HEAD}"
    );
    say!("|---|---|---|---|---|---|---|---|---|---|");
    for Compared { ours, paper_time_reduction, paper_share_of_ideal, comparison } in &scene.patterns {
        let rates = ours.times().filter(|_| ours.clock == "wall");
        say!(
            "| {} | {} | {:.1}x | {} | {} | {} | {} | {} {}",
            ours.pattern,
            factor(ours.ideal_reduction, 1),
            ours.sample_reduction,
            factor(ours.time_reduction, 1),
            percent(ours.share_of_ideal),
            factor(*paper_time_reduction, 2),
            percent(*paper_share_of_ideal),
            rates.map_or("-".into(), |(u, f)| format!("{:.2} to {:.2}", 1e3 / u.median, 1e3 / f.median)),
            compared(comparison),
        );
    }
}

fn print_layers(scenes: &[PapersSceneReport]) {
    let Some(PapersSceneReport { size: [w, h], hfov_deg, max_depth, .. }) = scenes.first() else { return };
    say!(
        "\nLayers, an eye of {w}x{h} pixels, {hfov_deg:.0} degrees wide, {THESIS_SAMPLES} samples, depth {max_depth}:\n"
    );
    say!("| scene | triangles | gaze | of samples | of time | the thesis' | ms, uniform to foveated {COMPARED_HEAD}");
    say!("|---|---|---|---|---|---|---|---|---|");
    for scene in scenes {
        for Compared { ours, paper_time_reduction, comparison, .. } in &scene.patterns {
            say!(
                "| {} | {} | {} | {:.1}x | {} | {} | {} {}",
                scene.scene,
                scene.triangles,
                ours.pattern,
                ours.sample_reduction,
                factor(ours.time_reduction, 1),
                factor(*paper_time_reduction, 2),
                ours.times().map_or("-".into(), |(u, f)| format!("{:.0} to {:.0}", u.median, f.median)),
                compared(comparison),
            );
        }
    }
    say!("\nThe last two columns are without the lens.");
}

/// Header of [`compared`].
const COMPARED_HEAD: &str = "| filled: dB, FLIP, ms | planned: dB, FLIP, ms |";

/// The two last columns of both tables.
fn compared(comparison: &Comparison) -> String {
    let Comparison { filled, planned_smr, .. } = comparison;
    let quality = |shown: &Shown| {
        let psnr_db = shown.psnr_db.map_or("-".into(), |db| format!("{db:.2}"));
        format!("{psnr_db}, {:.4}", shown.flip)
    };
    let Shown { render_ms, post_ms, .. } = planned_smr;
    format!("| {}, {:.0} | {}, {render_ms:.0} + {post_ms:.0} |", quality(filled), filled.total_ms, quality(planned_smr))
}

fn factor(value: Option<f64>, digits: usize) -> String {
    value.map_or("-".into(), |v| format!("{v:.digits$}x"))
}

fn percent(share: Option<f64>) -> String {
    share.map_or("-".into(), |s| format!("{:.0} %", s * 100.0))
}
