//! `cargo research growth`: how the time of a whole foveated frame grows with pixels, triangles and eyes.
//!
//! Makes the tables of `docs/performance.md`, "Growth".

mod fit;
mod measure;

use afterimage_cli::args::parse_size;
use afterimage_eval::output::write_json;
use afterimage_lab::device::{Headless, NO_ADAPTER, PassClock};
use afterimage_program::failure::Failure;
use afterimage_program::progress;
use clap::{Args, ValueEnum};
use fit::Fit;
use measure::{Config, Point, Renderer, Rig, measure};
use serde::Serialize;
use std::path::PathBuf;

/// Sizes of the axis of pixels.
const SIZES: [[u32; 2]; 7] =
    [[640, 360], [960, 540], [1280, 720], [1920, 1080], [2560, 1440], [3840, 2160], [7680, 4320]];
/// Triangle counts of the axis of triangles. The lanterns add 800 to each.
const TRIANGLES: [u32; 4] = [1_800, 25_200, 259_200, 2_600_000];
/// Pixels from which on a frame counts as large.
const LARGE_PIXELS: f64 = 2e6;

/// Measure how the time of a foveated frame, rendering and smr, grows with pixels, triangles and eyes
#[derive(Args, Clone, Debug)]
#[command(
    after_help = "Example:\n  cargo research growth --of pixels,triangles --renderer raster --json growth.json\n\n\
    The scene is the courtyard, built for a number of triangles, with the gaze in the middle; frames are planned\n\
    (trace: one path a pixel), and smr makes the picture. Prints\n\
    Markdown tables. Slopes are exponents: the time grows as pixels, triangles or eyes to this power."
)]
pub struct GrowthArgs {
    /// What grows, separated by commas
    #[arg(long, value_enum, value_delimiter = ',', default_value = "pixels,triangles,eyes", value_name = "LIST")]
    of: Vec<Growing>,
    /// Renderers, separated by commas
    #[arg(long, value_enum, value_delimiter = ',', default_value = "raster,trace", value_name = "LIST")]
    renderer: Vec<Renderer>,
    /// Timed frames of each point, 1 to 1000, after 2 to warm up
    #[arg(long, default_value_t = 5, value_parser = clap::value_parser!(u64).range(1..=1000), value_name = "N")]
    frames: u64,
    /// Size of the frames whose pixels do not grow
    #[arg(long, default_value = "1280x720", value_parser = parse_size, value_name = "WxH")]
    size: [u32; 2],
    /// Triangles of the scenes whose triangles do not grow, 1000 to 3 million
    #[arg(long, default_value_t = 25_200, value_parser = clap::value_parser!(u32).range(1000..=3_000_000), value_name = "N")]
    triangles: u32,
    /// Largest frame of the axis of pixels, megapixels; it ends at 33.2
    #[arg(long, default_value_t = 34.0, value_name = "N")]
    max_megapixels: f64,
    /// Also write the results as JSON
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

/// Values of `--of`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, ValueEnum)]
#[serde(rename_all = "lowercase")]
enum Growing {
    /// 0.23 to 33 million pixels
    Pixels,
    /// 2.6 thousand to 2.6 million triangles
    Triangles,
    /// One eye and two
    Eyes,
}

#[derive(Serialize)]
struct GrowthReport {
    tool: &'static str,
    version: &'static str,
    adapter: String,
    driver: String,
    clock: &'static str,
    frames: u64,
    series: Vec<Series>,
}

/// Points along an axis.
#[derive(Serialize)]
struct Series {
    of: Growing,
    renderer: Renderer,
    points: Vec<Point>,
    /// Points that could not be measured, and why.
    skipped: Vec<Skipped>,
    /// Growth of the whole frame, of the renderer and of smr.
    total: Option<Fit>,
    render: Option<Fit>,
    post: Option<Fit>,
    /// Growth of the whole frame from 2 million pixels on; `None` for other axes.
    total_of_large: Option<Fit>,
    /// Time of the last point divided by that of the first.
    last_over_first: Option<f64>,
}

#[derive(Serialize)]
struct Skipped {
    config: Config,
    reason: String,
}

impl Growing {
    fn name(self) -> &'static str {
        match self {
            Self::Pixels => "pixels",
            Self::Triangles => "triangles",
            Self::Eyes => "eyes",
        }
    }

    fn configs(self, renderer: Renderer, args: &GrowthArgs) -> Vec<Config> {
        let base = Config { renderer, size: args.size, triangles: args.triangles, eyes: 1 };
        match self {
            Self::Pixels => {
                let fits = |config: &Config| config.pixels() as f64 <= args.max_megapixels * 1e6;
                SIZES.iter().map(|&size| Config { size, ..base }).filter(fits).collect()
            }
            Self::Triangles => TRIANGLES.iter().map(|&triangles| Config { triangles, ..base }).collect(),
            Self::Eyes => [1, 2].map(|eyes| Config { eyes, ..base }).into(),
        }
    }

