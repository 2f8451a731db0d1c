//! `afterimage scanpath`: write a synthetic scanpath, or convert a gaze log.

use crate::args::gaze_log::GazeLogArgs;
use crate::args::{Named, by_name, parse_size};
use crate::failure::{Failure, warn};
use afterimage_lab::scanpath::{
    Event, EventKind, HeadOptions, Scanpath, Screen, SyntheticOptions, Vendor, generate, generate_head, in_a_room,
    write_csv,
};
use afterimage_lab::whole_file::write_whole;
use clap::Args;
#[cfg(unix)]
use std::fs::{File, Metadata};
use std::path::{Path, PathBuf};

/// Write a synthetic scanpath, or convert a gaze log
///
/// A synthetic scanpath has fixations, drift, microsaccades and saccades, of eye and head with --head. A gaze log is an
/// eye tracker's export, or a scanpath of any dialect.
#[derive(Args, Clone, Debug)]
#[command(after_help = "Examples:\n  afterimage scanpath --seconds 10 --seed 3 --out viewing.csv\n  \
    afterimage scanpath --head --walk --seconds 10 --rate 90 --out head.csv\n  \
    afterimage run scene.glb --camera head --gaze head.csv --hfov 90 --out out/head\n  \
    afterimage scanpath --from tobii recording.tsv --screen-px 1920x1080 --out viewing.csv\n\n\
    With --head, seven columns are added: position of the head (head_x_m ..., meters) and its orientation (head_qx ...,\n\
    a quaternion) with x right, y up, -z ahead. The screen is then fixed to the head: 2000x2000 pixels, 100 degrees wide.")]
pub struct ScanpathArgs {
    /// Gaze log to convert: an eye tracker's export as it is (docs/gaze-logs.md), or a scanpath of any dialect
    #[arg(
        value_name = "FILE",
        conflicts_with_all = ["seconds", "rate", "screen", "hfov", "head", "walk", "pursuits", "seed"]
    )]
    pub file: Option<String>,
    /// Whose export FILE is
    #[arg(long, value_parser = by_name::<From>(), default_value = "auto", requires = "file", value_name = "NAME")]
    pub from: From,
    #[command(flatten)]
    pub log: GazeLogArgs,
    /// Duration, seconds
    #[arg(long, default_value_t = 5.0, value_name = "S")]
    pub seconds: f64,
    /// Samples per second
    #[arg(long, default_value_t = 500.0, value_name = "HZ")]
    pub rate: f64,
    /// Screen size, pixels
    #[arg(long, value_parser = parse_size, default_value = "1920x1080", value_name = "WxH", conflicts_with = "head")]
    pub screen: [u32; 2],
    /// Horizontal field of view of the screen, degrees
    #[arg(long, default_value_t = 70.0, value_name = "DEG", conflicts_with = "head")]
    pub hfov: f32,
    /// Head and eye together, as in a headset: somebody who looks around in a room of 6x3x12 meters
    #[arg(long)]
    pub head: bool,
    /// With --head: walking, 0.9 m/s forwards for 3 s, then back
    #[arg(long, requires = "head")]
    pub walk: bool,
    /// With --head: share of the gaze shifts that end on a thing that moves and is pursued, 0 to 1
    #[arg(long, default_value_t = 0.0, requires = "head", value_name = "SHARE")]
    pub pursuits: f64,
    /// Seed of the random numbers: same seed, same scanpath
    #[arg(long, default_value_t = 0, value_name = "N")]
    pub seed: u64,
    /// File to write
    #[arg(long, value_name = "FILE.csv")]
    pub out: PathBuf,
}

/// Values of `--from`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum From {
    /// Found out by the file's columns.
    Auto,
    /// The export of a vendor.
    Of(Vendor),
}

