//! Kinds of files: by their ending in any case, and by their first bytes where the ending is none that is known.

use std::fs::File;
use std::io::Read;
use std::path::Path;

/// Endings of stills and scenes.
const KNOWN: [&str; 6] = ["exr", "png", "jpg", "jpeg", "gltf", "glb"];

/// Ending of a file of this kind, in lower case and without the dot.
pub(crate) fn kind(path: &Path) -> String {
    let ending = ending(path);
    if KNOWN.contains(&ending.as_str()) || !path.is_file() {
        return ending;
    }
    by_contents(path).map_or(ending, str::to_owned)
}

/// Ending of a name in lower case, without the dot; empty without one.
pub(crate) fn ending(path: &Path) -> String {
    path.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default()
}

fn by_contents(path: &Path) -> Option<&'static str> {
    let mut first = Vec::new();
    File::open(path).ok()?.take(4).read_to_end(&mut first).ok()?;
    match first.as_slice() {
        [0x76, 0x2F, 0x31, 0x01] => Some("exr"),
        [0x89, b'P', b'N', b'G'] => Some("png"),
        [0xFF, 0xD8, 0xFF, _] => Some("jpg"),
        b"glTF" => Some("glb"),
        _ => None,
    }
}
