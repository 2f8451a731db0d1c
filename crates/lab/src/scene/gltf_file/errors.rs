//! Errors of damaged files, and names for the parts of a file in errors and warnings.

use crate::error::InputError;

/// The error of a damaged file.
pub(super) fn damaged(subject: &str, problem: impl Into<String>) -> InputError {
    InputError::invalid(subject, problem, "export the scene again")
}

/// Text from the file, escaped to one line and truncated.
pub(super) fn printable(name: &str) -> String {
    const LONGEST: usize = 80;
    let mut text: String = name.chars().take(LONGEST).flat_map(char::escape_debug).collect();
    if name.chars().nth(LONGEST).is_some() {
        text.push_str("...");
    }
    text
}

/// Kind, index and, if there is one, name of an object of the file.
pub(super) fn named(what: &str, index: usize, name: Option<&str>) -> String {
    match name {
        Some(name) if !name.is_empty() => format!("{what} {index} ({})", printable(name)),
        _ => format!("{what} {index}"),
    }
}
