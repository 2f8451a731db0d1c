//! Plans of frames shaded by quads: before shading, the renderer asks which quads to shade.

use super::{CpuAfterimage, Frame, check_geometry, check_sizes, sparse_pass};
use crate::error::FrameError;
use crate::image::Image;

/// Quads that were chosen for a frame.
#[derive(Clone, Debug)]
pub(super) struct Planned {
    pub index: u64,
    pub is_quarter: bool,
    /// One mask of pixels a view.
    masks: Vec<Image<bool>>,
    /// Number of paths of each pixel, one image a view.
    paths: Vec<Image<u8>>,
    /// One a view.
    pub quads: Vec<sparse_pass::Quads>,
}

impl CpuAfterimage {
    /// Pixels to shade of a [planned frame](crate::internal::Filter::Quads), one mask a view: quads of 2x2 pixels, or
    /// [single pixels](crate::internal::Foveation::single_pixels). Give the frame to [`process`](Self::process) with a
    /// color of the context's size, in which these pixels are shaded. Without history the plan is a quarter of the
    /// pixels ([`is_quarter`](Self::is_quarter)), unless the foveation shades more.
    ///
    /// All quads of the fovea are chosen, an even pattern outside it that visits every quad in turn, and at most the
    /// share [`Foveation::budget`](crate::internal::Foveation::budget) of a view's quads where history lacks most.
    ///
    /// Give it the frame that will be processed, with the parts that are known before shading: views, depth, motion,
    /// trust or reactive mask, index and reset. Its colors and noise are not read, and the colors may be an empty
    /// slice. History is unchanged: the same call gives the same masks.
    ///
    /// ```
    /// use afterimage::cpu::{CpuAfterimage, Frame};
    /// use afterimage::internal::{ContextDesc, Foveation, ViewFrame};
    /// use afterimage::{Gaze, Image, ViewGeometry};
    ///
    /// let size = [64, 36];
    /// let mut desc = ContextDesc::new(size);
    /// desc.settings.foveation = Foveation::quads();
    /// let mut post = CpuAfterimage::new(&desc)?;
    /// let views = [ViewFrame::new(ViewGeometry::flat(size, 70.0)?, Gaze::At { px: [40.0, 18.0] })];
    /// let masks = post.plan(&Frame::new(&[], &views, 0))?;
    /// // Here the renderer shades the pixels of the mask.
    /// let shaded = Image::filled(size, [0.5; 3]);
    /// let mut shown = [Image::filled(size, [0.0; 3])];
    /// post.process(&Frame::new(&[&shaded], &views, 0), &mut shown)?;
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`FrameError`] if the foveation is not [`Quads`](crate::internal::Filter::Quads), and as for `process`.
    pub fn plan(&mut self, frame: &Frame<'_>) -> Result<&[Image<bool>], FrameError> {
        frame.check_plan(&self.desc)?;
        check_geometry(&self.desc, frame)?;
        check_sizes(&self.desc, "lod", frame.lod.map(|l| l.iter().map(|i| i.size())))?;
        let unshaded = Image::filled([1, 1], [0.0; 3]);
        let colors = vec![&unshaded; frame.views.len()];
        let frame = Frame { noise: None, ..frame.with_color(&colors) };
        let plans = sparse_pass::plan_quads(&self.desc, &self.history, &frame);
        let (quads, of_quads): (Vec<_>, Vec<_>) = plans.into_iter().unzip();
        let masks: Vec<_> = quads.iter().map(sparse_pass::Quads::pixels).collect();
        let of_pixels = |(mask, paths): (&Image<bool>, &Image<u8>)| {
            Image::from_fn(mask.size(), |[x, y]| {
                if mask.at(x as usize, y as usize) { paths.at(x as usize / 2, y as usize / 2) } else { 0 }
            })
        };
        let paths = masks.iter().zip(&of_quads).map(of_pixels).collect();
        let is_quarter = sparse_pass::is_quarter(&self.desc, &self.history, &frame);
        Ok(&self.planned.insert(Planned { index: frame.index, is_quarter, masks, paths, quads }).masks)
    }

    /// Number of paths to trace at each pixel of the last [`plan`](Self::plan), one image a view: 0 where no path is
    /// traced, at most 16; empty without a plan. With [`noisy`](crate::internal::Settings::noisy) a chosen pixel
    /// outside the fovea has as many as take more off its squared error, history included, than others; the
    /// [`budget`](crate::internal::Foveation::budget) counts all of them but the even pattern's first. Otherwise each
    /// chosen pixel has one.
    pub fn paths(&self) -> &[Image<u8>] {
        self.planned.as_ref().map_or(&[], |planned| &planned.paths)
    }

    /// Whether the last [`plan`](Self::plan) chose one pixel of each quad outside the fovea, because nothing was known:
    /// in the first frame and after a reset. These pixels can be drawn at half the width and height
    /// ([`ViewGeometry::half`](crate::ViewGeometry::half)), and given so
    /// ([`half`](crate::internal::FrameInputs::half)).
    pub fn is_quarter(&self) -> bool {
        self.planned.as_ref().is_some_and(|planned| planned.is_quarter)
    }
}
