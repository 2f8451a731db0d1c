//! What a pass is given.

use super::frame::Frame;
use super::history::History;
use super::quads::Quads;
use crate::context::ContextDesc;
use crate::image::Image;
use crate::kernel::debug_view::PixelTrace;
use crate::notes::PixelNotes;

/// Arguments of a method's pass.
pub(super) struct Pass<'a, 'f> {
    pub desc: &'a ContextDesc,
    pub history: &'a mut History,
    pub frame: &'a Frame<'f>,
    /// Shaded quads, one a view; empty unless the frame is shaded by quads.
    pub quads: &'a [Quads],
    pub output: &'a mut [Image<[f32; 3]>],
    pub alpha: Option<Alpha<'a>>,
    pub traces: Option<&'a mut [Image<PixelTrace>]>,
    /// A pixel to explain.
    pub noted: Option<&'a mut PixelNotes>,
}

/// Alpha of a frame's colors, which the renderer wrote, and of the output; one image a view each.
pub(super) struct Alpha<'a> {
    pub given: &'a [&'a Image<f32>],
    pub output: &'a mut [Image<f32>],
}
