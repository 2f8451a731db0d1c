//! Plans of frames shaded by quads: before shading, the renderer asks which quads to shade.

use super::quad_plan::{is_quarter, plan_quads};
use crate::context::ContextDesc;
use crate::cpu::frame::Frame;
use crate::cpu::history::History;
use crate::cpu::quads::Quads;
use crate::image::Image;

/// Quads that were chosen for a frame.
#[derive(Clone, Debug)]
pub(crate) struct Planned {
    pub index: u64,
    pub is_quarter: bool,
    /// One mask of pixels a view.
    pub masks: Vec<Image<bool>>,
    /// Number of paths of each pixel, one image a view.
    pub paths: Vec<Image<u8>>,
    /// One a view.
    pub quads: Vec<Quads>,
}

impl Planned {
    /// The plan of a frame, whose colors and noise are not read.
    pub fn new(desc: &ContextDesc, history: &History, frame: &Frame<'_>) -> Self {
        let unshaded = Image::filled([1, 1], [0.0; 3]);
        let colors = vec![&unshaded; frame.views.len()];
        let frame = Frame { noise: None, ..frame.with_color(&colors) };
        let (quads, of_quads): (Vec<_>, Vec<_>) = plan_quads(desc, history, &frame).into_iter().unzip();
        let masks: Vec<_> = quads.iter().map(Quads::pixels).collect();
        let of_pixels = |(mask, paths): (&Image<bool>, &Image<u8>)| {
            Image::from_fn(mask.size(), |[x, y]| {
                if mask.at(x as usize, y as usize) { paths.at(x as usize / 2, y as usize / 2) } else { 0 }
            })
        };
        let paths = masks.iter().zip(&of_quads).map(of_pixels).collect();
        Self { index: frame.index, is_quarter: is_quarter(desc, history, &frame), masks, paths, quads }
    }
}
