//! Antialiasing in the pass for jittered frames: history stores means of samples instead of single samples.

use super::sparse_history::Surroundings;
use super::view::View;
use crate::cpu::quads::Quads;
use crate::kernel::antialias::{
    Averaged, MOST_DIFFERENCE, Mean, Near, add_near, average, byte_draws, centred_change, clip, clipped, is_edge,
    is_in_front, is_silhouette, is_thin, kept_samples, move_together, stored_lod, surrounds_centre,
};
use crate::kernel::color::root_difference;
use crate::kernel::reconstruction::{Reconstruction, relit};
use crate::kernel::rng;
use crate::kernel::stored_sample::{StoredSample, has_moved, pack_color_by, pack_stored};
use crate::notes::{NoteStage, Notes};
use glam::{Vec2, Vec3};

impl View<'_> {
    /// Place of this frame's samples in their pixels: a pixel shows the point at its position minus the jitter.
    #[inline(always)]
    pub(super) fn sample_place_px(&self) -> Vec2 {
        -Vec2::from(self.inputs.uniforms.jitter_px)
    }

    /// The surface whose history a pixel continues: the nearest surface around it if [`is_in_front`] is true,
    /// otherwise its own. `level`: of its region.
    #[inline(always)]
    pub(super) fn surface(&self, [x, y]: [u32; 2], level: u32) -> Surroundings {
        let own = self.inputs.disparity(x, y);
        let own_motion = self.inputs.motion(x, y);
        let alone = Surroundings {
            disparity: own,
            motion: own_motion,
            stored: own,
            moved_px: self.inputs.moved_px([x, y], own, own_motion),
            mixed: None,
            is_silhouette: false,
            is_edge: false,
            is_moving_edge: false,
        };
        if !self.antialiases || !self.inputs.tests_depth() {
            return alone;
        }
        let [width, height] = self.inputs.size;
        let (mut nearest, mut nearest_at) = (own, [x, y]);
        let (mut farthest, mut farthest_at) = (own, [x, y]);
        let (mut thin, mut silhouette, mut edge) = (false, false, false);
        for pair in 0..4 {
            let [a, b] = [pair, 8 - pair].map(|tap| {
                let tx = (x + tap % 3).max(1).min(width) - 1;
                let ty = (y + tap / 3).max(1).min(height) - 1;
                let disparity = self.inputs.disparity(tx, ty);
                if disparity > nearest {
                    (nearest, nearest_at) = (disparity, [tx, ty]);
                }
                if disparity >= 0.0 && disparity < farthest {
                    (farthest, farthest_at) = (disparity, [tx, ty]);
                }
                disparity
            });
            thin |= is_thin(own, a, b);
            silhouette |= is_silhouette(own, a, b);
            edge |= is_edge(own, a, b);
        }
        let motion = self.inputs.motion(nearest_at[0], nearest_at[1]);
        let farthest_motion = self.inputs.motion(farthest_at[0], farthest_at[1]);
        let [own_px, nearest_px, farthest_px] = [own_motion, motion, farthest_motion].map(Vec2::from);
        // Still edges have long means of their own samples. Others would make them worse.
        let is_moving_edge = edge && level > 0 && has_moved(own_px, nearest_px);
        let mut surface = Surroundings { is_edge: edge, is_moving_edge, ..alone };
        if is_in_front(own, nearest, own_px, nearest_px, level == 0) {
            let moved_px = self.inputs.moved_px(nearest_at, nearest, motion);
            surface = Surroundings { disparity: nearest, motion, stored: nearest, moved_px, ..surface };
        }
        if own >= 0.0 && move_together(own_px, nearest_px, farthest_px) {
            let stored = if thin { farthest } else { own };
            let mixed = Some([farthest, nearest]);
            surface = Surroundings { stored, mixed, is_silhouette: silhouette, ..surface };
        }
        surface
    }

    /// Mean of history and of the pixel's own sample. `near`: sums over the samples around a pixel of the fovea;
    /// `at_edge`: whether the pixel is at a moving edge outside it; `error`: difference that is expected between
    /// history and sample.
    #[inline(always)]
    pub(super) fn averaged(
        &self,
        near: Option<Near>,
        at_edge: bool,
        mut inputs: Reconstruction,
        past: Mean,
        error: f32,
        notes: &mut impl Notes,
    ) -> Averaged {
        let difference = root_difference(inputs.candidate, inputs.history).min(MOST_DIFFERENCE);
        let kept = if let Some(near) = near {
            let clip = clip(near, inputs.history);
            inputs.history = clipped(inputs.history, clip.change);
            inputs.nearest.color = clipped(inputs.nearest.color, clip.change);
            notes.note(NoteStage::Comparison, "history clipped to the samples around", inputs.history, "linear light");
            clip.kept
        } else if at_edge {
            // A sample shows one surface, and history a mean of several.
            1.0
        } else {
            let history = relit(inputs.history, inputs.gain, inputs.range);
            kept_samples(error, root_difference(inputs.candidate, history))
        };
        notes.note(NoteStage::Comparison, "share of its samples that it keeps", kept, "");
        average(&inputs, past, self.sample_place_px(), at_edge, kept, difference, self.centred_change(near))
    }

    /// Sums over the nine pixels around a pixel of the fovea, as far as they are shaded; its own sample `own` is
    /// usable.
    #[inline(always)]
    pub(super) fn near(&self, quads: &Quads, px: [u32; 2], own: Vec3) -> Near {
        let place_px = self.sample_place_px();
        let mut near = Near::default();
        for tap in 0..9 {
            let offset = [tap % 3, tap / 3];
            let at = [0, 1].map(|i| (px[i] + offset[i]).max(1).min(self.inputs.size[i]) - 1);
            let (color, usable) = self.color_px(quads, at);
            if usable && quads.is_shaded(at) {
                let away_px = Vec2::new(offset[0] as f32 - 1.0, offset[1] as f32 - 1.0) + place_px;
                near = add_near(near, color, own, away_px);
            }
        }
        near
    }

    /// Change from the sample of a pixel of the fovea to the color of the samples around at the pixel's centre.
    #[inline(always)]
    pub(super) fn centred_change(&self, near: Option<Near>) -> Option<Vec3> {
        near.filter(|_| surrounds_centre(self.sample_place_px())).map(centred_change)
    }

    /// Packs a mean. Its color, number of samples and deviation are rounded stochastically.
    #[inline(always)]
    pub(super) fn packed_mean(&self, [x, y]: [u32; 2], stored: StoredSample, mean: Mean) -> [u32; 2] {
        let bits = rng::bits(x, y, self.frame_low, self.inputs.uniforms.key);
        let lod = stored_lod(Mean { lod: stored.lod, ..mean }, byte_draws(bits));
        let [_, word] = pack_stored(StoredSample { lod, ..stored });
        [pack_color_by(stored.color, rng::unit_draw(bits)), word]
    }
}
