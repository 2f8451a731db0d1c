//! glTF 2.0 files.
//!
//! The crate `gltf` provides the types of the JSON. Its validation is not used, because it indexes before it checks,
//! and refuses application-specific attributes; here every reference is looked up with a check. Its import is not used
//! either, because it reads any path.

mod accessors;
mod animation;
mod assemble;
mod buffers;
mod container;
mod extensions;
mod images;
mod lobes;
mod materials;
mod mesh;
mod nodes;
mod skins;
mod tangents;
mod uri;
mod uv;
mod viewpoints;
mod warnings;

use super::{Scene, SceneLimits};
use crate::error::InputError;
use gltf::json::{Index, Root};

/// Opens a file with the animation of the name or index `clip`, by default the first.
pub(super) fn open(input: &str, clip: Option<&str>, limits: &SceneLimits) -> Result<Scene, InputError> {
    let file = container::read(input, limits)?;
    let buffers = buffers::load(&file, limits)?;
    let document = Document { subject: input, root: &file.root, buffers: &buffers, limits };
    assemble::scene(&document, &file, clip)
}

/// A parsed file, shared by all parts of the reader.
struct Document<'a> {
    /// Path of the file as the user gave it.
    subject: &'a str,
    root: &'a Root,
    buffers: &'a buffers::Buffers,
    limits: &'a SceneLimits,
}

impl Document<'_> {
    /// The error of a damaged file.
    fn damaged(&self, problem: impl Into<String>) -> InputError {
        damaged(self.subject, problem)
    }

    /// The element that an index refers to, or an error if it is out of range.
    fn look_up<'b, T>(&self, list: &'b [T], index: Index<T>, what: &str) -> Result<&'b T, InputError> {
        let found = list.get(index.value());
        found.ok_or_else(|| self.damaged(format!("it refers to {what} {index} of {}", list.len())))
    }
}

fn damaged(subject: &str, problem: impl Into<String>) -> InputError {
    InputError::invalid(subject, problem, "export the scene again")
}

/// Text from the file, escaped to one line and truncated.
fn printable(name: &str) -> String {
    const LONGEST: usize = 80;
    let mut text: String = name.chars().take(LONGEST).flat_map(char::escape_debug).collect();
    if name.chars().nth(LONGEST).is_some() {
        text.push_str("...");
    }
    text
}

/// Kind, index and, if there is one, name of an object of the file.
fn named(what: &str, index: usize, name: Option<&str>) -> String {
    match name {
        Some(name) if !name.is_empty() => format!("{what} {index} ({})", printable(name)),
        _ => format!("{what} {index}"),
    }
}
