//! Options of the command line.

use afterimage_cli::args::parse_size;
use clap::Args;
use std::path::PathBuf;

/// Environment variable with the command of the judge, if there is no `--judge`.
const JUDGE: &str = "JUDGE";

/// Full rate and frames shaded by quads over every scene at hand
#[derive(Args, Clone, Debug)]
pub struct ForeignArgs {
    /// Size of a frame, at least 64x64 pixels
    #[arg(long, value_parser = parse_size, value_name = "WxH", default_value = "320x180")]
    pub size: [u32; 2],
    /// Frames of a clip
    #[arg(long, value_name = "N", default_value = "36", value_parser = clap::value_parser!(u64).range(1..=100_000))]
    pub frames: u64,
    /// Frames at the end of the clip that are scored
    #[arg(long, value_name = "N", default_value = "16", value_parser = clap::value_parser!(u64).range(1..=100_000))]
    pub scored: u64,
    /// Jittered frames whose mean is the reference
    #[arg(long, value_name = "N", default_value = "16", value_parser = clap::value_parser!(u32).range(1..=1024))]
    pub reference_samples: u32,
    /// Only these scenes, separated by commas
    #[arg(long, value_name = "LIST", value_delimiter = ',', conflicts_with = "write")]
    pub scenes: Vec<String>,
    /// Folder with a folder for each scene
    #[arg(long, value_name = "FOLDER", default_value = "../shared/data/scenes")]
    pub folder: PathBuf,
    /// Write the scored frames and the crops here
    #[arg(long, value_name = "FOLDER")]
    pub out: Option<PathBuf>,
    /// Python and a script that computes FovVideoVDP, separated by a space; default: the environment variable JUDGE
    #[arg(long, value_name = "COMMAND")]
    pub judge: Option<String>,
    /// Write the tables and the picture of docs/foreign.md; run from the root of the workspace
    #[arg(long)]
    pub write: bool,
}

impl ForeignArgs {
    /// Words of the judge's command.
    pub fn judge(&self) -> Option<Vec<String>> {
        let command = self.judge.clone().or_else(|| std::env::var(JUDGE).ok())?;
        let words: Vec<String> = command.split_whitespace().map(str::to_owned).collect();
        (!words.is_empty()).then_some(words)
    }

    /// First frame that is scored.
    pub fn warm(&self) -> u64 {
        self.frames.saturating_sub(self.scored)
    }
}
