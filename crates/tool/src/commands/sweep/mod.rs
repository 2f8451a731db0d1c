//! `afterimage sweep`: error against time over a grid of methods and options.

mod batch;
mod measure;
mod pick;
mod plan;
mod report;

use crate::args::input::InputArgs;
use crate::failure::Failure;
use crate::progress;
use crate::sweep::plan::MAX_POINTS;
use crate::sweep::{Measurement, Options, Store, Table};
use afterimage_lab::source::is_scene;
use afterimage_lab::source::viewed_scene::DEFAULT_SIZE;
use batch::{Batch, batches, concerns, is_random};
use clap::{Args, FromArgMatches};
use pick::PickArgs;
use plan::PresetName;
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::path::PathBuf;

/// Measure a grid of methods and options: error against time, and what each switch costs
#[derive(Args, Clone, Debug)]
#[command(after_help = "Examples:\n  \
    afterimage sweep frames/ --preset quick --gaze viewing.csv --out out/sweep\n  \
    afterimage sweep frames/ --axis method=none,wrs,smr --axis fovea=5,10 --switch no-gate --frames 96 --out out/sweep\n  \
    afterimage sweep --out out/sweep --budget-ms 20\n\n\
    Writes OUT/report.html (open it), sweep.csv, sweep.json, pareto.svg and pareto.png. Finished points are in OUT/points: run the same command\n\
    again to resume a sweep. Example of a plan (--file) in TOML:\n\n  \
    seeds = 3\n  [common]\n  frames = 96\n  [axes]\n  method = [\"none\", \"smr\"]\n  \"rate-mid+rate-far\" = [\"4+8\", \"8+16\"]\n  \
    [switches]\n  of = [\"no-depth-test\", \"smr-tolerance=2\"]")]
pub struct SweepArgs {
    /// Stills, folders of .exr frames, scenes, analytic:NAME, as for run; without inputs, only report the points in OUT
    pub input: Vec<String>,
    /// Output folder, and the folder of a sweep to resume
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
    /// Predefined plan; default: quick, unless --file or --axis is given
    #[arg(long, value_enum)]
    pub preset: Option<PresetName>,
    /// Plan in TOML, see below
    #[arg(long, value_name = "FILE.toml")]
    pub file: Option<PathBuf>,
    /// An option of run and its values; every combination of the axes is measured. NAME=V,V; options that vary
    /// together: N+N=V+V,V+V; values that contain commas: NAME=V;V; flags: NAME=-,on; the value - leaves any option out
    #[arg(long, value_name = "NAME=VALUES")]
    pub axis: Vec<String>,
    /// An option of run to change alone, with the first value of each axis but the method: NAME or NAME=VALUE
    #[arg(long, value_name = "NAME[=VALUE]")]
    pub switch: Vec<String>,
    /// Another option of run, the same for all points: NAME or NAME=VALUE
    #[arg(long, value_name = "NAME[=VALUE]")]
    pub set: Vec<String>,
    /// Frames of each point, at least 38: 8 to warm up and 30 timed
    #[arg(long, value_name = "N")]
    pub frames: Option<u64>,
    /// Scanpath, export of an eye tracker, fixed pixel, or synthetic[:SEED], as for run
    #[arg(long, value_name = "GAZE", allow_hyphen_values = true)]
    pub gaze: Option<String>,
    /// Screen of a gaze log, pixels, as for run
    #[arg(long, value_name = "WxH")]
    pub screen_px: Option<String>,
    /// Screen of a gaze log, millimeters, as for run
    #[arg(long, value_name = "WxH")]
    pub screen_mm: Option<String>,
    /// Distance of the screen of a gaze log, millimeters, as for run
    #[arg(long, value_name = "D")]
    pub distance_mm: Option<String>,
    /// Gaze of a log with both eyes, as for run
    #[arg(long, value_name = "NAME")]
    pub eye: Option<String>,
    /// Start time in the scanpath, seconds
    #[arg(long, value_name = "S")]
    pub start: Option<f64>,
    /// Size of scenes, pixels
    #[arg(long, value_name = "WxH")]
    pub size: Option<String>,
    /// Renderer of scenes: raster or trace
    #[arg(long, value_name = "NAME")]
    pub source: Option<String>,
    /// Camera of scenes, as for run
    #[arg(long, value_name = "NAME|FILE.json")]
    pub camera: Option<String>,
    /// Device that runs the methods: auto, cpu or gpu
    #[arg(long, value_name = "NAME")]
    pub backend: Option<String>,
    /// Luminance of the display's white for JOD, cd/m2, as for run
    #[arg(long, value_name = "CD_M2")]
    pub display_peak: Option<String>,
    /// Contrast of the display for JOD, as for run
    #[arg(long, value_name = "RATIO")]
    pub display_contrast: Option<String>,
    /// Light of the room on the display for JOD, lux, as for run
    #[arg(long, value_name = "LUX")]
    pub display_ambient: Option<String>,
    /// Repetitions of randomized methods, each with another seed; default: the plan's, else 1
    #[arg(long, value_name = "N")]
    pub seeds: Option<u64>,
    /// Measure part I of N, 1/N to N/N, to share a sweep between machines; see --merge
    #[arg(long, value_name = "I/N", value_parser = parse_shard)]
    pub shard: Option<(u64, u64)>,
    /// Folders of a sweep's parts to merge into OUT
    #[arg(long, value_name = "DIR", num_args = 1.., conflicts_with = "input")]
    pub merge: Vec<PathBuf>,
    #[command(flatten)]
    pub pick: PickArgs,
}

