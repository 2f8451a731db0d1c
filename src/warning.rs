//! What is odd about a frame that was processed all the same.

use std::fmt;

/// One oddity. Reads as one line: what is odd, and what is done about it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Warning {
    /// The gaze is lost or not finite; the last known one is held.
    GazeHeld {
        /// Index of the view.
        view: usize,
    },
    /// The gaze is lost or not finite, and was never known.
    GazeUnknown {
        /// Index of the view.
        view: usize,
    },
    /// The gaze is known and outside the view, as it may be.
    GazeOffScreen {
        /// Index of the view.
        view: usize,
    },
    /// Colors that are NaN or infinite.
    NonfiniteColor {
        /// How many.
        pixels: u64,
    },
    /// Motion vectors that are NaN, infinite or absurd.
    BadMotion {
        /// How many.
        pixels: u64,
    },
    /// Depths that are NaN, or distances that are not positive.
    BadDepth {
        /// How many.
        pixels: u64,
    },
    /// Trusts that are NaN or infinite.
    BadTrust {
        /// How many.
        pixels: u64,
    },
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::GazeHeld { view } => write!(f, "gaze of view {view} is lost: the last one is held"),
            Self::GazeUnknown { view } => write!(f, "gaze of view {view} is not known yet: taken for the middle"),
            Self::GazeOffScreen { view } => write!(f, "gaze of view {view} is off screen"),
            Self::NonfiniteColor { pixels } => {
                write!(f, "color of {pixels} pixels is NaN or infinite: they show their history, or black")
            }
            Self::BadMotion { pixels } => {
                write!(f, "motion of {pixels} pixels is NaN, infinite or absurd: their history is dropped")
            }
            Self::BadDepth { pixels } => {
                write!(f, "depth of {pixels} pixels is NaN or not positive: their history is dropped")
            }
            Self::BadTrust { pixels } => {
                write!(f, "trust of {pixels} pixels is NaN or infinite: NaN counts as 0, infinity as 1")
            }
        }
    }
}
