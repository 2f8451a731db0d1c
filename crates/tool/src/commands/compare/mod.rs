//! `afterimage compare`: score frames of any renderer against its full-rate frames.

mod inputs;
mod plan;
mod report;
mod score;

use crate::args::print_exposure;
use crate::failure::Failure;
use crate::output::Output;
use crate::progress;
use crate::video::SideBySide;
pub use plan::CompareArgs;
use plan::{Plan, plan};
use std::path::Path;

/// The subcommand.
pub fn compare(args: &CompareArgs) -> Result<(), Failure> {
    let plan = plan(args)?;
    refuse_folder_of_run(&args.out)?;
    print_exposure(&plan.exposure);
    let mut video = start_video(args, &plan)?;
    let out = Output::create(&args.out, &[], &report::FILES)?;
    let bar = progress::of_frames(plan.frames as u64);
    let results = score::score(&plan, args.nonfinite_as_black, &out, video.as_mut(), &bar)?;
    bar.finish_and_clear();
    video.map_or(Ok(()), SideBySide::finish)?;
    report::write(args, &plan, &results, &out)?;
    out.finish()?;
    report::print(args, &plan, &results);
    Ok(())
}

/// Starts the video of `--video`.
fn start_video(args: &CompareArgs, plan: &Plan) -> Result<Option<SideBySide>, Failure> {
    let Some(path) = &args.video else { return Ok(None) };
    let names = plan.inputs.tests.iter().map(|(name, _)| name.as_str());
    SideBySide::create(path, ["reference"].into_iter().chain(names), plan.inputs.size(), plan.fps).map(Some)
}

/// Refuses to write over the report of a run.
fn refuse_folder_of_run(out: &Path) -> Result<(), Failure> {
    if inputs::is_of_run(out) {
        let out = out.display();
        return Err(Failure::Input(format!("--out {out}: holds report.json of a run; give another folder")));
    }
    Ok(())
}
