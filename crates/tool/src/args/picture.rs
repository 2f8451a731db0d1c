//! Debug views and file formats.

use super::Named;
use crate::clip::{WriteFrame, write_png};
use crate::output::{Output, WriteError};
use afterimage::{DebugView, Image};
use afterimage_lab::source::exr_file::{self, FrameToWrite};
use clap::ValueEnum;

impl Named for DebugView {
    fn rows() -> Vec<(Self, &'static str, &'static str)> {
        vec![
            (Self::Quality, "weight", "Weight sum of the reservoir; with smr the level of detail of the history"),
            (Self::Age, "age", "Frames since the shown sample was rendered; wrs only"),
            (Self::HistoryShare, "survival", "Fraction of the history's weight that was kept"),
            (Self::Rejection, "flush", "Validity of the history: reused, or why it was rejected"),
            (Self::Agreement, "gate", "Gate value"),
            (Self::Motion, "motion", "Motion"),
        ]
    }
}

/// File format of frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum FormatName {
    /// sRGB, 8 bit
    Png,
    /// Linear half float
    Exr,
}

impl FormatName {
    /// Writer of frames in this format.
    pub fn writer(self) -> WriteFrame {
        match self {
            Self::Png => write_png,
            Self::Exr => write_exr,
        }
    }
}

fn write_exr(
    out: &Output,
    folder: &str,
    index: usize,
    linear: &Image<[f32; 3]>,
    _: &Image<[f32; 3]>,
) -> Result<(), WriteError> {
    let path = out.path(folder, index, "exr");
    exr_file::write(&path, &FrameToWrite::color(linear)).map_err(|e| WriteError::new(&path, e))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_debug_view_has_a_name() {
        assert_eq!(DebugView::rows().iter().map(|row| row.0).collect::<Vec<_>>(), DebugView::ALL);
    }
}
