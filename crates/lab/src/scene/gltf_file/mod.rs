//! glTF 2.0 files.
//!
//! The crate `gltf` gives the types of the description. Its own validation is not used, for it indexes before it checks and
//! refuses attributes that applications add; here whatever refers to something is looked up and may be missing. Nor is its
//! import, which reads any path.

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

/// Reads the file with the animation of that name or number, else the first.
pub(super) fn open(input: &str, clip: Option<&str>, limits: &SceneLimits) -> Result<Scene, InputError> {
    let file = container::read(input, limits)?;
    let buffers = buffers::load(&file, limits)?;
    let document = Document { subject: input, root: &file.root, buffers: &buffers, limits };
    assemble::scene(&document, &file, clip)
}

/// What all parts of the reader look at.
struct Document<'a> {
    /// As the user named the file.
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

    /// What an index refers to.
    fn look_up<'b, T>(&self, list: &'b [T], index: Index<T>, what: &str) -> Result<&'b T, InputError> {
        let found = list.get(index.value());
        found.ok_or_else(|| self.damaged(format!("it refers to {what} {index} of {}", list.len())))
    }
}

fn damaged(subject: &str, problem: impl Into<String>) -> InputError {
    InputError::invalid(subject, problem, "export the scene again")
}

/// A name from the file, fit for a line of text: on one line and not too long.
fn printable(name: &str) -> String {
    const LONGEST: usize = 80;
    let mut text: String = name.chars().take(LONGEST).flat_map(char::escape_debug).collect();
    if name.chars().nth(LONGEST).is_some() {
        text.push_str("...");
    }
    text
}

/// A thing by its name, if it has one, and its number.
fn named(what: &str, index: usize, name: Option<&str>) -> String {
    match name {
        Some(name) if !name.is_empty() => format!("{what} {index} ({})", printable(name)),
        _ => format!("{what} {index}"),
    }
}
