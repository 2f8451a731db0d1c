//! What the pass does more where frames are jittered: means of samples in place of single ones.

use super::{
    Kept, Mean, Reconstruction, Vec2, Vec3, View, pack_color_by, pack_kept, reconstruct, rng, sanitize, stored_lod,
};
use crate::kernel::antialias::{Averaged, Near, add_near, average, clip, clipped, kept_mean, stands_before};

impl View<'_> {
    /// Place of this frame's samples in their pixels: a pixel shows what is at its position minus the jitter.
    #[inline(always)]
    pub(super) fn sample_place_px(&self) -> Vec2 {
        -Vec2::from(self.inputs.uniforms.jitter_px)
    }

    /// Disparity and motion of a pixel: those of the nearest surface around it, if that stands for it. `level`: of its
    /// lattice.
    #[inline(always)]
    pub(super) fn surface(&self, [x, y]: [u32; 2], level: u32) -> (f32, [f32; 2]) {
        let own = self.inputs.disparity(x, y);
        let own_motion = self.inputs.motion(x, y);
        if !self.antialiases || !self.inputs.tests_depth() {
            return (own, own_motion);
        }
        let [width, height] = self.inputs.size;
        let (mut nearest, mut at) = (own, [x, y]);
        for tap in 0..9 {
            let tx = (x + tap % 3).max(1).min(width) - 1;
            let ty = (y + tap / 3).max(1).min(height) - 1;
            let disparity = self.inputs.disparity(tx, ty);
            if disparity > nearest {
                (nearest, at) = (disparity, [tx, ty]);
            }
        }
        let motion = self.inputs.motion(at[0], at[1]);
        if stands_before(own, nearest, Vec2::from(own_motion), Vec2::from(motion), level == 0) {
            (nearest, motion)
        } else {
            (own, own_motion)
        }
    }

    /// Result at a pixel that has history and a usable candidate.
    #[inline(always)]
    pub(super) fn antialiased(
        &self,
        px: [u32; 2],
        level: u32,
        mut inputs: Reconstruction,
        samples: f32,
        is_own: bool,
    ) -> Averaged {
        if !is_own {
            return kept_mean(&inputs, reconstruct(&inputs), samples);
        }
        let mut kept = 1.0;
        if level == 0 {
            let clip = clip(self.near(px), inputs.history);
            inputs.history = clipped(inputs.history, clip.change);
            inputs.nearest.color = clipped(inputs.nearest.color, clip.change);
            kept = clip.kept;
        }
        average(&inputs, samples, self.sample_place_px(), kept)
    }

    /// Sums over the nine samples around a pixel of full rate, of which the own one is usable.
    #[inline(always)]
    fn near(&self, [x, y]: [u32; 2]) -> Near {
        let lattice = &self.lattices[0];
        let [first, last] = [lattice.first_px, lattice.points];
        let mut near = Near::default();
        for tap in 0..9 {
            let column = (x - first[0] + tap % 3).max(1).min(last[0]) - 1;
            let row = (y - first[1] + tap / 3).max(1).min(last[1]) - 1;
            let [u, v] = lattice.texel_of([column, row]);
            let (color, usable) = sanitize::color(Vec3::from(self.inputs.color.at(u as usize, v as usize)));
            if usable {
                near = add_near(near, color);
            }
        }
        near
    }

    /// Packs a mean of `samples`; its color is rounded by chance.
    #[inline(always)]
    pub(super) fn packed_mean(&self, [x, y]: [u32; 2], kept: Kept, samples: f32) -> [u32; 2] {
        let [_, word] = pack_kept(Kept { lod: stored_lod(Mean { lod: kept.lod, samples }), ..kept });
        let draw = rng::unit_draw(rng::bits(x, y, self.frame_low, self.inputs.uniforms.key));
        [pack_color_by(kept.color, draw), word]
    }
}
