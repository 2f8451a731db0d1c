//! The `afterimage` command-line tool: one file a subcommand.

/// Prints a line. A reader that has gone (a closed pipe) is no reason to stop working, let alone to panic.
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
mod output;
mod progress;
pub mod report;
#[cfg(feature = "full")]
pub mod sweep;

use clap::{Parser, Subcommand};
use commands::demo;
#[cfg(feature = "view")]
use commands::view;
#[cfg(feature = "full")]
use commands::{bench, info, run, scanpath, sweep as sweep_command, trace};
use failure::Failure;
use std::process::ExitCode;

/// Temporal post-process for foveated rendering: keep the sharp samples that earlier gaze positions paid for.
#[derive(Parser)]
#[command(version, about, max_term_width = 110)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Show the method at work on a built-in scene; needs no file and no GPU
    Demo(demo::DemoArgs),
    /// Foveate a frame stream, enhance it, score it
    #[cfg(feature = "full")]
    Run(Box<run::RunArgs>),
    /// Render a scene by path tracing
    #[cfg(feature = "full")]
    Trace(Box<trace::TraceArgs>),
    /// Time the passes against a copy of the same bytes
    #[cfg(feature = "full")]
    Bench(bench::BenchArgs),
    /// Measure a grid of methods and options: error against time, and what each switch costs
    #[cfg(feature = "full")]
    Sweep(Box<sweep_command::SweepArgs>),
    /// Write a synthetic scanpath
    #[cfg(feature = "full")]
    Scanpath(scanpath::ScanpathArgs),
    /// Say what an input holds, or which adapters there are
    #[cfg(feature = "full")]
    Info(info::InfoArgs),
    /// Look at it in a window: the mouse is the gaze
    #[cfg(feature = "view")]
    View(Box<view::ViewArgs>),
}

/// The program: reads its arguments, does what they ask for, and says how that ended.
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

/// Help and version as they are; an error of usage as one line.
fn usage(error: &clap::Error) -> ExitCode {
    if !error.use_stderr() {
        // Nothing is lost if the reader has gone.
        let _ = error.print();
        return ExitCode::SUCCESS;
    }
    Failure::usage(error).report()
}
