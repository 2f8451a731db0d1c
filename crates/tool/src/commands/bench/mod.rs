//! `afterimage bench`: times of the passes and of the path tracer. The project's experiments are in `crates/research`.

mod post;
mod rays;

use crate::args::backend::Traces;
use crate::args::parse_size;
use crate::failure::Failure;
use clap::{Args, ValueEnum};
use std::path::PathBuf;

/// Time the passes, or the path tracer
#[derive(Args, Clone, Debug)]
#[command(after_help = "Examples:\n  afterimage bench post --size 3840x2160 --frames 60 --json bench.json\n  \
    afterimage bench trace --scene builtin:courtyard --foveated")]
pub struct BenchArgs {
    /// What to time
    #[arg(value_enum, default_value = "post")]
    pub what: What,
    /// Size of a frame, pixels; default: 1920x1080 for post, 640x360 for trace
    #[arg(long, value_parser = parse_size, value_name = "WxH")]
    pub size: Option<[u32; 2]>,
    /// Frames after warm-up, at least 30; default: 60 for post, 30 for trace
    #[arg(long, value_name = "N")]
    pub frames: Option<u64>,
    /// post: passes besides the copy, separated by commas; default: all
    #[arg(long, value_delimiter = ',', value_name = "LIST")]
    pub only: Vec<String>,
    /// trace: scenes, separated by commas; default: builtin:courtyard
    #[arg(long, value_delimiter = ',', value_name = "LIST")]
    pub scene: Vec<String>,
    /// trace: camera of the scenes, as for `afterimage trace`: a camera by name, still, framing, lateral, orbit, walk,
    /// or a file; default: still
    #[arg(long, value_name = "NAME|FILE.json")]
    pub camera: Option<String>,
    /// trace: device that traces
    #[arg(long, value_enum, default_value = "auto")]
    pub backend: Traces,
    /// trace: also compare foveated with uniform frames
    #[arg(long)]
    pub foveated: bool,
    /// Also write the results as JSON
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
}

/// Subjects of the benchmark.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum What {
    /// The post-process (none, taa, wrs, smr, taau), the foveation simulators (mip, gauss, block), and a copy pass that
    /// moves as many bytes as wrs
    Post,
    /// The path tracer: rays per second, depth 3, multiple importance sampling
    Trace,
}

/// The subcommand.
pub fn bench(args: &BenchArgs) -> Result<(), Failure> {
    let (size, frames) = match args.what {
        What::Post => ([1920, 1080], 60),
        What::Trace => ([640, 360], 30),
    };
    let (size, frames) = (args.size.unwrap_or(size), args.frames.unwrap_or(frames));
    if !(30..=100_000).contains(&frames) {
        return Err(Failure::Input(format!("--frames {frames}: expected 30 to 100000")));
    }
    match args.what {
        What::Post => post::bench(args, size, frames),
        What::Trace => rays::bench(args, size, frames),
    }
}
