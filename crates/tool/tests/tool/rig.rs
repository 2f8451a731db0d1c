//! Runs the tool as a process in a temporary folder.

use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

pub fn tool(args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_afterimage"))
        .args(args)
        // Silences a message of Mesa about windows.
        .env("NODEVICE_SELECT", "1")
        .current_dir(afterimage_testing::workspace())
        .output()
        .expect("the tool starts")
}

#[track_caller]
pub fn succeeds(args: &[&str]) -> String {
    let output = tool(args);
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{args:?}: {stderr}");
    assert!(stderr.is_empty(), "nothing on stderr when it is no terminal: {stderr}");
    String::from_utf8(output.stdout).unwrap()
}

/// Checks for an error in one line that contains `words`, exit code 2, and no panic.
#[track_caller]
pub fn refuses(args: &[&str], words: &[&str]) -> String {
    let output = tool(args);
    let stderr = String::from_utf8_lossy(&output.stderr).into_owned();
    println!("{}", stderr.trim_end());
    assert_eq!(output.status.code(), Some(2), "{args:?}: {stderr}");
    assert_eq!(stderr.lines().count(), 1, "one line: {stderr}");
    assert!(output.stdout.is_empty());
    for word in words {
        assert!(stderr.contains(word), "'{word}' is missing: {stderr}");
    }
    stderr
}

pub fn read_json(path: &Path) -> Value {
    serde_json::from_str(&fs::read_to_string(path).unwrap()).unwrap()
}

pub fn files(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

pub struct Folder(tempfile::TempDir);

impl Folder {
    pub fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub fn text(&self, name: &str) -> String {
        self.path(name).to_str().unwrap().to_owned()
    }

    pub fn write(&self, name: &str, bytes: &[u8]) -> String {
        fs::write(self.path(name), bytes).unwrap();
        self.text(name)
    }
}

pub const DEBUG: &str = "weight,age,survival,flush,gate,motion";

pub const SMALL: &[&str] = &["--size", "160x90", "--frames", "4"];

pub fn run<'a>(input: &'a str, out: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    [&["run", input, "--out", out][..], more].concat()
}
