//! `afterimage bench`: times of passes, tracers and effects.

mod effects;
mod foveated;
mod growth;
mod papers;
mod patterns;
mod post;
mod rays;
mod savings;
mod sparse_smr;
mod subject;
mod wrs_readings;
mod wrs_table;

use crate::args::parse_size;
use crate::failure::Failure;
use afterimage_lab::whole_file::write_whole;
use clap::{Args, Subcommand, ValueEnum};
use serde::Serialize;
use std::io::Write;
use std::path::{Path, PathBuf};

/// Time the passes, the path tracer, foveated sampling as in two papers, or effects
#[derive(Args, Clone, Debug)]
#[command(after_help = "Examples:\n  afterimage bench post --size 3840x2160 --frames 60 --json bench.json\n  \
    afterimage bench trace --scene builtin:courtyard --foveated\n  \
    afterimage bench growth --of pixels,triangles --json growth.json\n  \
    afterimage bench papers --scene sponza.gltf --camera inside.json --json papers.json\n  \
    afterimage bench foveated --scene builtin:courtyard --backend cpu\n  \
    MESA_SHADER_CACHE_DISABLE=true afterimage bench effects --out docs/effects.md")]
#[command(args_conflicts_with_subcommands = true)]
pub struct BenchArgs {
    #[command(subcommand)]
    pub compare: Option<Compare>,
    /// Subject of the benchmark
    #[arg(value_enum, default_value = "post")]
    pub what: What,
    /// Size of a frame, pixels; default: 1920x1080 for post, 640x360 for trace, 1920x1080 for papers (the second
    /// paper's frames are as wide as this height), 960x540 for foveated, 192x108 for effects
    #[arg(long, value_parser = parse_size, value_name = "WxH")]
    pub size: Option<[u32; 2]>,
    /// Frames after warm-up, at least 30; default: 60 for post, 30 for trace and effects; for papers and
    /// foveated per pattern, at least 1, default: 3
    #[arg(long, value_name = "N")]
    pub frames: Option<u64>,
    /// post: passes besides the copy, separated by commas; default: all
    #[arg(long, value_delimiter = ',', value_name = "LIST")]
    pub only: Vec<String>,
    /// trace, papers (first paper), foveated, effects: scenes, separated by commas; default: builtin:courtyard, for
    /// effects four built-in ones
    #[arg(long, value_delimiter = ',', value_name = "LIST")]
    pub scene: Vec<String>,
    /// trace, papers (first paper), foveated: camera of the scenes, as for `afterimage trace`: a camera by name, still,
    /// framing, lateral, orbit, walk, or a file; default: still
    #[arg(long, value_name = "NAME|FILE.json")]
    pub camera: Option<String>,
    /// trace, papers, foveated, effects: device that traces; papers use the adapter if there is one
    #[arg(long, value_enum, default_value = "auto")]
    pub backend: Traces,
    /// effects: write the tables between the markers of this Markdown file, or to a new file
    #[arg(long, value_name = "FILE.md")]
    pub out: Option<PathBuf>,
    /// effects: also compare with kernels whose source lacks the effect
    #[arg(long)]
    pub removal: bool,
    /// trace: also compare foveated with uniform frames
    #[arg(long)]
    pub foveated: bool,
    /// Also write the results as JSON
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
}

/// Comparisons with options of their own.
#[derive(Clone, Debug, Subcommand)]
pub enum Compare {
    Growth(growth::GrowthArgs),
    Patterns(Box<patterns::PatternsArgs>),
    Wrs(Box<wrs_table::WrsTableArgs>),
}

/// Subjects of the benchmark.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum What {
    /// The post-process (none, taa, wrs, smr, taau), the foveation simulators (mip, gauss, block), and a copy pass that
    /// moves as many bytes as wrs
    Post,
    /// The path tracer: rays per second, depth 3, multiple importance sampling
    Trace,
    /// Foveated and uniform path tracing, as measured in two papers: Markdown tables with their results, ours, and
    /// those of sparse frames with smr
    Papers,
    /// What of the samples that foveated path tracing saves becomes saved time: one path a lattice point, regions
    /// 8,4,2 and 32,16,8
    Foveated,
    /// The path tracer with and without each effect that a scene does not need
    Effects,
}

/// Values of `--backend`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Traces {
    /// The CPU, and an adapter if there is one: a GPU, else software
    Auto,
    /// The CPU
    Cpu,
    /// An adapter: a GPU, else software
    Gpu,
}

/// The subcommand.
pub fn bench(args: &BenchArgs) -> Result<(), Failure> {
    match &args.compare {
        Some(Compare::Growth(args)) => return growth::bench(args),
        Some(Compare::Patterns(args)) => return patterns::bench(args),
        Some(Compare::Wrs(args)) => return wrs_table::bench(args),
        None => {}
    }
    let (size, frames) = match args.what {
        What::Post => ([1920, 1080], 60),
        What::Trace => ([640, 360], 30),
        What::Papers => ([1920, 1080], foveated::ROUNDS),
        What::Foveated => ([960, 540], foveated::ROUNDS),
        What::Effects => ([192, 108], 30),
    };
    let (size, frames) = (args.size.unwrap_or(size), args.frames.unwrap_or(frames));
    let least = if matches!(args.what, What::Papers | What::Foveated) { 1 } else { 30 };
    if !(least..=100_000).contains(&frames) {
        return Err(Failure::Input(format!("--frames {frames}: expected {least} to 100000")));
    }
    match args.what {
        What::Post => post::bench(args, size, frames),
        What::Trace => rays::bench(args, size, frames),
        What::Papers => papers::bench(args, size, frames),
        What::Foveated => savings::bench(args, size, frames),
        What::Effects => effects::bench(args, size, frames),
    }
}

fn write_json(args: &BenchArgs, report: &impl Serialize) -> Result<(), Failure> {
    write_json_to(args.json.as_deref(), report)
}

fn write_json_to(path: Option<&Path>, report: &impl Serialize) -> Result<(), Failure> {
    let Some(path) = path else { return Ok(()) };
    let text = serde_json::to_string_pretty(report).map_err(|e| Failure::Work(e.to_string()))?;
    write_whole(path, |file| writeln!(file, "{text}")).map_err(|e| Failure::writing(path, e))
}