impl SweepArgs {
    /// Options of `run` for all points, from the command line.
    fn common(&self) -> Result<Options, Failure> {
        let mut common = Options::new();
        let given = [
            ("frames", self.frames.map(|v| v.to_string())),
            ("gaze", self.gaze.clone()),
            ("screen-px", self.screen_px.clone()),
            ("screen-mm", self.screen_mm.clone()),
            ("distance-mm", self.distance_mm.clone()),
            ("eye", self.eye.clone()),
            ("start", self.start.map(|v| v.to_string())),
            ("size", self.size.clone()),
            ("source", self.source.clone()),
            ("camera", self.camera.clone()),
            ("backend", self.backend.clone()),
            ("display-peak", self.display_peak.clone()),
            ("display-contrast", self.display_contrast.clone()),
            ("display-ambient", self.display_ambient.clone()),
        ];
        for (name, value) in given {
            common.extend(value.map(|value| (name.to_owned(), value)));
        }
        for text in &self.set {
            match crate::sweep::grid::parse_switch(text) {
                (name, Some(value)) if !name.is_empty() => common.insert(name, value),
                _ => return Err(Failure::Input(format!("--set {text}: expected NAME or NAME=VALUE"))),
            };
        }
        Ok(common)
    }
}

/// `I/N`.
fn parse_shard(text: &str) -> Result<(u64, u64), String> {
    let expected = "expected I/N with 1 <= I <= N, such as 2/8";
    let (part, parts) = text.split_once('/').ok_or(expected)?;
    match (part.parse(), parts.parse()) {
        (Ok(part), Ok(parts)) if 1 <= part && part <= parts => Ok((part, parts)),
        _ => Err(expected.into()),
    }
}

/// The subcommand.
pub fn sweep(args: &SweepArgs) -> Result<(), Failure> {
    match execute(args)? {
        Some(table) => pick::print(&args.pick, &table),
        None => Ok(()),
    }
}

/// As the subcommand with these options; returns the table, `None` without points.
pub fn sweep_table(options: &[&str]) -> Result<Option<Table>, Failure> {
    let command = SweepArgs::augment_args(clap::Command::new("sweep").no_binary_name(true));
    let args = command.try_get_matches_from(options).and_then(|matches| SweepArgs::from_arg_matches(&matches));
    execute(&args.map_err(|e| Failure::usage(&e))?)
}

/// Measures missing points and writes the report; `None` without points.
fn execute(args: &SweepArgs) -> Result<Option<Table>, Failure> {
    let store = if !args.merge.is_empty() {
        merge(args)?
    } else if args.input.is_empty() {
        Store::open(&args.out)?
    } else {
        run(args)?
    };
    let measurements = store.load()?;
    if measurements.is_empty() {
        say!("no points in {} yet", args.out.display());
        return Ok(None);
    }
    let table = report::write(args, &store, &measurements)?;
    report::print_summary(args, &table);
    Ok(Some(table))
}

