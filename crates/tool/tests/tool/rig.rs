//! Runs the tool as a process in a temporary folder.

use afterimage_testing::program::Program;
pub use afterimage_testing::program::{Folder, read_json};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

pub const TOOL: Program = Program(env!("CARGO_BIN_EXE_afterimage"));

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

/// Starts the tool, and kills it once something has happened, unless it ended before.
pub fn kill_once(args: &[&str], has_happened: impl Fn() -> bool) {
    let mut command = Command::new(TOOL.0);
    command.args(args).current_dir(afterimage_testing::workspace()).stdout(Stdio::null()).stderr(Stdio::null());
    let (mut child, started) = (command.spawn().unwrap(), Instant::now());
    while !has_happened() && child.try_wait().unwrap().is_none() {
        assert!(started.elapsed() < Duration::from_secs(120), "waited in vain");
        std::thread::sleep(Duration::from_millis(2));
    }
    child.kill().unwrap();
    child.wait().unwrap();
}

pub fn files(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

pub const DEBUG: &str = "weight,age,survival,flush,gate,motion";

/// Small runs without the metric that takes most of their time.
pub const SMALL: &str = "--size 160x90 --frames 4 --no-jod";

/// The arguments of a command line, which has no quotes.
pub fn words(line: &str) -> Vec<&str> {
    line.split_whitespace().collect()
}

pub fn run<'a>(input: &'a str, out: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    [&["run", input, "--out", out][..], more].concat()
}

/// What a command wrote to a folder of its own, and what it said.
pub struct Out {
    folder: Folder,
    pub said: String,
}

impl Out {
    /// Runs a command with `--out`; it has to succeed.
    #[track_caller]
    pub fn of(command: &[&str]) -> Self {
        let folder = Folder::new();
        let said = succeeds(&[command, &["--out", &folder.text("out")]].concat());
        Self { folder, said }
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path("out").join(name)
    }

    pub fn files(&self, name: &str) -> Vec<String> {
        files(&self.path(name))
    }

    pub fn bytes(&self, name: &str) -> Vec<u8> {
        fs::read(self.path(name)).unwrap()
    }

    pub fn text(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).unwrap()
    }

    pub fn json(&self, name: &str) -> Value {
        read_json(&self.path(name))
    }

    /// A column of `frames.csv` by frame; `None` where cells are empty.
    pub fn column(&self, method: &str, name: &str) -> Vec<Option<f64>> {
        let csv = self.text("frames.csv");
        let mut lines = csv.lines();
        let place = lines.next().unwrap().split(',').position(|head| head == name).unwrap();
        let rows = lines.map(|line| line.split(',').collect::<Vec<_>>()).filter(|cells| cells[1] == method);
        rows.map(|cells| cells[place].parse().ok()).collect()
    }
}

/// What `afterimage run` wrote with these options.
#[track_caller]
pub fn ran(input: &str, options: &str) -> Out {
    Out::of(&[&["run", input], &words(options)[..]].concat())
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
pub fn same_on_both_backends(input: &str, options: &str) -> [Value; 2] {
    const FIGURES: [&str; 5] = ["psnr_db", "flushed", "replaced", "nonfinite_in", "bytes_per_pixel"];
    let both = ["cpu", "gpu"].map(|backend| ran(input, &format!("--backend {backend} --format exr {options}")));
    let reports = both.each_ref().map(|out| out.json("report.json"));
    if afterimage_testing::gpu::rounds_as_the_cpu() {
        let [cpu, gpu] = both.map(|out| frames(&out.path("")));
        assert!(cpu.len() > 1 && cpu.keys().eq(gpu.keys()), "{options}: {:?}", cpu.keys());
        for (file, bytes) in &cpu {
            assert!(gpu[file] == *bytes, "{options}: {file}");
        }
        let [cpu, gpu] = reports.each_ref().map(|report| &report["methods"]);
        for (method, figures) in cpu.as_object().unwrap() {
            for key in FIGURES {
                assert_eq!(figures[key], gpu[method][key], "{options}: {method}.{key}");
            }
        }
    }
    reports
}
