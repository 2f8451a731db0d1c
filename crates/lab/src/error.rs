//! Errors of inputs, split by who must act. Each reads as one line: `subject: problem; remedy`.

use afterimage::FrameError;
pub use afterimage_eval::error::{Bound, Exceeded, InputError, Message};

/// The error of a renderer that has lost its device.
pub fn device_lost(name: &str, lost: &FrameError) -> InputError {
    InputError::device(name, lost.to_string(), "start again, or render on the CPU where that is possible")
}

/// A message of another crate on one line.
pub(crate) fn one_line(message: &str) -> String {
    message.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// A failed file operation. An early end of the file means that the file is truncated.
pub(crate) fn io_error(subject: &str, error: &std::io::Error) -> InputError {
    use std::io::ErrorKind;
    match error.kind() {
        ErrorKind::NotFound => {
            InputError::io(subject, "does not exist", "check the path; expected a file or folder that can be read")
        }
        ErrorKind::UnexpectedEof => {
            InputError::invalid(subject, "ends too early: the file is truncated", "copy or export it again")
        }
        _ => InputError::io(
            subject,
            one_line(&format!("cannot be read ({error})")),
            "check the permissions and the disk",
        ),
    }
}
