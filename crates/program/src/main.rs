//! `cargo demo`: the tool's subcommand `demo` alone, so that only the code that it needs is compiled.

use afterimage_program::demo::{DemoArgs, demo};
use afterimage_program::failure::Failure;
use clap::Parser;
use std::process::ExitCode;

#[derive(Parser)]
#[command(name = "afterimage-demo", version, max_term_width = 110)]
struct Cli {
    #[command(flatten)]
    args: DemoArgs,
}

fn main() -> ExitCode {
    match Cli::try_parse() {
        Ok(cli) => Failure::exit_code(demo(&cli.args)),
        Err(error) => Failure::usage_exit_code(&error),
    }
}
