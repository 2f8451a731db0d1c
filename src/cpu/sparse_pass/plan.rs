//! Plan of a repair, before a frame is shaded: which pixels should get a sample of their own. Its mathematics is in
//! `src/kernel/repair.rs`.
//!
//! Two loops. The first looks up history at each quad's pixels, as the pass will, and counts the quad's key; it skips
//! pixels that are settled. The second chooses the pixels whose quad has at least the smallest key that the budget pays
//! for.

use super::quads::Quads;
use super::view::View;
use crate::cpu::Frame;
use crate::cpu::history::History;
use crate::cpu::inputs::Inputs;
use crate::frame::ContextDesc;
use crate::image::Image;
use crate::kernel::antialias::mean_of;
use crate::kernel::kept::unpack_kept;
use crate::kernel::repair::{KEYS, WANTED_LOD, asked_px, budget_quads, priority, quad_key, threshold};
use crate::kernel::reproject::nearest;
use crate::kernel::sanitize;
use crate::method::HistoryLayout;
use crate::settings::Repair;
use crate::uniforms::LatticeUniforms;

/// Pixels to repair, view by view.
pub(in crate::cpu) fn plan(
    desc: &ContextDesc,
    history: &History,
    frame: &Frame<'_>,
    repair: Repair,
) -> Vec<Image<bool>> {
    let of_view = |i: usize| {
        let inputs = Inputs::new(desc, frame, i, &history.held_after(i, &frame.views[i]), history.is_filled());
        View::new(desc, frame, i, inputs, history.kept(i), &[]).plan(repair)
    };
    (0..frame.views.len()).map(of_view).collect()
}

/// Quads to shade, view by view.
pub(in crate::cpu) fn plan_quads(desc: &ContextDesc, history: &History, frame: &Frame<'_>) -> Vec<Quads> {
    let of_view = |i: usize| {
        let inputs = Inputs::new(desc, frame, i, &history.held_after(i, &frame.views[i]), history.is_filled());
        let foveation = &desc.settings.foveation;
        let has_memory = matches!(history.layout(), HistoryLayout::Kept { .. });
        View::new(desc, frame, i, inputs, history.kept(i), &[]).plan_quads(foveation, frame.index, has_memory)
    };
    (0..frame.views.len()).map(of_view).collect()
}

impl View<'_> {
    fn plan(&self, repair: Repair) -> Image<bool> {
        let size = self.inputs.size;
        let keys = Image::from_fn_parallel(size.map(|side| side.div_ceil(2)), |quad| self.key(quad));
        let mut counts = vec![0; KEYS as usize];
        for &key in keys.pixels() {
            counts[key as usize] += 1;
        }
        let threshold = threshold(&counts, budget_quads(repair.budget, keys.size()));
        Image::from_fn(size, |[x, y]| keys.at(x as usize / 2, y as usize / 2) >= threshold)
    }

    /// Key of a quad of 2x2 pixels, some of which may lie beyond the frame's edge.
    fn key(&self, [x, y]: [u32; 2]) -> u32 {
        let [width, height] = self.inputs.size;
        let mut largest = 0;
        for i in 0..2 {
            let px = asked_px(i, x, y, self.frame_low);
            if px[0] < width && px[1] < height && self.inputs.is_visible(px[0], px[1]) {
                largest = largest.max(self.priority(px));
            }
        }
        quad_key(largest, x, y, self.frame_low, self.inputs.uniforms.key)
    }

    /// Priority of a pixel for a sample of its own.
    fn priority(&self, px: [u32; 2]) -> u32 {
        let lattice = &self.lattices[LatticeUniforms::index_at(&self.lattices, px)];
        if lattice.around(px).is_some_and(|[x, y]| x.fraction == 0.0 && y.fraction == 0.0) {
            // The frame has a sample at this pixel.
            return 0;
        }
        if self.is_settled(px) {
            return 0;
        }
        let surface = self.surface(px, lattice.level);
        let lod = self.source(px, &surface).map_or(-1.0, |source| self.interpolated(&source).history.lod);
        let e_deg = self.inputs.eccentricity_deg(self.inputs.ray(px[0], px[1]));
        priority(lod, e_deg)
    }

    /// Whether the stored sample nearest to a pixel's previous position is fine and belongs to the pixel's surface.
    /// This quick test suffices for most pixels.
    fn is_settled(&self, [x, y]: [u32; 2]) -> bool {
        let inputs = &self.inputs;
        if inputs.reset {
            return false;
        }
        let Ok([qx, qy]) = nearest(x, y, inputs.motion(x, y), inputs.size) else { return false };
        let stored = unpack_kept(self.stored_words(qx as i32, qy as i32));
        let lod = if self.antialiases { mean_of(stored.lod).lod } else { stored.lod };
        let expected = inputs.expected_disparity(x, y, inputs.disparity(x, y));
        let same = inputs.same_disparity(expected, stored.disparity);
        let trusted = inputs.trust(x, y).is_none_or(|trust| sanitize::trust(trust) > 0.0);
        same && trusted && (0.0..WANTED_LOD).contains(&lod)
    }
}
