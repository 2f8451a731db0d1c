//! `afterimage demo`: the method at work on a built-in scene, and in words what to look at.

use crate::failure::Failure;
use crate::run::{RunArgs, execute};
use afterimage::report::tally::MethodReport;
use clap::Args;
use std::path::PathBuf;

/// Show the method at work on a built-in scene; needs no file and no GPU
#[derive(Args, Clone, Debug)]
#[command(after_help = "Example:\n  afterimage demo --out out/demo")]
pub struct DemoArgs {
    /// Folder for everything that is written
    #[arg(long, default_value = "out/demo", value_name = "DIR")]
    pub out: PathBuf,
}

/// The options of `run` that the demo stands for. The clip ends a tenth of a second after a wide saccade: when it is seen best
/// what was kept, and what was not.
const DEMO: &[&str] = &[
    "analytic:still",
    "--size",
    "960x540",
    "--gaze",
    "synthetic:46",
    "--frames",
    "98",
    "--rate-mid",
    "4",
    "--rate-far",
    "8",
    "--method",
    "none,wrs,smr,oracle",
    "--reference",
    "--no-flip",
    "--backend",
    "cpu",
];

/// The subcommand.
pub fn demo(args: &DemoArgs) -> Result<(), Failure> {
    let out = args.out.to_string_lossy();
    let run = RunArgs::from_words(DEMO.iter().copied().chain(["--out", &out]))?;
    say!("afterimage demo: a built-in scene, looked at for 1.6 s by a synthetic eye.");
    say!(
        "It is shown at full rate only within 2.5 degrees of the gaze (the fovea), in 4-pixel blocks to 7.5 degrees and"
    );
    say!("in 8-pixel blocks beyond, as a foveating renderer would. Each method gets the same foveated frames.\n");
    let report = execute(&run)?;
    let find = |name: &str| report.methods.iter().find(|m| m.0 == name).map(|m| &m.1);
    if let (Some(none), Some(wrs), Some(smr), Some(oracle)) = (find("none"), find("wrs"), find("smr"), find("oracle")) {
        explain([none, wrs, smr, oracle]);
    }
    let sheet = args.out.join("sheet.png");
    say!("Look at {}:", sheet.display());
    say!("  top row      the last frame; the yellow circle is where the eye looks, the blue line where it has been");
    say!("  middle row   the error: black is none. Dark trails along the blue line are detail that was kept");
    say!("  bottom row   a close look at the green square, which the eye has left: sharp is kept, blurred is lost");
    say!("Frames: {0}/none, {0}/wrs, {0}/smr, {0}/oracle, {0}/reference; figures: {0}/report.json", args.out.display());
    say!("The same by hand: afterimage run {} --out {}", DEMO.join(" "), args.out.display());
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
    row("oracle: the best that any reuse could show", oracle);
    say!("\"seen before\" is the part outside the fovea that the eye has already seen sharp: what reuse is for.\n");
}
