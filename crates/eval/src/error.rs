//! Errors of inputs, split by who must act. Each reads as one line: `subject: problem; remedy`.

use std::fmt;
use thiserror::Error;

/// An input that cannot be used: a file, a folder, a scene, an argument. Displays as `subject: problem; remedy`.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum InputError {
    /// The system refused: a missing file, permissions, the disk, memory. Correct the path or the permissions.
    #[error("{0}")]
    Io(Message),
    /// The file is damaged, incomplete or contradicts itself. Export it again or correct it.
    #[error("{0}")]
    Invalid(Message),
    /// The file is valid, but its kind or a feature that it needs is not implemented. Convert it.
    #[error("{0}")]
    NotSupported(Message),
    /// The input is larger than a limit. Use a smaller one, or raise the limit that `exceeded` names.
    #[error("{message}")]
    Limit {
        /// Message with the input concerned, the problem and the remedy.
        message: Message,
        /// The limit, and the size that would be needed.
        exceeded: Exceeded,
    },
    /// The caller asked for something unknown, contradictory or out of range. Change the argument.
    #[error("{0}")]
    Request(Message),
    /// The graphics device cannot do the work, or was lost. Start again, or use another device or the CPU.
    #[error("{0}")]
    Device(Message),
}

/// Text of an error: three clauses, each on one line and without a final full stop.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Message {
    /// The file, folder, scene or argument.
    pub subject: String,
    /// The fault found in it.
    pub problem: String,
    /// What was expected, or what to do.
    pub remedy: String,
}

impl Message {
    fn new(subject: impl Into<String>, problem: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self { subject: subject.into(), problem: problem.into(), remedy: remedy.into() }
    }
}

impl fmt::Display for Message {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{}: {}; {}", self.subject, self.problem, self.remedy)
    }
}

/// A limit, and the size that an input needs, in the limit's unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Exceeded {
    /// The limit.
    pub bound: Bound,
    /// Smallest limit that admits this input; `None` if the reader stopped before it knew.
    pub needed: Option<u64>,
    /// The limit in force.
    pub allowed: u64,
}

impl Exceeded {
    /// The limit in megapixels that admits this input, rounded up; `None` if it is not known or another limit is
    /// exceeded.
    pub fn needed_megapixels(&self) -> Option<u64> {
        self.needed.filter(|_| self.bound == Bound::Pixels).map(|pixels| pixels.div_ceil(1_000_000))
    }
}

/// Limits that an input can exceed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Bound {
    /// Pixels of a frame: `ReadLimits::max_pixels`.
    Pixels,
    /// Triangles of a scene: `SceneLimits::max_triangles`.
    Triangles,
    /// Texels of a scene's textures: `SceneLimits::max_texels`.
    Texels,
    /// Bytes of a scene's files: `SceneLimits::max_file_bytes`.
    FileBytes,
    /// Bytes of a scene's JSON: `SceneLimits::max_json_bytes`.
    JsonBytes,
    /// Triangles that the graphics device holds.
    Device,
    /// Bytes of a file, under a constant limit of its reader.
    Fixed,
}

impl InputError {
    /// An [`InputError::Io`].
    pub fn io(subject: impl Into<String>, problem: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self::Io(Message::new(subject, problem, remedy))
    }

    /// An [`InputError::Invalid`].
    pub fn invalid(subject: impl Into<String>, problem: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self::Invalid(Message::new(subject, problem, remedy))
    }

    /// An [`InputError::NotSupported`].
    pub fn not_supported(subject: impl Into<String>, problem: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self::NotSupported(Message::new(subject, problem, remedy))
    }

    /// An [`InputError::Limit`].
    pub fn limit(
        exceeded: Exceeded,
        subject: impl Into<String>,
        problem: impl Into<String>,
        remedy: impl Into<String>,
    ) -> Self {
        Self::Limit { message: Message::new(subject, problem, remedy), exceeded }
    }

    /// An [`InputError::Request`].
    pub fn request(subject: impl Into<String>, problem: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self::Request(Message::new(subject, problem, remedy))
    }

    /// An [`InputError::Device`].
    pub fn device(subject: impl Into<String>, problem: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self::Device(Message::new(subject, problem, remedy))
    }

    /// Message of any variant: the input concerned, the problem and the remedy.
    pub fn message(&self) -> &Message {
        match self {
            Self::Limit { message, .. } => message,
            Self::Io(message)
            | Self::Invalid(message)
            | Self::NotSupported(message)
            | Self::Request(message)
            | Self::Device(message) => message,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_variant_reads_as_one_line_and_a_limit_keeps_its_numbers() {
        let exceeded = Exceeded { bound: Bound::Pixels, needed: Some(70_000_001), allowed: 64_000_000 };
        let make = [InputError::io, InputError::invalid, InputError::not_supported, InputError::request];
        let all = make.map(|make: fn(_, _, _) -> _| make("a", "b", "c"));
        let limit = InputError::limit(exceeded, "a", "b", "c");
        for error in all.iter().chain([&limit, &InputError::device("a", "b", "c")]) {
            assert_eq!((error.to_string().as_str(), error.message().remedy.as_str()), ("a: b; c", "c"));
        }
        assert_eq!(exceeded.needed_megapixels(), Some(71));
        assert_eq!(Exceeded { bound: Bound::Texels, ..exceeded }.needed_megapixels(), None);
    }
}
