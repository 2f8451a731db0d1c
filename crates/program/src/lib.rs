//! What the command-line programs of [`afterimage`] share: the subcommand [`demo`](mod@demo), which `cargo demo` runs
//! alone, errors with exit codes ([`failure`]), and [`progress`] bars.

/// Prints a line to stdout. Ignores errors: a closed pipe must not stop the work or cause a panic.
#[macro_export]
macro_rules! say {
    ($($arg:tt)*) => {{
        use std::io::Write;
        let _ = writeln!(std::io::stdout(), $($arg)*);
    }};
}

pub mod demo;
pub mod failure;
pub mod progress;
