//! A parsed file.

use super::buffers::Buffers;
use super::errors::damaged;
use crate::error::InputError;
use crate::scene::SceneLimits;
use gltf::json::{Index, Root};

/// A parsed file, shared by all parts of the reader.
pub(super) struct Document<'a> {
    /// Path of the file as the user gave it.
    pub subject: &'a str,
    pub root: &'a Root,
    pub buffers: &'a Buffers,
    pub limits: &'a SceneLimits,
}

impl Document<'_> {
    /// The error of a damaged file.
    pub fn damaged(&self, problem: impl Into<String>) -> InputError {
        damaged(self.subject, problem)
    }

    /// The element that an index refers to, or an error if it is out of range.
    pub fn look_up<'b, T>(&self, list: &'b [T], index: Index<T>, what: &str) -> Result<&'b T, InputError> {
        let found = list.get(index.value());
        found.ok_or_else(|| self.damaged(format!("it refers to {what} {index} of {}", list.len())))
    }
}
