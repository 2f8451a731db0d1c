//! Runs the tool as a process and reads a trace's files.

use crate::rig::{self, Folder, Out, words};
use afterimage_lab::source::{FrameSource, ReadLimits, StillSource};
use std::path::Path;

/// What `trace` wrote with these options.
#[track_caller]
pub fn traced(scene: &str, options: &str) -> Out {
    Out::of(&words(&format!("trace {scene} --size 24x16 --spp 2 --backend cpu {options}")))
}

/// Checks that `trace` refuses in one line that contains `words`, and writes nothing.
#[track_caller]
pub fn refuses(options: &str, said: &[&str]) {
    let folder = Folder::new();
    let line = format!("trace builtin:cornell --out {} {options}", folder.text("out"));
    rig::refuses(&words(&line), said);
    assert!(!folder.path("out/trace.json").exists());
}

pub fn picture(path: &Path) -> afterimage::Image<[f32; 3]> {
    StillSource::open(path, &ReadLimits::default()).unwrap().frame(0).unwrap().color
}
