//! Runs the tool as a process in a temporary folder.

use afterimage_testing::program::Program;
pub use afterimage_testing::program::{Folder, read_json};
use std::fs;
use std::path::Path;
use std::process::Output;

const TOOL: Program = Program(env!("CARGO_BIN_EXE_afterimage"));

pub fn tool(args: &[&str]) -> Output {
    TOOL.output(args)
}

#[track_caller]
pub fn succeeds(args: &[&str]) -> String {
    TOOL.succeeds(args)
}

#[track_caller]
pub fn refuses(args: &[&str], words: &[&str]) -> String {
    TOOL.refuses(args, words)
}

pub fn files(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

pub const DEBUG: &str = "weight,age,survival,flush,gate,motion";

pub const SMALL: &[&str] = &["--size", "160x90", "--frames", "4"];

pub fn run<'a>(input: &'a str, out: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    [&["run", input, "--out", out][..], more].concat()
}
