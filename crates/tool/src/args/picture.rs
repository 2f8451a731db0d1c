//! Debug views and file formats.

use afterimage::DebugView;
use clap::ValueEnum;

/// Values of `--debug`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum DebugName {
    /// Weight sum of the reservoir; with smr the level of detail of the history
    Weight,
    /// Frames since the shown sample was rendered; wrs only
    Age,
    /// Fraction of the history's weight that was kept
    Survival,
    /// Validity of the history: reused, or why it was rejected
    Flush,
    /// Gate value
    Gate,
    /// Motion
    Motion,
}

impl DebugName {
    /// Name on the command line, and name of the output folder.
    pub fn name(self) -> &'static str {
        match self {
            Self::Weight => "weight",
            Self::Age => "age",
            Self::Survival => "survival",
            Self::Flush => "flush",
            Self::Gate => "gate",
            Self::Motion => "motion",
        }
    }

    /// The library's debug view.
    pub fn view(self) -> DebugView {
        match self {
            Self::Weight => DebugView::Quality,
            Self::Age => DebugView::Age,
            Self::Survival => DebugView::Survival,
            Self::Flush => DebugView::Rejection,
            Self::Gate => DebugView::Gate,
            Self::Motion => DebugView::Motion,
        }
    }
}

/// File format of frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum FormatName {
    /// sRGB, 8 bit
    Png,
    /// Linear half float
    #[cfg(feature = "full")]
    Exr,
}
