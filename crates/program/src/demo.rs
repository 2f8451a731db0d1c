//! `afterimage demo`: planned frames of a walk, and the methods on full-size foveated frames; explains the results.

use crate::failure::Failure;
use crate::progress;
use afterimage::internal::{Foveation, Method, MethodKind, Settings};
use afterimage::{Image, ViewGeometry};
use afterimage_eval::clip::run_report::{RunFacts, write_report};
use afterimage_eval::clip::{Clip, ClipReport, REPORTS, foveation_words, title, write_png};
use afterimage_eval::exposure::Exposure;
use afterimage_eval::metric::{self, Display};
use afterimage_eval::output::{Output, WriteError};
use afterimage_eval::picture::write_png as write_picture;
use afterimage_eval::pipeline::{Cpu, RunKind};
use afterimage_eval::quad_views::Geometry;
use afterimage_eval::report::sheet::{Column, Sheet};
use afterimage_eval::scanpath::{FrameGaze, GazeMap, Screen, SyntheticOptions, generate};
use afterimage_eval::source::{AnalyticSource, FrameSource};
use clap::Args;
use std::path::{Path, PathBuf};

/// Show the method at work on built-in scenes; needs no file and no GPU
#[derive(Args, Clone, Debug)]
#[command(after_help = "Example:\n  afterimage demo --out out/demo")]
pub struct DemoArgs {
    /// Output folder
    #[arg(long, default_value = "out/demo", value_name = "DIR")]
    pub out: PathBuf,
}

const FPS: f32 = 60.0;

/// A clip of the demo, as `afterimage run` makes it.
struct Part {
    folder: &'static str,
    scene: &'static str,
    size: [u32; 2],
    frames: u64,
    gaze_seed: u64,
    foveation: Foveation,
    /// Whether the post-process chooses the pixels, of jittered frames.
    is_planned: bool,
    methods: Vec<(&'static str, RunKind)>,
}

impl Part {
    /// A walk of which a share of the pixels is shaded, chosen by the post-process.
    fn planned(folder: &'static str, foveation: Foveation) -> Self {
        let run = |method: Method| RunKind::PostProcess(Settings { method, ..Settings::default() });
        let methods = vec![("none", run(Method::None)), ("smr", run(Settings::screen().method))];
        let (size, frames) = ([480, 270], 36);
        Self { folder, scene: "walk", size, frames, gaze_seed: 46, foveation, is_planned: true, methods }
    }

    /// Full-size frames with levels of detail. The clip ends 0.1 s after a wide saccade, when the effect of reuse is
    /// easiest to see.
    fn levels() -> Self {
        let run = |method: MethodKind| RunKind::PostProcess(Settings { method: method.into(), ..Settings::default() });
        Self {
            folder: "levels",
            scene: "still",
            size: [640, 360],
            frames: 98,
            gaze_seed: 46,
            foveation: Foveation { rate_mid: 4, rate_far: 8, ..Foveation::default() },
            is_planned: false,
            methods: vec![
                ("none", run(MethodKind::None)),
                ("wrs", run(MethodKind::Wrs)),
                ("smr", run(MethodKind::Smr)),
                ("oracle", RunKind::Oracle),
            ],
        }
    }

    /// Arguments of `afterimage run` that give the same result.
    fn by_hand(&self) -> String {
        let Foveation { rate_mid, rate_far, budget, .. } = self.foveation;
        let [width, height] = self.size;
        let planned = match (self.is_planned, self.foveation == Foveation::uniform(0.25)) {
            (false, _) => format!("--rate-mid {rate_mid} --rate-far {rate_far}"),
            (true, true) => "--foveation planned --share 25 --jitter halton --reference-samples 8".into(),
            (true, false) => format!(
                "--foveation planned --rate-mid {rate_mid} --rate-far {rate_far} --budget {} --jitter halton \
                 --reference-samples 8",
                100.0 * budget
            ),
        };
        let methods: Vec<_> = self.methods.iter().map(|method| method.0).collect();
        format!(
            "analytic:{} --size {width}x{height} --frames {} --gaze synthetic:{} {planned} --method {} --reference \
             --no-flip{} --backend cpu",
            self.scene,
            self.frames,
            self.gaze_seed,
            methods.join(","),
            if self.is_planned { "" } else { " --no-jod" },
        )
    }

