//! The `afterimage` command-line tool: one file per subcommand.

/// Prints a line to stdout. Ignores errors: a closed pipe must not stop the work or cause a panic.
macro_rules! say {
    ($($arg:tt)*) => {{
        use std::io::Write;
        let _ = writeln!(std::io::stdout(), $($arg)*);
    }};
}

mod args;
mod clip;
mod commands;
mod failure;
pub mod method_report;
mod output;
mod progress;
pub mod report;
#[cfg(feature = "full")]
pub mod sweep;
pub mod times;

use clap::{Parser, Subcommand};
use commands::demo;
#[cfg(feature = "view")]
use commands::view;
#[cfg(feature = "full")]
use commands::{bench, info, run, scanpath, sweep as sweep_command, trace};
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
    /// Show the method at work on a built-in scene; needs no file and no GPU
    Demo(demo::DemoArgs),
    /// Foveate frames, run methods on them, score the results
    #[cfg(feature = "full")]
    Run(Box<run::RunArgs>),
    /// Render a scene by path tracing
    #[cfg(feature = "full")]
    Trace(Box<trace::TraceArgs>),
    /// Time passes, tracers and effects
    #[cfg(feature = "full")]
    Bench(bench::BenchArgs),
    /// Measure a grid of methods and options: error against time, and what each switch costs
    #[cfg(feature = "full")]
    Sweep(Box<sweep_command::SweepArgs>),
    /// Write a synthetic scanpath
    #[cfg(feature = "full")]
    Scanpath(scanpath::ScanpathArgs),
    /// Describe an input, or list the adapters
    #[cfg(feature = "full")]
    Info(info::InfoArgs),
    /// Show the methods live in a window; the mouse is the gaze
    #[cfg(feature = "view")]
    View(Box<view::ViewArgs>),
}

/// Entry point: parses the arguments, runs the subcommand, and returns the exit code.
pub fn main() -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => return usage(&error),
    };
    let result = match cli.command {
        Command::Demo(args) => demo::demo(&args),
        #[cfg(feature = "full")]
        Command::Run(args) => run::run(&args),
        #[cfg(feature = "full")]
        Command::Trace(args) => trace::trace(&args),
        #[cfg(feature = "full")]
        Command::Bench(args) => bench::bench(&args),
        #[cfg(feature = "full")]
        Command::Sweep(args) => sweep_command::sweep(&args),
        #[cfg(feature = "full")]
        Command::Scanpath(args) => scanpath::scanpath(&args),
        #[cfg(feature = "full")]
        Command::Info(args) => info::info(&args),
        #[cfg(feature = "view")]
        Command::View(args) => view::view(&args),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.report(),
    }
}

/// Prints help and version; reports a usage error in one line.
fn usage(error: &clap::Error) -> ExitCode {
    if !error.use_stderr() {
        // A closed pipe is no error.
        let _ = error.print();
        return ExitCode::SUCCESS;
    }
    Failure::usage(error).report()
}
