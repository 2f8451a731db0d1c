//! Fills every pixel of a planned frame, for methods that read whole frames. Twin: `shaders/pass/quad_fill_pass.wgsl`.

use super::Frame;
use super::sparse_pass::Quads;
use crate::image::Image;

/// Filled colors of all views; empty unless the frame is planned. `quads`: shaded quads, one a view.
pub(super) fn filled(frame: &Frame<'_>, size_px: [u32; 2], quads: &[Quads]) -> Vec<Image<[f32; 3]>> {
    let of = |(view, quads): (usize, &Quads)| {
        let colors = [Some(frame.color), frame.half].map(|colors| colors.map(|colors| colors[view]));
        Image::from_fn_parallel(size_px, |px| quads.filled(colors, px, frame.exposure))
    };
    quads.iter().enumerate().map(of).collect()
}
