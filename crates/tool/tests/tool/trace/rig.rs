//! Runs the tool as a process and reads a trace's files.

use crate::rig::{self, Folder, read_json, succeeds};
use afterimage_lab::source::{FrameSource, ReadLimits, StillSource};
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};

/// Traces into a fresh folder.
pub struct Traced {
    folder: Folder,
    pub stdout: String,
}

impl Traced {
    #[track_caller]
    pub fn new(scene: &str, more: &[&str]) -> Self {
        Self::with_spp(scene, "2", more)
    }

    #[track_caller]
    pub fn with_spp(scene: &str, spp: &str, more: &[&str]) -> Self {
        let folder = Folder::new();
        let small = ["--size", "24x16", "--spp", spp, "--backend", "cpu"];
        let stdout = succeeds(&[&["trace", scene, "--out", &folder.text("out")][..], &small, more].concat());
        Self { folder, stdout }
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path("out").join(name)
    }

    pub fn report(&self) -> Value {
        read_json(&self.path("trace.json"))
    }

    pub fn bytes(&self, name: &str) -> Vec<u8> {
        fs::read(self.path(name)).unwrap()
    }

    pub fn files(&self, name: &str) -> Vec<String> {
        rig::files(&self.path(name))
    }
}

/// Checks that `trace` refuses in one line that contains `words`, and writes nothing.
#[track_caller]
pub fn refuses(scene: &str, more: &[&str], words: &[&str]) {
    let folder = Folder::new();
    rig::refuses(&[&["trace", scene, "--out", &folder.text("out")][..], more].concat(), words);
    assert!(!folder.path("out/trace.json").exists());
}

pub fn picture(path: &Path) -> afterimage::Image<[f32; 3]> {
    StillSource::open(path, &ReadLimits::default()).unwrap().frame(0).unwrap().color
}
