//! `afterimage scanpath`: write a synthetic scanpath.

use crate::args::parse_size;
use crate::failure::Failure;
use afterimage_lab::scanpath::{EventKind, Screen, SyntheticOptions, generate, write_csv};
use afterimage_lab::whole_file::write_whole;
use clap::Args;
use std::path::PathBuf;

/// Write a synthetic scanpath: fixations, drift, microsaccades, saccades
#[derive(Args, Clone, Debug)]
#[command(after_help = "Example:\n  afterimage scanpath --seconds 10 --seed 3 --out viewing.csv")]
pub struct ScanpathArgs {
    /// Duration, seconds
    #[arg(long, default_value_t = 5.0, value_name = "S")]
    pub seconds: f64,
    /// Samples per second
    #[arg(long, default_value_t = 500.0, value_name = "HZ")]
    pub rate: f64,
    /// Screen size, pixels
    #[arg(long, value_parser = parse_size, default_value = "1920x1080", value_name = "WxH")]
    pub screen: [u32; 2],
    /// Horizontal field of view of the screen, degrees
    #[arg(long, default_value_t = 70.0, value_name = "DEG")]
    pub hfov: f32,
    /// Seed of the random numbers: same seed, same scanpath
    #[arg(long, default_value_t = 0, value_name = "N")]
    pub seed: u64,
    /// File to write
    #[arg(long, value_name = "FILE.csv")]
    pub out: PathBuf,
}

/// The subcommand.
pub fn scanpath(args: &ScanpathArgs) -> Result<(), Failure> {
    let view = afterimage::ViewGeometry::flat(args.screen, args.hfov)?;
    let options = SyntheticOptions {
        seed: args.seed,
        duration_s: args.seconds,
        rate_hz: args.rate,
        screen: Screen::of_view(&view),
    };
    let synthetic = generate(&options)?;
    write_whole(&args.out, |file| write_csv(&synthetic.path, file)).map_err(|e| {
        Failure::Input(format!(
            "{}: cannot be written ({e}); give --out a file in a folder that can be written",
            args.out.display()
        ))
    })?;
    let count = |kind| synthetic.events.iter().filter(|e| e.kind == kind).count();
    say!(
        "{}: {} s, {} fixations, {} saccades, {} microsaccades",
        args.out.display(),
        args.seconds,
        count(EventKind::Fixation),
        count(EventKind::Saccade),
        count(EventKind::Microsaccade)
    );
    Ok(())
}
