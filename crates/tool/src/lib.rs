//! The `afterimage` command-line tool: one file per subcommand.

#[macro_use]
extern crate afterimage_program;

// Hidden: for the project's experiments (`crates/research`), and no stable interface.
#[doc(hidden)]
#[allow(
    rustdoc::broken_intra_doc_links,
    rustdoc::invalid_html_tags,
    reason = "help texts: `synthetic[:SEED]` is no link"
)]
pub mod args;
mod commands;
pub mod report;
mod short_help;
pub mod sweep;
mod video;

pub use afterimage_eval::method_report;
#[doc(hidden)]
pub use commands::sweep::sweep_table;

use afterimage_eval::{clip, output};
use afterimage_program::{demo, failure, progress};
use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};
#[cfg(feature = "view")]
use commands::view;
use commands::{bench, compare, info, run, scanpath, sweep as sweep_command, trace};
use failure::Failure;
use std::process::ExitCode;

/// Temporal post-process for foveated rendering: reuse the sharp samples of earlier gaze positions.
#[derive(Parser)]
#[command(name = "afterimage", version, max_term_width = 110)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Show the method at work on built-in scenes; needs no file and no GPU
    Demo(demo::DemoArgs),
    /// Foveate frames, run methods on them, score the results
    Run(Box<run::RunArgs>),
    /// Score frames of any renderer against its full-rate frames
    Compare(Box<compare::CompareArgs>),
    /// Render a scene by path tracing
    Trace(Box<trace::TraceArgs>),
    /// Time the passes, or the path tracer
    Bench(bench::BenchArgs),
    /// Measure a grid of methods and options: error against time, and what each switch costs
    Sweep(Box<sweep_command::SweepArgs>),
    /// Write a synthetic scanpath, or convert a gaze log
    Scanpath(scanpath::ScanpathArgs),
    /// Describe an input, or list the adapters
    Info(info::InfoArgs),
    /// Show the methods live in a window; the mouse is the gaze
    #[cfg(feature = "view")]
    View(Box<view::ViewArgs>),
}

/// Entry point: parses the arguments, runs the subcommand, and returns the exit code.
pub fn main() -> ExitCode {
    let command = short_help::with_short_help(Cli::command());
    let cli = match command.try_get_matches().and_then(|matches| Cli::from_arg_matches(&matches)) {
        Ok(cli) => cli,
        Err(error) => return Failure::usage_exit_code(&error),
    };
    Failure::exit_code(match cli.command {
        Command::Demo(args) => demo::demo(&args),
        Command::Run(args) => run::run(&args),
        Command::Compare(args) => compare::compare(&args),
        Command::Trace(args) => trace::trace(&args),
        Command::Bench(args) => bench::bench(&args),
        Command::Sweep(args) => sweep_command::sweep(&args),
        Command::Scanpath(args) => scanpath::scanpath(&args),
        Command::Info(args) => info::info(&args),
        #[cfg(feature = "view")]
        Command::View(args) => view::view(&args),
    })
}
