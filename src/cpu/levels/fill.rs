//! Fills every pixel of a planned frame, for methods that read whole frames. Twin:
//! `shaders/levels/quad_fill_pass.wgsl`.

use crate::cpu::frame::Frame;
use crate::cpu::quads::Quads;
use crate::image::Image;

/// Filled colors of all views; empty unless the frame is planned. `quads`: shaded quads, one a view.
pub(crate) fn filled(frame: &Frame<'_>, size_px: [u32; 2], quads: &[Quads]) -> Vec<Image<[f32; 3]>> {
    let of = |(view, quads): (usize, &Quads)| {
        let colors = [Some(frame.color), frame.half].map(|colors| colors.map(|colors| colors[view]));
        Image::from_fn_parallel(size_px, |px| quads.filled(colors, px, frame.exposure))
    };
    quads.iter().enumerate().map(of).collect()
}
