//! Gains of the light in blocks of quads.

use super::view::{Samples, View};
use crate::cpu::quads::Quads;
use crate::kernel::antialias::{add_scatter, scattered_error};
use crate::kernel::reconstruction::{
    BLOCK_QUADS, Observation, add_around, add_observation, block_gain, block_vote, block_weight, has_majority,
    mean_error, none_around,
};
use crate::kernel::stored_sample::{pack_color, unpack_color};
use crate::parallel::collect;
use glam::{Vec2, Vec3};

/// Quads of a row whose comparisons are added before those of others.
const RUN_QUADS: u32 = 4;

/// The gain of each block, row by row.
#[derive(Debug)]
pub(super) struct BlockGains {
    gains: Vec<Vec3>,
    columns: u32,
}

impl BlockGains {
    /// The gain of the block of a quad.
    pub(super) fn of_quad(&self, [x, y]: [u32; 2]) -> Vec3 {
        self.gains[Quads::index([x / BLOCK_QUADS, y / BLOCK_QUADS], self.columns)]
    }
}

impl View<'_> {
    /// Gains of the light in the blocks of a frame, from comparisons of the samples with history.
    pub(super) fn block_gains(&self, quads: &Quads, observed: &Samples) -> BlockGains {
        let [columns, rows] = quads.size().map(|side| side.div_ceil(BLOCK_QUADS));
        let gain = |i| unpack_color(pack_color(self.block_gain([i % columns, i / columns], quads, observed)));
        BlockGains { gains: collect(columns * rows, gain), columns }
    }

    fn block_gain(&self, block: [u32; 2], quads: &Quads, observed: &Samples) -> Vec3 {
        let first = block.map(|v| v * BLOCK_QUADS);
        let per_row = BLOCK_QUADS / RUN_QUADS;
        let runs = || (0..BLOCK_QUADS * per_row).map(|i| [first[0] + i % per_row * RUN_QUADS, first[1] + i / per_row]);
        let sums = runs().map(|run| {
            self.of_run(run, quads, observed).fold((none_around(), 0.0), |(sum, scatter), o| {
                let weight = block_weight(o);
                (add_observation(sum, o, weight, weight), add_scatter(scatter, o, weight))
            })
        });
        let (sum, scatter) = sums.fold((none_around(), 0.0), |(a, s), (b, t)| (add_around(a, b), s + t));
        if !self.relights || sum.weight < 1e-6 {
            return Vec3::ONE;
        }
        let gain = block_gain(sum, if self.antialiases { scattered_error(sum, scatter) } else { mean_error(sum) });
        if gain == Vec3::ONE {
            return gain;
        }
        let votes = runs().map(|run| self.of_run(run, quads, observed).map(|o| block_vote(o, gain)).sum::<Vec2>());
        if has_majority(votes.sum()) { gain } else { Vec3::ONE }
    }

    /// Comparisons at the quads of a run that begins at quad (`x`, `y`).
    fn of_run(&self, [x, y]: [u32; 2], quads: &Quads, observed: &Samples) -> impl Iterator<Item = Observation> {
        let [columns, rows] = quads.size();
        let run =
            (x..(x + RUN_QUADS).min(columns)).map(move |x| [x, y]).filter(move |q| y < rows && quads.mask(*q) != 0);
        run.flat_map(|quad| self.pixels_of(quad)).filter_map(|px| self.observation_px(quads, px, observed))
    }
}
