//! Reading and writing EXR frames.
//!
//! # What is read
//! Scan-line and tiled files, one or several parts, half, float and unsigned samples, every compression that the `exr`
//! crate decodes. Of mip and rip maps the full resolution only. The data window must be the display window (at any origin):
//! a cropped or overscanned frame is refused, because pixels that are not there have neither color nor motion. So are
//! subsampled channels and deep data.
//!
//! # Which channels are used
//! Names are looked up over all parts; a part's name counts as a prefix of its channels'. Upper and lower case are the same.
//!
//! | meaning | channels, the first that is found |
//! |---|---|
//! | color, linear | `<layer>.Combined.R/G/B` (Blender); `R`, `G`, `B`; `<layer>.R/G/B`, fewest name parts first; grey `Y` |
//! | depth, distance along the view axis | `<layer>.Depth.Z` or `.V`; `Z`; `depth` |
//! | motion, Blender's | `<layer>.Vector.X/Y/Z/W`: with y **up**, X/Y are previous minus current, Z/W are current minus next |
//! | motion, plain | `motion.X/Y/Z/W`: with y **down**, X/Y are previous minus current, Z/W are **next minus current** |
//!
//! All vectors are in pixels. Z/W are optional: only playing a sequence backwards needs them.

mod channels;
mod decode;
mod header;
mod write;

pub use decode::ExrFrame;
pub use header::{ExrHeader, Vectors};
pub use write::{ColorFormat, FrameToWrite, write, write_channels};

use crate::error::{InputError, io_error, one_line};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// An error of the `exr` crate as one line of ours.
fn exr_error(subject: &str, error: exr::error::Error) -> InputError {
    use exr::error::Error;
    let invalid = |problem: String| InputError::invalid(subject, one_line(&problem), "export it again, or remove it");
    match error {
        Error::NotSupported(what) => InputError::not_supported(
            subject,
            one_line(&format!("uses a feature of EXR that is not supported ({what})")),
            "write it as a flat scan-line or tiled EXR with ZIP compression",
        ),
        Error::Invalid(what) => invalid(format!("is not a valid EXR file ({what})")),
        Error::Io(error) => io_error(subject, &error),
        other => invalid(format!("cannot be read ({other})")),
    }
}

/// Runs a decoder of another crate: a panic on a malformed file is that file's fault, not a reason to stop.
pub(crate) fn guarded<T>(subject: &str, decode: impl FnOnce() -> Result<T, InputError>) -> Result<T, InputError> {
    catch_unwind(AssertUnwindSafe(decode)).unwrap_or_else(|_| {
        Err(InputError::invalid(
            subject,
            "is malformed in a way that its decoder does not handle",
            "export it again, or remove it",
        ))
    })
}
