//! Runs the tool as a process in a temporary folder.

use afterimage_testing::program::Program;
pub use afterimage_testing::program::{Folder, read_json};
use serde_json::Value;
use std::collections::BTreeMap;
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

/// Small runs without the metric that takes most of their time.
pub const SMALL: &[&str] = &["--size", "160x90", "--frames", "4", "--no-jod"];

/// The arguments of a command line, which has no quotes.
pub fn words(line: &str) -> Vec<&str> {
    line.split_whitespace().collect()
}

pub fn run<'a>(input: &'a str, out: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    [&["run", input, "--out", out][..], more].concat()
}

/// A column of a `frames.csv` by frame; `None` where cells are empty.
pub fn column(folder: &Path, method: &str, name: &str) -> Vec<Option<f64>> {
    let csv = fs::read_to_string(folder.join("frames.csv")).unwrap();
    let mut lines = csv.lines();
    let place = lines.next().unwrap().split(',').position(|head| head == name).unwrap();
    let rows = lines.map(|line| line.split(',').collect::<Vec<_>>()).filter(|cells| cells[1] == method);
    rows.map(|cells| cells[place].parse().ok()).collect()
}

/// The numbered frames of a run, by their path in its folder.
fn frames(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut all = BTreeMap::new();
    for name in files(folder) {
        let path = folder.join(&name);
        if path.is_dir() {
            all.extend(frames(&path).into_iter().map(|(file, bytes)| (format!("{name}/{file}"), bytes)));
        } else if name.starts_with(|c: char| c.is_ascii_digit()) {
            all.insert(name, fs::read(path).unwrap());
        }
    }
    all
}

/// Runs on both backends: every frame has the same bytes, and every method the same figures. Returns the reports, the
/// CPU's first.
#[track_caller]
pub fn same_on_both_backends(name: &str, input: &str, more: &[&str]) -> [Value; 2] {
    const FIGURES: [&str; 5] = ["psnr_db", "flushed", "replaced", "nonfinite_in", "bytes_per_pixel"];
    let folder = Folder::new();
    let reports = ["cpu", "gpu"].map(|backend| {
        let rest = ["--backend", backend, "--format", "exr"];
        succeeds(&run(input, &folder.text(backend), &[&rest, more].concat()));
        read_json(&folder.path(backend).join("report.json"))
    });
    if afterimage_testing::gpu::rounds_as_the_cpu() {
        let [cpu, gpu] = ["cpu", "gpu"].map(|backend| frames(&folder.path(backend)));
        assert!(cpu.len() > 1 && cpu.keys().eq(gpu.keys()), "{name}: {:?}", cpu.keys());
        for (file, bytes) in &cpu {
            assert!(gpu[file] == *bytes, "{name}: {file}");
        }
        let [cpu, gpu] = reports.each_ref().map(|report| &report["methods"]);
        for (method, figures) in cpu.as_object().unwrap() {
            for key in FIGURES {
                assert_eq!(figures[key], gpu[method][key], "{name}: {method}.{key}");
            }
        }
    }
    reports
}
