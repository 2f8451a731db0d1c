//! `afterimage demo`: runs the methods on a built-in scene and explains the result.

use crate::failure::Failure;
use crate::progress;
use afterimage::{Foveation, MethodKind, Settings, ViewGeometry};
use afterimage_eval::clip::run_report::{RunFacts, write_report};
use afterimage_eval::clip::{Clip, ClipReport, REPORTS, foveation_words, title, write_png};
use afterimage_eval::exposure::Exposure;
use afterimage_eval::method_report::MethodReport;
use afterimage_eval::output::Output;
use afterimage_eval::pipeline::{Cpu, RunKind};
use afterimage_eval::quad_views::Geometry;
use afterimage_eval::scanpath::{FrameGaze, GazeMap, Screen, SyntheticOptions, generate};
use afterimage_eval::source::{AnalyticSource, FrameSource};
use clap::Args;
use std::path::{Path, PathBuf};

/// Show the method at work on a built-in scene; needs no file and no GPU
#[derive(Args, Clone, Debug)]
#[command(after_help = "Example:\n  afterimage demo --out out/demo")]
pub struct DemoArgs {
    /// Output folder
    #[arg(long, default_value = "out/demo", value_name = "DIR")]
    pub out: PathBuf,
}

/// Arguments of `afterimage run` that give the same result. The clip ends 0.1 s after a wide saccade, when the effect
/// of reuse is easiest to see.
pub const BY_HAND: &str = "analytic:still --size 960x540 --gaze synthetic:46 --frames 98 --rate-mid 4 --rate-far 8 \
    --method none,wrs,smr,oracle --reference --no-flip --no-jod --backend cpu";
const SIZE: [u32; 2] = [960, 540];
const FRAMES: u64 = 98;
const FPS: f32 = 60.0;
const GAZE_SEED: u64 = 46;

/// The clip that `afterimage run` plans for [`BY_HAND`].
fn clip() -> Result<(AnalyticSource, Clip, RunFacts<'static>), Failure> {
    let source = AnalyticSource::new("still", SIZE, 70.0, FPS)?;
    let geometry = *source.view();
    let foveation = Foveation { rate_mid: 4, rate_far: 8, ..Foveation::default() };
    let gaze: Vec<_> = gaze(&geometry)?.collect();
    let facts = RunFacts {
        input: "analytic:still",
        fps: FPS,
        seed: 0,
        simulator: "mip",
        geometry: None,
        scale: None,
        gaze: "synthetic:46",
        gaze_map: "angle",
        start_s: 0.0,
        gaze_latency_ms: 0.0,
        fixed_fovea: false,
    };
    let post_process =
        |method: MethodKind| RunKind::PostProcess(Settings { method: method.into(), ..Settings::default() });
    let clip = Clip {
        title: title(&source.info().name, SIZE, gaze.len(), FPS, &foveation_words(&foveation, facts.simulator)),
        geometry,
        foveation,
        quad_views: None,
        view_geometry: Geometry::Full,
        jitter: false,
        reference_samples: None,
        methods: vec![
            ("none", post_process(MethodKind::None)),
            ("wrs", post_process(MethodKind::Wrs)),
            ("smr", post_process(MethodKind::Smr)),
            ("oracle", RunKind::Oracle),
        ],
        gaze,
        late_gaze: None,
        score_from: 0,
        exposure: Exposure::Stops(0.0),
        write_frame: write_png,
        write_reference: true,
        debug: vec![],
        pixel: None,
        trust: false,
        flip: false,
        jod: false,
        fps: FPS,
        processor: Box::new(Cpu),
        backend_note: "",
    };
    Ok((source, clip, facts))
}

/// Gaze in frame pixels, as `run` plans it.
fn gaze(view: &ViewGeometry) -> Result<impl Iterator<Item = Option<[f32; 2]>>, Failure> {
    let fps = f64::from(FPS);
    let duration_s = FRAMES as f64 / fps + 0.1;
    let screen = Screen::of_view(view);
    let options = SyntheticOptions { seed: GAZE_SEED, duration_s, screen, ..SyntheticOptions::default() };
    let gaze = FrameGaze::new(&generate(&options)?.path, view, GazeMap::Angle, 0.0, fps)?;
    Ok((0..FRAMES).map(move |i| gaze.px(i)))
}

/// Runs the clip and writes its files; prints nothing.
fn execute(out: &Path) -> Result<ClipReport, Failure> {
    let (mut source, clip, facts) = clip()?;
    let folders = clip.methods.iter().map(|l| l.0).chain(["reference"]).map(str::to_owned).collect::<Vec<_>>();
    let playback = clip.start(&mut source)?;
    let out = Output::create(out, &folders, &REPORTS)?;
    let bar = progress::of_frames(FRAMES);
    let report = playback.write(&out, &mut |_| bar.inc(1))?;
    bar.finish_and_clear();
    write_report(&facts, &clip, &report, &out)?;
    out.finish()?;
    Ok(report)
}

/// The subcommand.
pub fn demo(args: &DemoArgs) -> Result<(), Failure> {
    say!("afterimage demo: a built-in scene with 1.6 s of synthetic gaze.");
    say!(
        "Frames are sharp only within 2.5 degrees of the gaze (the fovea), and reduced to 4-pixel blocks up to 7.5 degrees and"
    );
    say!("8-pixel blocks beyond, as a foveating renderer would do. All methods get the same foveated frames.\n");
    let report = execute(&args.out)?;
    say!("{} frames, methods on the {}\n", report.gaze_px.len(), report.backend);
    let find = |name: &str| report.methods.iter().find(|m| m.0 == name).map(|m| &m.1);
    if let (Some(none), Some(wrs), Some(smr), Some(oracle)) = (find("none"), find("wrs"), find("smr"), find("oracle")) {
        explain([none, wrs, smr, oracle]);
    }
    let sheet = args.out.join("sheet.png");
    say!("Look at {}:", sheet.display());
    say!("  top row      the last frame; the yellow circle marks the fovea, the blue line the path of the gaze");
    say!("  middle row   the error, black: none. Dark trails along the blue line are detail kept from earlier frames");
    say!(
        "  bottom row   magnified green square, where the gaze was before: sharp detail was kept, blurred detail was lost"
    );
    say!("Frames: {0}/none, {0}/wrs, {0}/smr, {0}/oracle, {0}/reference; scores: {0}/report.json", args.out.display());
    say!("Equivalent command: afterimage run {} --out {}", BY_HAND, args.out.display());
    Ok(())
}

fn explain([none, wrs, smr, oracle]: [&MethodReport; 4]) {
    let db = |v: Option<f64>| v.map_or("-".into(), |v| format!("{v:.1} dB"));
    let row = |what: &str, m: &MethodReport| {
        let (whole, retained) = (m.scores.whole.psnr_db, m.scores.retained_psnr_db);
        say!("  {what:46} {:>9} {:>12}", db(whole), db(retained));
    };
    say!("  {:46} {:>9} {:>12}", "", "all", "seen before");
    row("none: the foveated frame alone", none);
    row("wrs: weighted reservoirs, the paper's method", wrs);
    row("smr: scale-matched reservoirs, ours", smr);
    row("oracle: upper bound of any reuse", oracle);
    say!("\"seen before\": pixels outside the fovea that were sharp in an earlier frame, where reuse can help.\n");
}