    /// Gaze in frame pixels, as `run` plans it.
    fn gaze(&self, view: &ViewGeometry) -> Result<Vec<Option<[f32; 2]>>, Failure> {
        let fps = f64::from(FPS);
        let duration_s = self.frames as f64 / fps + 0.1;
        let screen = Screen::of_view(view);
        let options = SyntheticOptions { seed: self.gaze_seed, duration_s, screen, ..SyntheticOptions::default() };
        let gaze = FrameGaze::new(&generate(&options)?.path, view, GazeMap::Angle, 0.0, fps)?;
        Ok((0..self.frames).map(|i| gaze.px(i)).collect())
    }

    fn clip(&self, source: &AnalyticSource, facts: &RunFacts<'_>) -> Result<Clip, Failure> {
        let geometry = *source.view();
        let words = foveation_words(&self.foveation, facts.simulator);
        Ok(Clip {
            title: title(&source.info().name, self.size, self.frames as usize, FPS, &words),
            geometry,
            foveation: self.foveation,
            quad_views: None,
            view_geometry: Geometry::Full,
            jitter: self.is_planned,
            reference_samples: self.is_planned.then_some(8),
            methods: self.methods.clone(),
            gaze: self.gaze(&geometry)?,
            late_gaze: None,
            score_from: 0,
            exposure: Exposure::Stops(0.0),
            write_frame: write_png,
            write_reference: true,
            debug: vec![],
            pixel: None,
            trust: false,
            flip: false,
            jod: self.is_planned,
            display: Display::default(),
            fps: FPS,
            processor: Box::new(Cpu),
            backend_note: "",
        })
    }

    /// Runs the clip and writes its files to a folder of `out`; prints nothing.
    fn execute(&self, out: &Path) -> Result<Shown, Failure> {
        let (input, gaze) = (format!("analytic:{}", self.scene), format!("synthetic:{}", self.gaze_seed));
        let facts = RunFacts {
            input: &input,
            fps: FPS,
            seed: 0,
            simulator: if self.is_planned { "planned" } else { "mip" },
            geometry: None,
            scale: None,
            gaze: &gaze,
            gaze_map: "angle",
            start_s: 0.0,
            gaze_latency_ms: 0.0,
            fixed_fovea: false,
        };
        let mut source = AnalyticSource::new(self.scene, self.size, 70.0, FPS)?;
        let clip = self.clip(&source, &facts)?;
        let folders = clip.methods.iter().map(|l| l.0).chain(["reference"]).map(str::to_owned).collect::<Vec<_>>();
        let playback = clip.start(&mut source)?;
        let out = Output::create(&out.join(self.folder), &folders, &REPORTS)?;
        let bar = progress::of_frames(self.frames);
        let mut last = vec![];
        let report = playback.write(&out, &mut |result| {
            bar.inc(1);
            if result.index as u64 + 1 == self.frames {
                let encode = |image: &Image<[f32; 3]>| metric::encode(image, result.exposure_ev);
                last.push(result.reference.encoded().clone());
                last.extend(result.step.outputs.iter().map(|output| encode(&output.image)));
            }
            Ok(())
        })?;
        bar.finish_and_clear();
        write_report(&facts, &clip, &report, &out)?;
        out.finish()?;
        Ok(Shown { report, geometry: clip.geometry, last })
    }
}

/// Results of a part.
struct Shown {
    report: ClipReport,
    geometry: ViewGeometry,
    /// The last frame: its reference, and what each method shows.
    last: Vec<Image<[f32; 3]>>,
}

impl Shown {
    /// Share of the pixels that smr shaded, in words.
    fn share(&self) -> String {
        let smr = self.report.methods.iter().find(|found| found.0 == "smr");
        let share = smr.and_then(|(_, report)| report.shaded_share).unwrap_or(1.0);
        format!("{:.0} % of the pixels", 100.0 * share)
    }

    /// The last frame of a method as a column of a sheet.
    fn column<'a>(&'a self, name: &'a str, method: &str) -> Column<'a> {
        let methods = &self.report.methods;
        let i = methods.iter().position(|found| found.0 == method).expect("a method of the part");
        Column { name, shown: &self.last[i + 1], scores: Some(methods[i].1.scores), visible_jod: None }
    }

