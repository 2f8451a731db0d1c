//! The container: `.gltf` or `.glb`, its JSON, and the checks of version and required extensions.

use super::errors::{damaged, printable};
use super::warnings::Warnings;
use super::{complete, extensions};
use crate::error::InputError;
use crate::scene::SceneLimits;
use gltf::json::Root;
use serde::Deserialize;
use std::fs::File;
use std::io::Read;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// A file in memory.
pub(super) struct Container {
    /// Path as the user gave it.
    pub subject: String,
    /// Folder of the file.
    pub folder: PathBuf,
    pub root: Root,
    /// The whole file. `binary` is the range of its binary chunk.
    pub bytes: Vec<u8>,
    pub binary: Option<Range<usize>>,
    /// What was left out before the JSON was parsed.
    pub warnings: Warnings,
}

/// Version and required extensions, which are checked before the rest is parsed.
#[derive(Deserialize)]
struct Preamble {
    asset: Asset,
    #[serde(rename = "extensionsRequired")]
    extensions_required: Option<Vec<String>>,
}

#[derive(Deserialize)]
struct Asset {
    version: String,
}

pub(super) fn read(input: &str, limits: &SceneLimits) -> Result<Container, InputError> {
    let path = Path::new(input);
    let bytes = read_file(path, input, limits.max_file_bytes, limits)?;
    let (json, binary) = if bytes.starts_with(b"glTF") { split(input, &bytes)? } else { (0..bytes.len(), None) };
    limits.check_json_bytes(input, json.len() as u64)?;
    let json = without_padding(&bytes[json]);
    if matches!(json, [0xFF, 0xFE, ..] | [0xFE, 0xFF, ..]) {
        return Err(InputError::invalid(input, "is UTF-16 text", "expected UTF-8; save it in this encoding"));
    }
    let unreadable = |problem: String| {
        let problem = format!("is not a glTF 2.0 file: {}", printable(&problem));
        InputError::invalid(input, problem, "expected JSON as the glTF 2.0 specification describes it; export it again")
    };
    let mut value: serde_json::Value = serde_json::from_slice(json).map_err(|e| unreadable(e.to_string()))?;
    let preamble = Preamble::deserialize(&value).map_err(|e| unreadable(e.to_string()))?;
    if !preamble.asset.version.starts_with("2.") {
        let problem = format!("is of glTF version {}", printable(&preamble.asset.version));
        return Err(InputError::not_supported(input, problem, "expected version 2.0; convert it"));
    }
    extensions::check_required(input, preamble.extensions_required.as_deref().unwrap_or_default())?;
    let mut warnings = Warnings::default();
    complete::complete(&mut value, &mut warnings);
    let root = match root(&value) {
        Err(_) if complete::make_plain(&mut value, &mut warnings) => root(&value),
        first => first,
    };
    let root = root.map_err(unreadable)?;
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new(".")).to_owned();
    Ok(Container { subject: input.to_owned(), folder, root, bytes, binary, warnings })
}

/// The description in the crate's types, or what is wrong with it. By way of text: types read from a
/// [`serde_json::Value`] are compiled in this crate, which took a third of its code.
fn root(value: &serde_json::Value) -> Result<Root, String> {
    // The position would be one in that text.
    let without_position = |e: serde_json::Error| {
        let (text, position) = (e.to_string(), format!(" at line {} column {}", e.line(), e.column()));
        text.strip_suffix(&position).unwrap_or(&text).to_owned()
    };
    Root::from_str(&value.to_string()).map_err(without_position)
}

/// JSON without a byte order mark in front, and without the NUL bytes that some writers pad it with.
fn without_padding(json: &[u8]) -> &[u8] {
    let json = json.strip_prefix(b"\xef\xbb\xbf").unwrap_or(json);
    let end = json.iter().rposition(|&byte| byte != 0).map_or(0, |last| last + 1);
    &json[..end]
}

/// Reads a whole file of at most `allowed` bytes. Pipes and devices are refused, because they may be endless.
pub(super) fn read_file(path: &Path, subject: &str, allowed: u64, limits: &SceneLimits) -> Result<Vec<u8>, InputError> {
    let failed = |e: std::io::Error| match e.kind() {
        std::io::ErrorKind::NotFound => InputError::io(subject, "does not exist", "check its name and folder"),
        _ => InputError::io(subject, format!("cannot be read: {e}"), "check its permissions"),
    };
    let metadata = std::fs::metadata(path).map_err(failed)?;
    if !metadata.is_file() {
        return Err(InputError::io(subject, "is not a file", "expected a regular file"));
    }
    let over = |bytes: u64| limits.check_file_bytes(subject, limits.max_file_bytes - allowed + bytes);
    over(metadata.len())?;
    let mut bytes = Vec::new();
    let reserved = bytes.try_reserve_exact(metadata.len() as usize);
    reserved.map_err(|_| {
        InputError::io(subject, format!("its {} bytes do not fit into memory", metadata.len()), "use a smaller scene")
    })?;
    // The file may have grown since.
    let file = File::open(path).map_err(failed)?;
    file.take(allowed.saturating_add(1)).read_to_end(&mut bytes).map_err(failed)?;
    over(bytes.len() as u64)?;
    Ok(bytes)
}

/// Byte ranges of the JSON chunk and of the binary chunk of a `.glb`.
fn split(subject: &str, bytes: &[u8]) -> Result<(Range<usize>, Option<Range<usize>>), InputError> {
    let word = |at: usize| bytes.get(at..at + 4).and_then(|b| b.try_into().ok()).map(u32::from_le_bytes);
    let truncated = || damaged(subject, format!("ends after {} bytes, before its contents do", bytes.len()));
    let version = word(4).ok_or_else(truncated)?;
    if version != 2 {
        return Err(InputError::not_supported(
            subject,
            format!("is a .glb of version {version}"),
            "expected version 2; convert it",
        ));
    }
    let end = word(8).ok_or_else(truncated)? as usize;
    if end > bytes.len() {
        return Err(truncated());
    }
    let mut chunks = Vec::new();
    let mut at = 12;
    // Chunks after the second belong to extensions.
    while at < end && chunks.len() < 2 {
        let length = word(at).ok_or_else(truncated)? as usize;
        let kind = word(at + 4).ok_or_else(truncated)?;
        let start = at + 8;
        if length > end.saturating_sub(start) {
            return Err(truncated());
        }
        chunks.push((kind, start..start + length));
        at = start + length.next_multiple_of(4);
    }
    let mut chunks = chunks.into_iter();
    let json = match chunks.next() {
        Some((kind, range)) if kind == u32::from_le_bytes(*b"JSON") => range,
        _ => return Err(damaged(subject, "has no JSON chunk in front")),
    };
    let binary = chunks.next().filter(|(kind, _)| *kind == u32::from_le_bytes(*b"BIN\0")).map(|(_, range)| range);
    Ok((json, binary))
}
