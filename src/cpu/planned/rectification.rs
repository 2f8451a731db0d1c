//! Gain of history around samples, from their comparisons.

use super::view::View;
use crate::kernel::antialias::{add_scatter, scattered_error};
use crate::kernel::reconstruction::{
    Observation, ObservedAround, add_observation, errors_left, gain_helps, mean_error, none_around, relight, vote,
};
use glam::{Vec2, Vec3};

impl View<'_> {
    /// Gain of history around a sample, and the weighted sum of the differences that it leaves: that of the samples
    /// around, or that of its block, whichever leaves less. One is used if it [helps](gain_helps).
    #[inline(always)]
    pub(super) fn relit_around<I: Iterator<Item = Neighbour>>(
        &self,
        around: ObservedAround,
        neighbours: impl Fn() -> I,
        of_block: Vec3,
    ) -> (Vec3, f32) {
        let errors = |gain| neighbours().fold(0.0, |sum, (o, weight, _)| sum + errors_left(o, gain) * weight);
        let without = errors(Vec3::ONE);
        let error = match self.antialiases {
            true => scattered_error(around, neighbours().fold(0.0, |sum, (o, weight, _)| add_scatter(sum, o, weight))),
            false => mean_error(around),
        };
        let gains = if self.relights { [relight(around, error), of_block] } else { [Vec3::ONE; 2] };
        let mut best = (Vec3::ONE, without);
        for (gain, is_of_block) in gains.into_iter().zip([false, true]).filter(|(gain, _)| *gain != Vec3::ONE) {
            let left = errors(gain);
            if gain_helps(left, without, is_of_block) && left <= best.1 {
                best = (gain, left);
            }
        }
        best
    }
}

/// Observation beside a sample, its weight, and its weight by position alone.
pub(super) type Neighbour = (Observation, f32, f32);

/// Sums over the observations around a sample.
#[inline(always)]
pub(super) fn observed_around(neighbours: impl Iterator<Item = Neighbour>) -> ObservedAround {
    neighbours.fold(none_around(), |a, (o, weight, spatial)| add_observation(a, o, weight, spatial))
}

/// Sum of the [`vote`]s of other samples.
#[inline(always)]
pub(super) fn votes(others: impl Iterator<Item = Neighbour>) -> Vec2 {
    others.fold(Vec2::ZERO, |sum, (o, _, spatial)| sum + vote(o, errors_left(o, Vec3::ONE), spatial))
}