    /// A row of a table: JOD or PSNR of a method's frames.
    fn row(&self, what: &str, method: &str) {
        let Some((_, report)) = self.report.methods.iter().find(|found| found.0 == method) else { return };
        let db = |v: Option<f64>| v.map_or("-".into(), |v| format!("{v:.1} dB"));
        let jod = report.scores.whole.jod.map_or(String::new(), |jod| format!("{jod:.2} JOD"));
        let (whole, retained) = (report.scores.whole.psnr_db, report.scores.retained_psnr_db);
        say!("  {what:52} {jod:>9} {:>9} {:>12}", db(whole), db(retained));
    }
}

/// Writes the sheet of planned frames beside full rate.
fn write_sheet(out: &Path, [everywhere, gaze]: [&Shown; 2]) -> Result<PathBuf, Failure> {
    let full_rate = Column { name: "full rate", shown: &everywhere.last[0], scores: None, visible_jod: None };
    let without = format!("{}, no memory", everywhere.share());
    let with = everywhere.share();
    let around = format!("{}, around the gaze", gaze.share());
    let columns =
        [full_rate, everywhere.column(&without, "none"), everywhere.column(&with, "smr"), gaze.column(&around, "smr")];
    let sheet = Sheet {
        title: "Planned frames: the post-process chooses the pixels that are shaded, and remembers the others".into(),
        columns: &columns,
        geometry: gaze.geometry,
        gaze_px: &gaze.report.gaze_px,
        fovea_deg: Settings::screen().foveation.fovea_deg,
    };
    let path = out.join("sheet.png");
    write_picture(&path, &sheet.draw()).map_err(|problem| WriteError::new(&path, problem))?;
    Ok(path)
}

/// The subcommand.
pub fn demo(args: &DemoArgs) -> Result<(), Failure> {
    let parts = [
        Part::planned("everywhere", Foveation::uniform(0.25)),
        Part::planned("gaze", Settings::screen().foveation),
        Part::levels(),
    ];
    say!("afterimage demo: built-in scenes with synthetic gaze.");
    say!("1. Planned frames of a walk: only some quads of 2x2 pixels are shaded, which the post-process chooses.\n");
    let everywhere = parts[0].execute(&args.out)?;
    let gaze = parts[1].execute(&args.out)?;
    say!("  {:52} {:>9} {:>9} {:>12}", "", "quality", "all", "seen before");
    for (part, place) in [(&everywhere, "everywhere"), (&gaze, "around the gaze")] {
        part.row(&format!("{} {place}, without memory", part.share()), "none");
        part.row(&format!("{} {place}, with memory (smr)", part.share()), "smr");
    }
    say!("JOD: 10 is no difference to full rate that a person would see (docs/metrics.md).\n");
    say!(
        "2. Full-size frames, sharp only within 2.5 degrees of the gaze: 4-pixel blocks up to 7.5 degrees and 8-pixel"
    );
    say!("   blocks beyond, as foveating renderers without a plan draw them. All methods get the same frames.\n");
    let levels = parts[2].execute(&args.out)?;
    levels.row("none: the foveated frame alone", "none");
    levels.row("wrs: weighted reservoirs, the paper's method", "wrs");
    levels.row("smr: scale-matched reservoirs, ours", "smr");
    levels.row("oracle: upper bound of any reuse", "oracle");
    say!("\"seen before\": pixels outside the fovea that were sharp in an earlier frame, where reuse can help.\n");
    let sheet = write_sheet(&args.out, [&everywhere, &gaze])?;
    say!("Look at {} and {}:", sheet.display(), args.out.join("levels/sheet.png").display());
    say!("  top row      the last frame; the yellow circle marks the fovea, the blue line the path of the gaze");
    say!("  middle row   the error, black: none. Dark trails along the blue line are detail kept from earlier frames");
    say!("  bottom row   magnified green square, where the gaze was before");
    say!("Frames of all methods, and scores (report.json), are in everywhere, gaze and levels. The same by hand:");
    for part in &parts {
        say!("  afterimage run {} --out {}", part.by_hand(), args.out.join(part.folder).display());
    }
    Ok(())
}
