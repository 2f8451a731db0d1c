//! Warnings: recoverable problems of a frame.

use std::fmt;

/// A recoverable problem of a frame. The frame was processed nevertheless. Displays as one line: the problem, and how
/// it was handled.
///
/// Warnings about gaze are known when a frame is recorded (`gpu::Recorded::warnings`); those about pixels come from
/// counters ([`FrameStats::warnings`](crate::FrameStats::warnings)).
///
/// ```
/// use afterimage::{FrameStats, Warning};
///
/// let stats = FrameStats { pixels: 100, bad_depth: 7, ..FrameStats::default() };
/// let warnings: Vec<Warning> = stats.warnings().collect();
/// assert_eq!(warnings, [Warning::BadDepth { pixels: 7 }]);
/// assert_eq!(warnings[0].to_string(), "depth of 7 pixels is NaN or not positive: their history is rejected");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Warning {
    /// The gaze is lost or not finite; the last known position is used.
    GazeHeld {
        /// Index of the view.
        view: usize,
    },
    /// The gaze is lost or not finite, and no earlier position is known; the middle of the view is used.
    GazeUnknown {
        /// Index of the view.
        view: usize,
    },
    /// The gaze is outside the view. It is used as it is.
    GazeOffScreen {
        /// Index of the view.
        view: usize,
    },
    /// Colors are NaN or infinite; such pixels show their history, or black.
    NonfiniteColor {
        /// Number of such pixels.
        pixels: u64,
    },
    /// Motion vectors are NaN, infinite or longer than 65536 pixels along an axis; history of such pixels is rejected.
    BadMotion {
        /// Number of such pixels.
        pixels: u64,
    },
    /// Depths are NaN, or distances that are not positive; history of such pixels is rejected.
    BadDepth {
        /// Number of such pixels.
        pixels: u64,
    },
    /// Trust values are NaN, which count as 0, or infinite, which count as 1 if positive.
    BadTrust {
        /// Number of such pixels.
        pixels: u64,
    },
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::GazeHeld { view } => write!(f, "gaze of view {view} is lost: the last known position is used"),
            Self::GazeUnknown { view } => write!(f, "gaze of view {view} is not known yet: the middle is used"),
            Self::GazeOffScreen { view } => write!(f, "gaze of view {view} is outside the view: used as it is"),
            Self::NonfiniteColor { pixels } => {
                write!(f, "color of {pixels} pixels is NaN or infinite: they show their history, or black")
            }
            Self::BadMotion { pixels } => {
                write!(
                    f,
                    "motion of {pixels} pixels is NaN, infinite or beyond 65536 pixels: their history is rejected"
                )
            }
            Self::BadDepth { pixels } => {
                write!(f, "depth of {pixels} pixels is NaN or not positive: their history is rejected")
            }
            Self::BadTrust { pixels } => {
                write!(f, "trust of {pixels} pixels is NaN or infinite: NaN counts as 0, infinity as 1")
            }
        }
    }
}
