//! `cargo research`: experiments, one file each. The head of each says which page of `docs/` it makes.

#[macro_use]
extern crate afterimage_program;

mod effects;
mod growth;
mod isa;
mod options;
mod papers;
mod parts;
mod patterns;
mod planned_smr;
mod safeguards;
mod saved_time;
mod wrs_readings;
mod wrs_table;

use afterimage_program::failure::Failure;
use afterimage_trace::measure::ROUNDS;
use clap::{Parser, Subcommand};
use options::{EffectsArgs, TracedArgs, WrsTableArgs};
use std::process::ExitCode;

/// Experiments whose tables are in docs/
#[derive(Parser)]
#[command(name = "research", version, max_term_width = 110)]
struct Cli {
    #[command(subcommand)]
    experiment: Experiment,
}

#[derive(Subcommand)]
enum Experiment {
    Effects(EffectsArgs),
    /// What of the samples that foveated path tracing saves becomes saved time: one path a lattice point, regions 8,4,2
    /// and 32,16,8
    Foveated(TracedArgs),
    Growth(growth::GrowthArgs),
    Isa(isa::IsaArgs),
    /// Foveated and uniform path tracing, as measured in two papers: Markdown tables with their results, ours, and
    /// those of planned frames
    Papers(TracedArgs),
    Patterns(Box<patterns::PatternsArgs>),
    Safeguards(safeguards::SafeguardsArgs),
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
    }
}
