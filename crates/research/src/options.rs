//! Options that several experiments share.

use afterimage_cli::args::backend::{BackendName, Traces};
use afterimage_cli::args::parse_size;
use afterimage_program::failure::Failure;
use clap::{Args, ValueEnum};
use std::path::PathBuf;

/// Options of experiments on traced scenes.
#[derive(Args, Clone, Debug)]
pub struct TracedArgs {
    /// Size of a frame, pixels; default: 1920x1080 for papers (the second paper's frames are as wide as this height),
    /// 960x540 for foveated, 192x108 for effects
    #[arg(long, value_parser = parse_size, value_name = "WxH")]
    pub size: Option<[u32; 2]>,
    /// Frames: effects: after warm-up, at least 30, default: 30; papers and foveated: per pattern, at least 1, default:
    /// 3
    #[arg(long, value_name = "N")]
    pub frames: Option<u64>,
    /// Scenes, separated by commas; default: builtin:courtyard, for effects four built-in ones. papers: the first
    /// paper's
    #[arg(long, value_delimiter = ',', value_name = "LIST")]
    pub scene: Vec<String>,
    /// papers (first paper), foveated: camera of the scenes, as for `afterimage trace`; default: still
    #[arg(long, value_name = "NAME|FILE.json")]
    pub camera: Option<String>,
    /// Device that traces; papers use the adapter if there is one
    #[arg(long, value_enum, default_value = "auto")]
    pub backend: Traces,
    /// Also write the results as JSON
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
}

/// The path tracer with and without each effect that a scene does not need
#[derive(Args, Clone, Debug)]
pub struct EffectsArgs {
    #[command(flatten)]
    pub traced: TracedArgs,
    /// Write the tables between the markers of this Markdown file, or to a new file
    #[arg(long, value_name = "FILE.md")]
    pub out: Option<PathBuf>,
    /// Also compare with kernels whose source lacks the effect
    #[arg(long)]
    pub removal: bool,
}

impl TracedArgs {
    /// Size and number of frames, by default these.
    pub fn of(&self, size: [u32; 2], frames: u64, least: u64) -> Result<([u32; 2], u64), Failure> {
        let frames = self.frames.unwrap_or(frames);
        if !(least..=100_000).contains(&frames) {
            return Err(Failure::Input(format!("--frames {frames}: expected {least} to 100000")));
        }
        Ok((self.size.unwrap_or(size), frames))
    }
}

/// Table 1 and the run times of weighted reservoir sampling (Cantory et al. 2025) in Markdown, with our results and
/// theirs
#[derive(Args, Clone, Debug)]
#[command(after_help = "Example:\n  cargo research wrs sponza_still/ sponza_lateral/ --gaze viewing.csv --out DIR\n\n\
    Run the same command again to resume. OUT/report.html has all results.")]
pub struct WrsTableArgs {
    /// A still, as for run; compared with the paper's scenes "-S"
    pub still: String,
    /// Frames of a camera that moves sideways; compared with the paper's scenes "-M"
    pub moving: String,
    /// Scanpath, as for run
    #[arg(long, value_name = "FILE.csv")]
    pub gaze: String,
    /// Start time in the scanpath, seconds
    #[arg(long, default_value_t = 0.0, value_name = "S")]
    pub start: f64,
    /// Number of frames of each point
    #[arg(long, default_value_t = 300, value_name = "N")]
    pub frames: u64,
    /// Block edge in the middle region, pixels. With 4 and 8 a frame of 1920x1080 has the block angles of the paper's
    /// 3840x2160 with 8 and 16
    #[arg(long, default_value_t = 4, value_name = "N")]
    pub rate_mid: u32,
    /// Block edge in the periphery, pixels
    #[arg(long, default_value_t = 8, value_name = "N")]
    pub rate_far: u32,
    /// Another scanpath for the readings, stretched over the picture
    #[arg(long, value_name = "FILE.csv")]
    pub second_gaze: Option<String>,
    /// Make these tables alone
    #[arg(long, value_enum, value_name = "TABLES")]
    pub only: Option<Tables>,
    /// Repetitions of randomized methods, each with another seed
    #[arg(long, default_value_t = 3, value_name = "N")]
    pub seeds: u64,
    /// Device that runs the methods
    #[arg(long, value_enum, default_value = "auto")]
    pub backend: BackendName,
    /// Folder of the sweep
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
    /// File for the tables; default: standard output
    #[arg(long, value_name = "FILE.md")]
    pub markdown: Option<PathBuf>,
}

/// Tables of `cargo research wrs`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Tables {
    /// Table 1 and run times, which need a sweep
    Published,
    /// Gains of the method with other readings of its equations, on the still
    Readings,
}
