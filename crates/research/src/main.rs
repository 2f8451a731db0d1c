//! `cargo research`: experiments, one file each. The head of each says which page of `docs/` it makes.

#[macro_use]
extern crate afterimage_program;

mod albedo;
mod antialias;
mod camera_motion;
mod cpu_time;
mod deferred;
mod device_time;
mod effects;
mod error;
mod foreign;
mod gaze_prediction;
mod growth;
mod head_and_eye;
mod isa;
mod jitter;
mod jod_cost;
mod jod_validation;
mod loss_by_class;
mod methods;
mod options;
mod papers;
mod parts;
mod parts_of_wrs;
mod patterns;
mod plan_cost;
mod planned_smr;
mod quads;
mod record_cost;
mod safeguards;
mod saved_time;
mod traced_plan;
mod traversal;
mod two_eyes;
mod worst_crops;
mod wrs_readings;
mod wrs_table;

use afterimage_program::failure::Failure;
use afterimage_trace::measure::ROUNDS;
use clap::{Parser, Subcommand};
use error::AnyError;
use options::{EffectsArgs, TracedArgs, WrsTableArgs};
use std::process::ExitCode;

/// Experiments whose tables are in docs/
#[derive(Parser)]
#[command(name = "research", bin_name = "cargo research", version, max_term_width = 110)]
struct Cli {
    #[command(subcommand)]
    experiment: Experiment,
}

#[derive(Subcommand)]
enum Experiment {
    Albedo(albedo::AlbedoArgs),
    /// Antialiasing of jittered frames, at full rate and planned
    Antialias,
    /// Motion vectors without the camera's motion: none at all, or those of moving objects alone
    CameraMotion,
    CpuTime(cpu_time::CpuTimeArgs),
    Deferred(deferred::DeferredArgs),
    Effects(EffectsArgs),
    Foreign(foreign::ForeignArgs),
    /// What of the samples that foveated path tracing saves becomes saved time: one path a lattice point, regions 8,4,2
    /// and 32,16,8
    Foveated(TracedArgs),
    GazePrediction(gaze_prediction::GazePredictionArgs),
    Growth(growth::GrowthArgs),
    HeadAndEye(head_and_eye::HeadAndEyeArgs),
    Isa(isa::IsaArgs),
    /// Jittered projections, and temporal antialiasing before or after the post-process
    Jitter,
    JodCost(jod_cost::JodCostArgs),
    JodValidation(jod_validation::JodValidationArgs),
    LossByClass(loss_by_class::LossArgs),
    Methods(methods::MethodsArgs),
    /// Foveated and uniform path tracing, as measured in two papers: Markdown tables with their results, ours, and
    /// those of planned frames
    Papers(TracedArgs),
    PartsOfWrs(parts_of_wrs::PartsOfWrsArgs),
    Patterns(Box<patterns::PatternsArgs>),
    /// Plans of frames shaded by quads: what they cost beside the passes of smr, on a device
    PlanCost,
    Quads(quads::QuadsArgs),
    /// CPU time of recording a frame, on a device that does nothing
    RecordCost,
    Safeguards(safeguards::SafeguardsArgs),
    TracedPlan(traced_plan::TracedPlanArgs),
    Traversal(traversal::TraversalArgs),
    /// Two eyes in one `record` against two contexts with an eye each: time, and whether the left eye is equal
    TwoEyes,
    WorstCrops(worst_crops::WorstCropsArgs),
    Wrs(Box<WrsTableArgs>),
}

fn main() -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => return Failure::usage_exit_code(&error),
    };
    Failure::exit_code(run(&cli.experiment))
}

fn run(experiment: &Experiment) -> Result<(), Failure> {
    match experiment {
        Experiment::Effects(args) => {
            let (size, frames) = args.traced.of([192, 108], 30, 30)?;
            effects::bench(args, size, frames)
        }
        Experiment::Foveated(args) => {
            let (size, frames) = args.of([960, 540], ROUNDS, 1)?;
            saved_time::bench(args, size, frames)
        }
        Experiment::Papers(args) => {
            let (size, frames) = args.of([1920, 1080], ROUNDS, 1)?;
            papers::bench(args, size, frames)
        }
        Experiment::Growth(args) => growth::bench(args),
        Experiment::Isa(args) => isa::bench(args),
        Experiment::Patterns(args) => patterns::bench(args),
        Experiment::Safeguards(args) => safeguards::bench(args),
        Experiment::Wrs(args) => wrs_table::bench(args),
        Experiment::Albedo(args) => worked(albedo::bench(args)),
        Experiment::Antialias => worked(antialias::bench()),
        Experiment::CameraMotion => worked(camera_motion::bench()),
        Experiment::CpuTime(args) => worked(cpu_time::bench(args)),
        Experiment::Deferred(args) => worked(deferred::bench(args)),
        Experiment::Foreign(args) => worked(foreign::bench(args)),
        Experiment::GazePrediction(args) => worked(gaze_prediction::bench(args)),
        Experiment::HeadAndEye(args) => worked(head_and_eye::bench(args)),
        Experiment::Jitter => worked(jitter::bench()),
        Experiment::JodCost(args) => worked(jod_cost::bench(args)),
        Experiment::JodValidation(args) => worked(jod_validation::bench(args)),
        Experiment::LossByClass(args) => worked(loss_by_class::bench(args)),
        Experiment::Methods(args) => worked(methods::bench(args)),
        Experiment::PartsOfWrs(args) => worked(parts_of_wrs::bench(args)),
        Experiment::PlanCost => worked(plan_cost::bench()),
        Experiment::Quads(args) => worked(quads::bench(args)),
        Experiment::RecordCost => {
            record_cost::bench();
            Ok(())
        }
        Experiment::TracedPlan(args) => worked(traced_plan::bench(args)),
        Experiment::Traversal(args) => {
            traversal::bench(args);
            Ok(())
        }
        Experiment::TwoEyes => worked(two_eyes::bench()),
        Experiment::WorstCrops(args) => worked(worst_crops::bench(args)),
    }
}

/// An experiment that tells no bad input from failed work.
fn worked(result: Result<(), AnyError>) -> Result<(), Failure> {
    result.map_err(|error| Failure::Work(error.to_string()))
}
