//! Register of hard cases: a test records which row of the contract it proves, on which side, and what it measured.
//!
//! `crates/testing/tests/stability/` collects the records into docs/stability.csv and docs/stability.md.

use std::fmt::{self, Display};
use std::fs;
use std::path::Path;

/// Side on which a test proves a row.
#[derive(Clone, Copy, Debug)]
pub enum Side {
    Cpu,
    Gpu,
    /// The command-line tool, its files and its output.
    Tool,
}

impl Display for Side {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(match self {
            Self::Cpu => "CPU",
            Self::Gpu => "GPU",
            Self::Tool => "tool",
        })
    }
}

/// `holds!("H08", Cpu, "s = {s:.2}")` records that this test proves row H08 on the CPU, and what it measured. Goes
/// after the assertions, so that a failing test records nothing.
#[macro_export]
macro_rules! holds {
    ($row:literal, $side:ident, $($figure:tt)+) => {
        $crate::hard_case::record(
            $row,
            $crate::hard_case::Side::$side,
            std::any::type_name_of_val(&|| {}),
            &format!($($figure)+),
        )
    };
}

/// Prints the measured text and writes it to the folder named by `AFTERIMAGE_STABILITY`, if set. `closure`: type name
/// of a closure in the test, from which the test's name follows.
pub fn record(row: &str, side: Side, closure: &str, figure: &str) {
    let test = closure.split("::{{closure}}").next().unwrap_or(closure);
    println!("{row} holds ({side}): {figure}");
    assert!(!figure.contains(['\n', '|']), "{row}: the text must fit into one cell of a table");
    let Some(folder) = std::env::var_os("AFTERIMAGE_STABILITY") else { return };
    let file = format!("{row} {side} {}", test.replace("::", "."));
    fs::create_dir_all(&folder).and_then(|()| fs::write(Path::new(&folder).join(file), figure)).unwrap();
}