/// Measures the points that are missing.
fn run(args: &SweepArgs) -> Result<Store, Failure> {
    let plan = plan::plan(args)?;
    let common = plan.common.clone();
    let points = plan
        .grid
        .points(&args.input, plan.seeds, concerns, |method, options| is_random(method, options.iter().chain(&common)));
    // Open an input once for all points with the same size.
    let mut known: BTreeMap<(String, Option<[u32; 2]>), u64> = BTreeMap::new();
    let batches = batches(points, &common, |args| match known.entry((args.name.clone(), args.size)) {
        Entry::Occupied(known) => Ok(*known.get()),
        Entry::Vacant(new) => Ok(*new.insert(pixels(args)?)),
    })?;
    let points: usize = batches.iter().map(|b| b.subjects.len()).sum();
    if points == 0 || points > MAX_POINTS {
        return Err(Failure::Input(format!("the plan has {points} points; expected 1 to {}", MAX_POINTS)));
    }
    batches.iter().flat_map(|b| &b.subjects).try_for_each(measure::check)?;
    let store = Store::create(&args.out)?;
    let done = store.load()?;
    refuse_another_sweep(args, &done, &batches, &common)?;
    let is_done = |b: &Batch| b.subjects.iter().all(|s| done.iter().any(|m| m.point == s.point));
    let is_ours = |i: usize| args.shard.is_none_or(|(part, parts)| i as u64 % parts == part - 1);
    let pending: Vec<&Batch> =
        batches.iter().enumerate().filter(|(i, b)| is_ours(*i) && !is_done(b)).map(|(_, b)| b).collect();
    let left: usize = pending.iter().map(|b| b.subjects.len()).sum();
    say!("{points} points, {left} to measure in {} rounds", pending.len());
    let bar = progress::bar(pending.iter().map(|b| measure::work(b)).sum(), "{percent} %");
    for batch in pending {
        measure::measure(batch, &common, &store, &bar)?;
    }
    bar.finish_and_clear();
    Ok(store)
}

/// Refuses a folder whose points come from other common options, another version or another machine: they are not
/// comparable.
fn refuse_another_sweep(
    args: &SweepArgs,
    done: &[Measurement],
    batches: &[Batch],
    common: &Options,
) -> Result<(), Failure> {
    let Some(before) = done.first() else { return Ok(()) };
    let machine = measure::machine(&batches[0].subjects[0].args.backend.open()?);
    let differs = if before.common != *common {
        format!("was made with {:?}, not {:?}", before.common, common)
    } else if before.version != env!("CARGO_PKG_VERSION") {
        format!("was made by version {}", before.version)
    } else if before.machine != machine {
        format!(
            "was made on {} ({}), not {} ({})",
            before.machine.name, before.machine.driver, machine.name, machine.driver
        )
    } else {
        return Ok(());
    };
    Err(Failure::Input(format!("{}: holds a sweep that {differs}; give --out another folder", args.out.display())))
}

/// Copies measurements and pictures of the parts into one folder.
fn merge(args: &SweepArgs) -> Result<Store, Failure> {
    let parts = args.merge.iter().map(|dir| Store::open(dir)).collect::<Result<Vec<_>, _>>()?;
    let store = Store::create(&args.out)?;
    let mut first = store.load()?.into_iter().next();
    for part in &parts {
        for measurement in part.load()? {
            let first = first.get_or_insert_with(|| measurement.clone());
            if (&first.common, &first.version) != (&measurement.common, &measurement.version) {
                return Err(Failure::Input(format!(
                    "{}: is part of another sweep ({:?}, version {}); expected {:?}, version {}",
                    part.root().display(),
                    measurement.common,
                    measurement.version,
                    first.common,
                    first.version
                )));
            }
            store.adopt(part, &measurement.point).map_err(|e| Failure::writing(store.root(), e))?;
        }
    }
    Ok(store)
}

/// Pixels per frame. Fails for files that cannot be opened, before anything is measured; scenes are opened later.
fn pixels(args: &InputArgs) -> Result<u64, Failure> {
    let of = |size: [u32; 2]| u64::from(size[0]) * u64::from(size[1]);
    if is_scene(&args.name) {
        return Ok(of(args.size.unwrap_or(DEFAULT_SIZE)));
    }
    Ok(of(args.read()?.info().size))
}
