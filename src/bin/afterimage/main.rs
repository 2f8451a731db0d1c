//! The `afterimage` command-line tool: one file a subcommand.

/// Prints a line. A reader that has gone (a closed pipe) is no reason to stop working, let alone to panic.
macro_rules! say {
    ($($arg:tt)*) => {{
        use std::io::Write;
        let _ = writeln!(std::io::stdout(), $($arg)*);
    }};
}

mod args;
mod backend;
mod bench;
mod clip;
mod demo;
mod failure;
mod gaze;
mod info;
mod input;
mod output;
mod progress;
mod run;
mod scanpath;
mod sweep;
mod trace;
#[cfg(feature = "view")]
mod view;

use clap::{Parser, Subcommand};
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
    Run(Box<run::RunArgs>),
    /// Render a scene by path tracing
    Trace(Box<trace::TraceArgs>),
    /// Time the passes against a copy of the same bytes
    Bench(bench::BenchArgs),
    /// Measure a grid of methods and options: error against time, and what each switch costs
    Sweep(Box<sweep::SweepArgs>),
    /// Write a synthetic scanpath
    Scanpath(scanpath::ScanpathArgs),
    /// Say what an input holds, or which adapters there are
    Info(info::InfoArgs),
    /// Look at it in a window: the mouse is the gaze
    #[cfg(feature = "view")]
    View(Box<view::ViewArgs>),
}

fn main() -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => return usage(&error),
    };
    let result = match cli.command {
        Command::Demo(args) => demo::demo(&args),
        Command::Run(args) => run::run(&args),
        Command::Trace(args) => trace::trace(&args),
        Command::Bench(args) => bench::bench(&args),
        Command::Sweep(args) => sweep::sweep(&args),
        Command::Scanpath(args) => scanpath::scanpath(&args),
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
