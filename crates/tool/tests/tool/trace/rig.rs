//! Runs the tool as a process and reads a trace's files.

use afterimage_lab::source::{FrameSource, ReadLimits, StillSource};
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

pub fn trace(args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_afterimage"))
        .arg("trace")
        .args(args)
        // Silences a message of Mesa about windows.
        .env("NODEVICE_SELECT", "1")
        .current_dir(afterimage_testing::workspace())
        .output()
        .expect("the tool starts")
}

pub const SMALL: [&str; 6] = ["--size", "24x16", "--spp", "2", "--backend", "cpu"];

/// Traces into a fresh folder.
pub struct Traced {
    folder: tempfile::TempDir,
    pub stdout: String,
}

impl Traced {
    #[track_caller]
    pub fn new(scene: &str, more: &[&str]) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("out");
        let output = trace(&[&[scene, "--out", out.to_str().unwrap()][..], &SMALL, more].concat());
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{scene} {more:?}: {stderr}");
        assert!(stderr.is_empty(), "nothing on stderr when it is no terminal: {stderr}");
        Self { folder, stdout: String::from_utf8(output.stdout).unwrap() }
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join("out").join(name)
    }

    pub fn report(&self) -> Value {
        serde_json::from_str(&fs::read_to_string(self.path("trace.json")).unwrap()).unwrap()
    }

    pub fn bytes(&self, name: &str) -> Vec<u8> {
        fs::read(self.path(name)).unwrap()
    }

    pub fn files(&self, name: &str) -> Vec<String> {
        let mut names: Vec<_> =
            fs::read_dir(self.path(name)).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }
}

/// Checks for an error in one line that contains `words`, exit code 2, and no panic.
#[track_caller]
pub fn refuses(scene: &str, more: &[&str], words: &[&str]) {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let output = trace(&[&[scene, "--out", out.to_str().unwrap()][..], more].concat());
    let stderr = String::from_utf8_lossy(&output.stderr).into_owned();
    println!("{}", stderr.trim_end());
    assert_eq!(output.status.code(), Some(2), "{scene} {more:?}: {stderr}");
    assert_eq!(stderr.lines().count(), 1, "one line: {stderr}");
    assert!(output.stdout.is_empty());
    for word in words {
        assert!(stderr.contains(word), "'{word}' is missing: {stderr}");
    }
    assert!(!out.join("trace.json").exists());
}

pub fn picture(path: &Path) -> afterimage::Image<[f32; 3]> {
    StillSource::open(path, &ReadLimits::default()).unwrap().frame(0).unwrap().color
}
