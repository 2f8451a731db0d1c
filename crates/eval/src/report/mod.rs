//! Contact sheets of clips.

pub mod canvas;
pub mod sheet;
