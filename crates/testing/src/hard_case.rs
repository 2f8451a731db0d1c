//! The register of hard cases: a test says which row of the contract it holds, on which side, and what it measured.
//!
//! `tests/stability` collects what was said into docs/stability.md.

use std::fmt::{self, Display};
use std::fs;
use std::path::Path;

/// Where a row was held.
#[derive(Clone, Copy, Debug)]
pub enum Side {
    Cpu,
    Gpu,
    /// The program, its files and its text.
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

/// `holds!("H08", Cpu, "s = {s:.2}")`: this test holds row H08 on the CPU, and this was measured. Said after the assertions, so that
/// a test that fails says nothing.
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

/// Prints the figure and leaves it in the folder named by `AFTERIMAGE_STABILITY`, if any. `closure` is the name of a closure in the test.
pub fn record(row: &str, side: Side, closure: &str, figure: &str) {
    let test = closure.split("::{{closure}}").next().unwrap_or(closure);
    println!("{row} holds ({side}): {figure}");
    assert!(!figure.contains(['\n', '|']), "{row}: a figure is one cell of a table");
    let Some(folder) = std::env::var_os("AFTERIMAGE_STABILITY") else { return };
    let file = format!("{row} {side} {}", test.replace("::", "."));
    fs::create_dir_all(&folder).and_then(|()| fs::write(Path::new(&folder).join(file), figure)).unwrap();
}
