//! Repair of sparse frames: before shading, the renderer asks which pixels have no usable history, and shades these at
//! full rate.

use super::{CpuAfterimage, Frame, check_geometry, check_sizes, fill_geometry, sparse_pass};
use crate::error::FrameError;
use crate::frame::{ContextDesc, Planning};
use crate::image::Image;

/// Pixels that were chosen for a frame.
#[derive(Clone, Debug)]
pub(super) struct Planned {
    /// Number of the frame.
    index: u64,
    /// One mask a view.
    masks: Vec<Image<bool>>,
    /// The quads of a frame shaded by quads, one a view.
    pub quads: Vec<sparse_pass::Quads>,
}

impl CpuAfterimage {
    /// Pixels of a sparse frame to repair with a sample of their own, one mask a view: quads of 2x2 pixels whose
    /// history is missing or coarse, and in which the frame's lattices have no sample. If the frame is given to
    /// [`process`](Self::process) with samples of these pixels
    /// ([`FrameInputs::repaired`](crate::FrameInputs::repaired)), they are shown.
    ///
    /// At most the share [`Repair::budget`](crate::Repair::budget) of a view's quads is chosen: those without history
    /// first, then those whose history is coarse, each from the gaze outwards. After a cut, successive frames repair
    /// successive rings around the gaze.
    ///
    /// Give it the frame that will be processed, with the parts that are known before shading: views with their
    /// lattices, depth, motion, trust or reactive mask, index and reset. Its colors, noise and repaired samples are not
    /// read, and the colors may be an empty slice. History is unchanged: the same call gives the same masks.
    ///
    /// ```
    /// use afterimage::cpu::{CpuAfterimage, Frame};
    /// use afterimage::{ContextDesc, Filter, Gaze, Image, Method, Repair, Smr, ViewFrame, ViewGeometry};
    ///
    /// let size = [64, 36];
    /// let mut desc = ContextDesc::new(size);
    /// desc.settings.foveation.filter = Filter::Sparse;
    /// desc.settings.method = Method::Smr(Smr { repair: Some(Repair { budget: 0.1 }), ..Smr::default() });
    /// let mut post = CpuAfterimage::new(&desc)?;
    /// let geometry = ViewGeometry::flat(size, 70.0)?;
    /// let gaze_px = [40.0, 18.0];
    /// let lattices = Some(desc.settings.foveation.lattices(&geometry, gaze_px, 0));
    /// let views = [ViewFrame { lattices, ..ViewFrame::new(geometry, Gaze::At { px: gaze_px }) }];
    /// let masks = post.plan(&Frame::new(&[], &views, 0))?;
    /// // Here the renderer shades the samples of the lattices, and the pixels of the mask.
    /// let (sampled, shaded) = (Image::filled(size, [0.5; 3]), Image::filled(size, [0.5; 3]));
    /// let mut shown = [Image::filled(size, [0.0; 3])];
    /// post.process(&Frame { repaired: Some(&[&shaded]), ..Frame::new(&[&sampled], &views, 0) }, &mut shown)?;
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`FrameError`] if the settings have no [`repair`](crate::Smr::repair) or the foveation is not
    /// [`Sparse`](crate::Filter::Sparse), and as for `process`.
    pub fn plan(&mut self, frame: &Frame<'_>) -> Result<&[Image<bool>], FrameError> {
        let planning = frame.check_plan(&self.desc)?;
        check_geometry(&self.desc, frame)?;
        check_sizes(&self.desc, "lod", frame.lod.map(|l| l.iter().map(|i| i.size())))?;
        let unshaded = Image::filled([1, 1], [0.0; 3]);
        let colors = vec![&unshaded; frame.views.len()];
        let frame = Frame { noise: None, repaired: None, ..frame.with_color(&colors) };
        let repair = match planning {
            Planning::Repair(repair) => repair,
            Planning::Quads => {
                let quads = sparse_pass::plan_quads(&self.desc, &self.history, &frame);
                let masks = quads.iter().map(sparse_pass::Quads::pixels).collect();
                return Ok(&self.planned.insert(Planned { index: frame.index, masks, quads }).masks);
            }
        };
        let geometry = fill_geometry::filled(&self.desc, &frame, &self.history);
        let masks = fill_geometry::with_filled(geometry.as_deref(), &self.desc, &frame, |desc, frame| {
            sparse_pass::plan(desc, &self.history, frame, repair)
        });
        Ok(&self.planned.insert(Planned { index: frame.index, masks, quads: vec![] }).masks)
    }
}

/// Masks of the pixels that a frame repairs, one a view; empty if it repairs no pixel.
pub(super) fn masks<'a>(
    desc: &ContextDesc,
    planned: Option<&'a Planned>,
    frame: &Frame<'_>,
) -> Result<&'a [Image<bool>], FrameError> {
    frame.check_planned(desc, planned.map(|planned| planned.index))?;
    Ok(planned.filter(|_| frame.repaired.is_some()).map_or(&[], |planned| &planned.masks))
}