    /// What grows, of a point.
    fn of(self, point: &Point) -> f64 {
        match self {
            Self::Pixels => point.config.pixels() as f64,
            Self::Triangles => point.scene_triangles as f64,
            Self::Eyes => f64::from(point.config.eyes),
        }
    }
}

/// The subcommand.
pub fn bench(args: &GrowthArgs) -> Result<(), Failure> {
    let gpu = Headless::find_roomy(true).ok_or_else(|| Failure::Input(format!("bench: {NO_ADAPTER}")))?;
    let clock = PassClock::new(&gpu).name();
    let rig = Rig::new(gpu);
    let plan: Vec<(Growing, Renderer, Vec<Config>)> = args
        .of
        .iter()
        .flat_map(|&of| args.renderer.iter().map(move |&renderer| (of, renderer, of.configs(renderer, args))))
        .collect();
    let bar = progress::bar(plan.iter().map(|p| p.2.len() as u64).sum(), "point {pos}/{len}");
    let mut series = vec![];
    for (of, renderer, configs) in plan {
        let (mut points, mut skipped) = (vec![], vec![]);
        for config in configs {
            // Where a device refuses a size, smaller frames are still of use.
            let measured = match config.obstacle(&rig.gpu) {
                Some(reason) => Err(Failure::Input(reason)),
                None => measure(&rig, config, args.frames),
            };
            match measured {
                Ok(point) => points.push(point),
                Err(Failure::Input(reason)) => skipped.push(Skipped { config, reason }),
                Err(failure) => return Err(failure),
            }
            bar.inc(1);
        }
        series.push(Series::new(of, renderer, points, skipped));
    }
    bar.finish_and_clear();
    let report = GrowthReport {
        tool: "afterimage",
        version: env!("CARGO_PKG_VERSION"),
        adapter: rig.gpu.info.name.clone(),
        driver: format!("{} {}", rig.gpu.info.driver, rig.gpu.info.driver_info),
        clock,
        frames: args.frames,
        series,
    };
    say!("{} ({}); times: {}; medians of {} frames\n", report.adapter, report.driver, clock, args.frames);
    report.series.iter().for_each(Series::print);
    Ok(write_json(args.json.as_deref(), &report)?)
}

impl Series {
    fn new(of: Growing, renderer: Renderer, points: Vec<Point>, skipped: Vec<Skipped>) -> Self {
        let fit = |ms: &dyn Fn(&Point) -> f64, from: f64| {
            let large = points.iter().filter(|p| of.of(p) >= from);
            Fit::of(&large.map(|p| [of.of(p), ms(p)]).collect::<Vec<_>>())
        };
        Self {
            total: fit(&|p| p.total_ms, 0.0),
            render: fit(&|p| p.render_ms, 0.0),
            post: fit(&|p| p.post_ms, 0.0),
            total_of_large: (of == Growing::Pixels).then(|| fit(&|p| p.total_ms, LARGE_PIXELS)).flatten(),
            last_over_first: points.first().zip(points.last()).map(|(first, last)| last.total_ms / first.total_ms),
            of,
            renderer,
            points,
            skipped,
        }
    }

    /// Prints a Markdown table, the slopes, and what was skipped.
    fn print(&self) {
        let renderer = match self.renderer {
            Renderer::Raster => "rasterised",
            Renderer::Trace => "traced",
        };
        say!("Growth with {}, {renderer}:\n", self.of.name());
        say!("| megapixels | triangles | eyes | samples | render ms | smr ms | total ms |");
        say!("|---|---|---|---|---|---|---|---|");
        for p in &self.points {
            let eyes = p.config.eyes;
            let (mpx, triangles, samples) = (p.config.pixels() as f64 * 1e-6, p.scene_triangles, p.samples);
            let [render, post, total] = [p.render_ms, p.post_ms, p.total_ms];
            say!("| {mpx:.2} | {triangles} | {eyes} | {samples} | {render:.1} | {post:.1} | {total:.1} |");
        }
        let slope = |fit: Option<Fit>| match fit {
            Some(Fit { slope, standard_error: Some(error) }) => format!("{slope:.3} +- {error:.3}"),
            Some(Fit { slope, .. }) => format!("{slope:.3}"),
            None => "-".into(),
        };
        let large = self.total_of_large.map_or_else(String::new, |fit| format!(", from 2 Mpx on {}", slope(Some(fit))));
        say!(
            "\nSlope of the total {}{large}; render {}, smr {}",
            slope(self.total),
            slope(self.render),
            slope(self.post)
        );
        if let Some(ratio) = self.last_over_first {
            say!("Last over first: {ratio:.2}");
        }
        for Skipped { config, reason } in &self.skipped {
            let [w, h] = config.size;
            say!("Skipped: {w}x{h}, {} triangles, {} eyes: {reason}", config.triangles, config.eyes);
        }
        say!("");
    }
}
