//! The program `afterimage`.

use std::process::ExitCode;

fn main() -> ExitCode {
    afterimage_cli::main()
}
