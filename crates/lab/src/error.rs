//! Inputs that cannot be used, and how the errors read: what was wrong, what was expected, what to do.

use thiserror::Error;

/// A file, folder or option that cannot be used. Reads as one line: `subject: problem; remedy`.
#[derive(Clone, Debug, Error, PartialEq)]
#[error("{subject}: {problem}; {remedy}")]
pub struct InputError {
    /// The file, folder or option.
    pub subject: String,
    /// What is wrong with it.
    pub problem: String,
    /// What was expected or what to do.
    pub remedy: String,
}

impl InputError {
    /// `subject: problem; remedy`, each without a final full stop.
    pub fn new(subject: impl Into<String>, problem: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self { subject: subject.into(), problem: problem.into(), remedy: remedy.into() }
    }
}

/// Other people's messages on one line, as every error here.
#[cfg(feature = "full")]
pub(crate) fn one_line(message: &str) -> String {
    message.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// A failed file operation as one line. An early end of the file means that the file is cut off.
#[cfg(feature = "full")]
pub(crate) fn io_error(subject: &str, error: &std::io::Error) -> InputError {
    use std::io::ErrorKind;
    match error.kind() {
        ErrorKind::NotFound => {
            InputError::new(subject, "does not exist", "check the path; expected a file or folder that can be read")
        }
        ErrorKind::UnexpectedEof => {
            InputError::new(subject, "ends too early: the file is truncated", "copy or export it again")
        }
        _ => InputError::new(
            subject,
            one_line(&format!("cannot be read ({error})")),
            "check the permissions and the disk",
        ),
    }
}
