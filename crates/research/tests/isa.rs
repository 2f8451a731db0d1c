//! Cycles of the passes are those of docs/cycles.tsv, within 3 %. `AFTERIMAGE_BLESS=1` rewrites the file.

use std::process::Command;

#[test]
fn cycles_are_those_of_the_file() {
    let bless = std::env::var_os("AFTERIMAGE_BLESS").is_some();
    let status = Command::new(env!("CARGO_BIN_EXE_afterimage-research"))
        .args(["isa", if bless { "bless" } else { "check" }])
        .status()
        .expect("the program runs");
    assert!(status.success(), "see above");
}
