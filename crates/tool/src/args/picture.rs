//! What is written as pictures.

use afterimage::DebugView;
use clap::ValueEnum;

/// Names of debug views.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum DebugName {
    /// Weight sum of the reservoir; of smr the sharpness stored
    Weight,
    /// Frames since the shown sample was shaded; wrs only
    Age,
    /// Share of the history's weight that survived
    Survival,
    /// What became of the history
    Flush,
    /// Gate value
    Gate,
    /// Motion
    Motion,
}

impl DebugName {
    /// As typed, and as folders are named.
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

    /// The library's form.
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
