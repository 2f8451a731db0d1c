//! A frame of images in memory, and its checks.

use crate::context::ContextDesc;
use crate::error::FrameError;
use crate::frame::FrameInputs;
use crate::image::Image;
use crate::view::ViewFrame;

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
        let Self { depth, motion, trust, reactive, lod, noise, albedo, mask, half, views, index, .. } = *self;
        let (reset, exposure) = (self.reset, self.exposure);
        Frame { color, depth, motion, trust, reactive, lod, noise, albedo, mask, half, views, index, reset, exposure }
    }
}

/// Checks a frame without its outputs.
pub(super) fn check_inputs(desc: &ContextDesc, frame: &Frame<'_>) -> Result<(), FrameError> {
    frame.check(desc)?;
    check_sizes(desc, "color", Some(frame.color.iter().map(|i| i.size())))?;
    let half = desc.size_px.map(|side| side.div_ceil(2));
    check_sizes_of(desc, "half", frame.half.map(|h| h.iter().map(|i| i.size())), half)?;
    check_geometry(desc, frame)?;
    check_sizes(desc, "albedo", frame.albedo.map(|a| a.iter().map(|i| i.size())))?;
    check_sizes(desc, "mask", frame.mask.map(|m| m.iter().map(|i| i.size())))?;
    check_sizes(desc, "noise", frame.noise.map(|n| n.iter().map(|i| i.size())))
}

/// Checks the sizes of the inputs that are known before a frame is shaded.
pub(super) fn check_geometry(desc: &ContextDesc, frame: &Frame<'_>) -> Result<(), FrameError> {
    for (name, images) in frame.scalars() {
        check_sizes(desc, name, images.map(|images| images.iter().map(|i| i.size())))?;
    }
    check_sizes(desc, "motion", frame.motion.map(|m| m.iter().map(|i| i.size())))
}

/// Checks that an input, if given, has one image of the context's size for each view.
pub(super) fn check_sizes(
    desc: &ContextDesc,
    input: &'static str,
    sizes: Option<impl ExactSizeIterator<Item = [u32; 2]>>,
) -> Result<(), FrameError> {
    check_sizes_of(desc, input, sizes, desc.size_px)
}

/// Checks that an input, if given, has one image of `expected` pixels for each view.
fn check_sizes_of(
    desc: &ContextDesc,
    input: &'static str,
    sizes: Option<impl ExactSizeIterator<Item = [u32; 2]>>,
    expected_px: [u32; 2],
) -> Result<(), FrameError> {
    let Some(sizes) = sizes else { return Ok(()) };
    let (found, expected) = (sizes.len(), desc.view_count as usize);
    if found != expected {
        return Err(FrameError::ViewCount { found, expected });
    }
    for (view, found) in sizes.enumerate() {
        if found != expected_px {
            return Err(FrameError::Size { input, view, found, expected: expected_px });
        }
    }
    Ok(())
}
