//! Reading and writing EXR frames.
//!
//! # Supported files
//! Scan-line and tiled files, one or several parts, half, float and unsigned samples, and every compression that the
//! `exr` crate decodes. Mip and rip maps are read at full resolution only. The data window must equal the display
//! window (at any origin): cropped and overscanned frames are not supported, because missing pixels have neither color
//! nor motion. Subsampled channels and deep data are not supported either.
//!
//! # Channel names
//! Names are looked up over all parts of a frame's files; the name of a part or of a pass counts as a prefix of its
//! channel names. Case is ignored. [`ChannelNames`] names others; `docs/renderers.md` has the layouts of renderers.
//!
//! | meaning | channels, first match wins |
//! |---|---|
//! | color, linear | `<layer>.Combined.R/G/B` (Blender); `R`, `G`, `B`; `<layer>.R/G/B`, fewest name parts first; grey `Y` |
//! | depth, distance along the view axis | `<layer>.Depth.Z` or `.V`; Unreal's; `Z`; `depth` |
//! | motion, Blender's | `<layer>.Vector.X/Y/Z/W`: with y **up**, X/Y are previous minus current, Z/W are current minus next |
//! | motion, plain | `motion.X/Y/Z/W`: with y **down**, X/Y are previous minus current, Z/W are **next minus current** |
//! | albedo, if it is asked for | `<layer>.R/G/B` with a layer `Denoising Albedo` or `DiffCol` (Blender), `albedo`, `diffuse_albedo` (Arnold), `DiffuseFilter` (V-Ray) |
//! | motion, others | Unreal's Movie Render Queue, Arnold's `motionvector.R/G`, Nuke's `backward.u/v` and `forward.u/v` |
//!
//! # Color
//! Chromaticities other than those of Rec. 709, or a text attribute that names such a space (`colorInteropID`,
//! `oiio:ColorSpace`: ACEScg, ACES2065-1, Rec. 2020, P3-D65), are converted to Rec. 709 with a warning. Pixels are
//! taken for square; a warning says if the header has another `pixelAspectRatio`.
//!
//! Vectors are converted to pixels. Z/W are optional: only backward playback needs them.

mod channels;
mod color_space;
mod decode;
mod header;
mod layout;
mod reading;
mod write;

pub use channels::{AlbedoLayer, ChannelNames};
pub use decode::ExrFrame;
pub use header::{ExrHeader, PassFile, Vectors};
pub use reading::{DepthKind, DepthReading, MotionReading};
pub use write::{ColorFormat, FrameToWrite, write, write_channels};

use crate::error::{InputError, io_error, one_line};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Converts an error of the `exr` crate.
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

/// Runs a decoder of another crate and turns a panic, which malformed files can cause, into an error.
pub(crate) fn guarded<T>(subject: &str, decode: impl FnOnce() -> Result<T, InputError>) -> Result<T, InputError> {
    catch_unwind(AssertUnwindSafe(decode)).unwrap_or_else(|_| {
        Err(InputError::invalid(
            subject,
            "is malformed in a way that its decoder does not handle",
            "export it again, or remove it",
        ))
    })
}
