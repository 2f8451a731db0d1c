//! Notes about one pixel: the values that its pass computes, named and in order.
//!
//! A pass is generic over [`Notes`]. The frame's pixels are computed with [`NoNotes`], which compiles to nothing; a
//! pixel to explain is then computed once more, from the same inputs, with a list of notes.

use glam::{Vec2, Vec3};

/// Part of a pixel's computation, in the order in which notes are listed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum NoteStage {
    /// What the frame gives.
    Input,
    /// Where history is read.
    Reprojection,
    /// Whether history is kept, and why not.
    Verdict,
    /// This frame's color of the pixel.
    Candidate,
    /// What history has there.
    History,
    /// Candidate and history at one scale, and their difference.
    Comparison,
    /// Change of light.
    Light,
    /// Shares of history and candidate.
    Decision,
    /// Color in the output.
    Shown,
    /// What the next frame finds.
    Stored,
}

impl NoteStage {
    /// Name in lists.
    pub fn name(self) -> &'static str {
        match self {
            Self::Input => "input",
            Self::Reprojection => "reprojection",
            Self::Verdict => "verdict",
            Self::Candidate => "candidate",
            Self::History => "history",
            Self::Comparison => "comparison",
            Self::Light => "light",
            Self::Decision => "decision",
            Self::Shown => "shown",
            Self::Stored => "stored",
        }
    }
}

/// Values of a note.
#[derive(Clone, Debug, PartialEq)]
pub enum NoteValues {
    /// Numbers, in the note's unit.
    Numbers(Vec<f32>),
    /// Packed words.
    Words(Vec<u32>),
    /// A fact.
    Text(&'static str),
}

/// A value or some that belong together.
#[derive(Clone, Debug, PartialEq)]
pub struct Note {
    /// What it belongs to.
    pub stage: NoteStage,
    /// Name; several notes of a list may have the same.
    pub name: &'static str,
    /// Values.
    pub values: NoteValues,
    /// Unit of the values, or what each of them is; empty for shares and texts.
    pub unit: &'static str,
}

/// Notes about one pixel of a frame, in order.
#[derive(Clone, Debug, PartialEq)]
pub struct PixelNotes {
    /// Number of the view.
    pub view: usize,
    /// The pixel: (0, 0) is the top-left one, y down.
    pub px: [u32; 2],
    /// Notes. Empty for a pixel outside the frame.
    pub notes: Vec<Note>,
}

impl PixelNotes {
    /// No notes yet.
    pub fn new(view: usize, px: [u32; 2]) -> Self {
        Self { view, px, notes: vec![] }
    }

    /// The first note of this stage and name.
    pub fn find(&self, stage: NoteStage, name: &str) -> Option<&Note> {
        self.notes.iter().find(|note| note.stage == stage && note.name == name)
    }
}

/// Takes notes about a pixel, or none.
pub(crate) trait Notes {
    /// Whether notes are taken. A constant, so that work for notes alone is compiled out where none are.
    #[cfg_attr(not(feature = "cpu"), allow(dead_code, reason = "only passes on the CPU ask"))]
    const ON: bool;

    /// Takes a note.
    fn note(&mut self, stage: NoteStage, name: &'static str, values: impl Into<NoteValues>, unit: &'static str);
}

/// Takes no notes.
pub(crate) struct NoNotes;

impl Notes for NoNotes {
    const ON: bool = false;

    #[inline(always)]
    fn note(&mut self, _: NoteStage, _: &'static str, _: impl Into<NoteValues>, _: &'static str) {}
}

impl Notes for Vec<Note> {
    const ON: bool = true;

    fn note(&mut self, stage: NoteStage, name: &'static str, values: impl Into<NoteValues>, unit: &'static str) {
        self.push(Note { stage, name, values: values.into(), unit });
    }
}

impl<const N: usize> From<[f32; N]> for NoteValues {
    fn from(values: [f32; N]) -> Self {
        Self::Numbers(values.to_vec())
    }
}

impl From<f32> for NoteValues {
    fn from(value: f32) -> Self {
        [value].into()
    }
}

impl From<Vec2> for NoteValues {
    fn from(value: Vec2) -> Self {
        value.to_array().into()
    }
}

impl From<Vec3> for NoteValues {
    fn from(value: Vec3) -> Self {
        value.to_array().into()
    }
}

impl<const N: usize> From<[u32; N]> for NoteValues {
    fn from(words: [u32; N]) -> Self {
        Self::Words(words.to_vec())
    }
}

impl From<bool> for NoteValues {
    fn from(value: bool) -> Self {
        Self::Text(if value { "yes" } else { "no" })
    }
}

impl From<&'static str> for NoteValues {
    fn from(text: &'static str) -> Self {
        Self::Text(text)
    }
}