impl Named for From {
    fn rows() -> Vec<(Self, &'static str, &'static str)> {
        let text = |vendor| match vendor {
            Vendor::Tobii => "Tobii Pro Lab, Tobii Studio, Tobii Pro SDK",
            Vendor::Pupil => "Pupil Core: gaze_positions.csv, also of a surface",
            Vendor::Neon => "Neon and Pupil Invisible: gaze.csv, also of Pupil Cloud's mappers",
            Vendor::Gazepoint => "Gazepoint Analysis: all_gaze.csv",
            Vendor::Varjo => "Varjo Base: varjo_gaze_output",
            Vendor::Sranipal => "Vive Pro Eye with SRanipal: gaze_direct_L.x ...",
            Vendor::Eyelink => "EyeLink: ASC text, sample report",
            Vendor::Webgazer => "WebGazer: x, y in pixels of the page, t in milliseconds",
        };
        let vendors = Vendor::ALL.into_iter().map(|vendor| (Self::Of(vendor), vendor.name(), text(vendor)));
        [(Self::Auto, "auto", "Found out by the columns")].into_iter().chain(vendors).collect()
    }
}

/// The subcommand.
pub fn scanpath(args: &ScanpathArgs) -> Result<(), Failure> {
    if let Some(file) = &args.file {
        return converted(args, file);
    }
    args.log.refuse_for("a generated scanpath")?;
    let (path, events) = if args.head { with_head(args)? } else { on_screen(args)? };
    let count = |kind| events.iter().filter(|e| e.kind == kind).count();
    let summary = format!(
        "{} s, {} fixations, {} saccades, {} microsaccades",
        args.seconds,
        count(EventKind::Fixation),
        count(EventKind::Saccade),
        count(EventKind::Microsaccade)
    );
    write(args, &path, &summary)
}

/// Converts a gaze log.
fn converted(args: &ScanpathArgs, file: &str) -> Result<(), Failure> {
    let from = match args.from {
        From::Auto => None,
        From::Of(vendor) => Some(vendor),
    };
    let log = args.log.read(file, from)?;
    warn(&log.warnings);
    let summary = format!(
        "{:.3} s, {} samples ({} lost), from {}",
        log.scanpath.duration_s(),
        log.scanpath.samples().len(),
        log.scanpath.lost(),
        log.vendor.map_or("a scanpath", Vendor::name)
    );
    write(args, &log.scanpath, &summary)
}

fn write(args: &ScanpathArgs, path: &Scanpath, summary: &str) -> Result<(), Failure> {
    use std::io::ErrorKind;
    let out = args.out.display();
    write_whole(&args.out, |file| write_csv(path, file)).map_err(|e| match e.kind() {
        ErrorKind::StorageFull | ErrorKind::BrokenPipe | ErrorKind::WriteZero => Failure::writing(&args.out, e),
        _ => {
            Failure::Input(format!("{out}: cannot be written ({e}); give --out a file in a folder that can be written"))
        }
    })?;
    // Not between the rows of the scanpath.
    if is_stdout(&args.out) {
        eprintln!("{out}: {summary}")
    } else {
        say!("{out}: {summary}")
    }
    Ok(())
}

/// Whether a path names the file, pipe or terminal that this program's output goes to.
#[cfg(unix)]
fn is_stdout(path: &Path) -> bool {
    use std::os::fd::AsFd;
    use std::os::unix::fs::MetadataExt;
    let stdout = std::io::stdout().as_fd().try_clone_to_owned().and_then(|fd| File::from(fd).metadata());
    let same = |a: Metadata, b: Metadata| (a.dev(), a.ino()) == (b.dev(), b.ino());
    stdout.and_then(|stdout| Ok(same(stdout, path.metadata()?))).unwrap_or(false)
}

#[cfg(not(unix))]
fn is_stdout(_: &Path) -> bool {
    false
}

fn on_screen(args: &ScanpathArgs) -> Result<(Scanpath, Vec<Event>), Failure> {
    let view = afterimage::ViewGeometry::flat(args.screen, args.hfov)?;
    let options = SyntheticOptions {
        seed: args.seed,
        duration_s: args.seconds,
        rate_hz: args.rate,
        screen: Screen::of_view(&view),
    };
    let made = generate(&options)?;
    Ok((made.path, made.events))
}

fn with_head(args: &ScanpathArgs) -> Result<(Scanpath, Vec<Event>), Failure> {
    let options = HeadOptions {
        seed: args.seed,
        duration_s: args.seconds,
        rate_hz: args.rate,
        is_walking: args.walk,
        pursuits: args.pursuits,
        ..HeadOptions::default()
    };
    let made = generate_head(&options, &in_a_room)?;
    Ok((made.path, made.events))
}
