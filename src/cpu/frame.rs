//! A frame of images in memory, and its checks.

use crate::context::ContextDesc;
use crate::error::FrameError;
use crate::frame::{self, FrameInputs, Images};
use crate::image::Image;
use crate::view::ViewFrame;
use std::borrow::Borrow;

/// A frame whose inputs are slices with one image a view; fields are at [`FrameInputs`].
///
/// ```
/// # use afterimage::internal::ViewFrame;
/// # use afterimage::Image;
/// # fn example(left: &Image<[f32; 3]>, right: &Image<[f32; 3]>, views: &[ViewFrame], index: u64) {
/// use afterimage::cpu::Frame;
///
/// let colors = [left, right];
/// let frame = Frame::new(&colors, views, index);
/// # let _ = frame;
/// # }
/// ```
pub type Frame<'a> = FrameInputs<'a, &'a [&'a Image<[f32; 3]>], &'a [&'a Image<f32>], &'a [&'a Image<[f32; 2]>]>;

type Input<'a> = frame::Input<&'a [&'a Image<[f32; 3]>], &'a [&'a Image<f32>], &'a [&'a Image<[f32; 2]>]>;

impl<'a> Frame<'a> {
    /// A frame without optional inputs, which continues the previous frame: no reset, unchanged exposure. `color`: one
    /// image a view.
    pub fn new(color: &'a [&'a Image<[f32; 3]>], views: &'a [ViewFrame], index: u64) -> Self {
        Self::of_color(color, views, index)
    }

    /// This frame with another color input, whose lifetime may be shorter. `..*self` would not allow that.
    pub(super) fn with_color<'b>(&self, color: &'b [&'b Image<[f32; 3]>]) -> Frame<'b>
    where
        'a: 'b,
    {
        let shorter: Frame<'b> = *self;
        Frame { color, ..shorter }
    }
}

/// Checks a frame without its outputs.
pub(super) fn check_inputs(desc: &ContextDesc, frame: &Frame<'_>) -> Result<(), FrameError> {
    frame.check(desc)?;
    frame.inputs().iter().try_for_each(|input| check_input(desc, input))
}

/// Checks the sizes of the inputs that are known before a frame is shaded.
pub(super) fn check_geometry(desc: &ContextDesc, frame: &Frame<'_>) -> Result<(), FrameError> {
    frame.inputs().iter().filter(|input| input.is_geometry).try_for_each(|input| check_input(desc, input))
}

/// Checks that an input, if given, has one image of its size for each view.
fn check_input(desc: &ContextDesc, input: &Input<'_>) -> Result<(), FrameError> {
    let Some(images) = input.images else { return Ok(()) };
    let expected_px = images.size_px(desc.size_px);
    match images {
        Images::Colors(images) | Images::HalfColors(images) => check_sizes(desc, input.name, images, expected_px),
        Images::Scalars(images) => check_sizes(desc, input.name, images, expected_px),
        Images::Vectors(images) => check_sizes(desc, input.name, images, expected_px),
    }
}

/// Checks that there is one image of `expected_px` for each view.
pub(super) fn check_sizes<T: Copy>(
    desc: &ContextDesc,
    input: &'static str,
    images: &[impl Borrow<Image<T>>],
    expected_px: [u32; 2],
) -> Result<(), FrameError> {
    let (found, expected) = (images.len(), desc.view_count as usize);
    if found != expected {
        return Err(FrameError::ViewCount { found, expected });
    }
    for (view, found) in images.iter().map(|image| image.borrow().size()).enumerate() {
        if found != expected_px {
            return Err(FrameError::Size { input, view, found, expected: expected_px });
        }
    }
    Ok(())
}
