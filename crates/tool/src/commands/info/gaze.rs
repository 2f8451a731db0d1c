//! `afterimage info` of a gaze log: a scanpath, or an eye tracker's export.

use crate::args::gaze_log::GazeLogArgs;
use crate::failure::{Failure, with_options};
use afterimage_lab::scanpath::GazeMap;
use afterimage_lab::source::other_kind;
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// Endings of gaze logs, in lower case.
const ENDINGS: [&str; 4] = ["csv", "tsv", "txt", "asc"];
/// Endings of other inputs, in lower case.
const OTHERS: [&str; 7] = ["gltf", "glb", "exr", "png", "jpg", "jpeg", "json"];
/// Bytes of a file with another ending that tell whether it is text.
const LOOKED_AT: u64 = 4096;

/// Whether an input is a gaze log: by its ending, or, if that says nothing, because it is a file of text.
pub fn is_log(input: &str) -> bool {
    let ending = Path::new(input).extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default();
    if ENDINGS.contains(&ending.as_str()) {
        return true;
    }
    if other_kind(Path::new(input)).is_some() {
        return false;
    }
    let mut bytes = vec![];
    let mut is_read = || File::open(input).and_then(|file| file.take(LOOKED_AT).read_to_end(&mut bytes)).is_ok();
    !OTHERS.contains(&ending.as_str()) && Path::new(input).is_file() && is_read() && is_text(&bytes)
}

fn is_text(bytes: &[u8]) -> bool {
    let is_cut_character = |e: std::str::Utf8Error| e.error_len().is_none();
    !bytes.is_empty() && !bytes.contains(&0) && std::str::from_utf8(bytes).map_or_else(is_cut_character, |_| true)
}

/// Describes a gaze log.
pub fn gaze_info(path: &str, args: &GazeLogArgs) -> Result<(), Failure> {
    let log = args.read(path, None)?;
    let scanpath = &log.scanpath;
    let screen = scanpath.screen();
    let from =
        log.vendor.map_or(String::new(), |vendor| format!(", an export of an eye tracker (--from {})", vendor.name()));
    say!("scanpath of {:.3} s{from}", scanpath.duration_s());
    say!("samples: {} ({} lost)", scanpath.samples().len(), scanpath.lost());
    if scanpath.poses().is_some() {
        say!("head: a pose at every sample; use it with --camera head");
    }
    say!("screen: {}x{} px", screen.size_px[0], screen.size_px[1]);
    match (screen.size_cm, screen.distance_cm) {
        (Some([w, h]), Some(d)) => say!("geometry: {w}x{h} cm seen from {d} cm"),
        _ => say!("geometry: not known"),
    }
    let map = match GazeMap::default_for(screen) {
        GazeMap::Angle => "angle",
        GazeMap::Fit => "fit",
    };
    say!("default --gaze-map: {map}");
    if let Some(task) = &scanpath.about().task {
        say!("task: {task}");
    }
    for (key, value) in &scanpath.about().notes {
        say!("{key}: {value}");
    }
    for warning in &log.warnings {
        say!("warning: {}", with_options(warning));
    }
    Ok(())
}
