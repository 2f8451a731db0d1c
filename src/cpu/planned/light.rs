//! Gain of history around samples, from their comparisons.

use super::view::View;
use crate::kernel::antialias::scattered_error;
use crate::kernel::color::root_difference;
use crate::kernel::sparse_smr::{
    Observation, ObservedAround, RELIT_ERRORS, add_observation, errors_left, mean_error, relight, vote,
};
use glam::{Vec2, Vec3};

impl View<'_> {
    /// Gain of history around a sample, and the weighted sum of the differences that it leaves. It is used if these are
    /// at most [`RELIT_ERRORS`] times those without it.
    #[inline(always)]
    pub(super) fn relit_around<I: Iterator<Item = Neighbour>>(
        &self,
        around: ObservedAround,
        neighbours: impl Fn() -> I,
    ) -> (Vec3, f32) {
        let errors = |gain| neighbours().fold(0.0, |sum, (o, weight, _)| sum + errors_left(o, gain) * weight);
        let without = errors(Vec3::ONE);
        let error = match self.antialiases {
            true => scattered_error(around, neighbours().fold(0.0, add_scatter)),
            false => mean_error(around),
        };
        let gain = if self.relights { relight(around, error) } else { Vec3::ONE };
        let with_gain = if gain == Vec3::ONE { without } else { errors(gain) };
        if with_gain <= without * RELIT_ERRORS { (gain, with_gain) } else { (Vec3::ONE, without) }
    }
}

/// Observation beside a sample, its weight, and its weight by position alone.
pub(super) type Neighbour = (Observation, f32, f32);

/// Sums over the observations around a sample.
#[inline(always)]
pub(super) fn observed_around(neighbours: impl Iterator<Item = Neighbour>) -> ObservedAround {
    neighbours.fold(ObservedAround::default(), |a, (o, weight, spatial)| add_observation(a, o, weight, spatial))
}

/// Sum of the [`vote`]s of other samples.
#[inline(always)]
pub(super) fn votes(others: impl Iterator<Item = Neighbour>) -> Vec2 {
    others.fold(Vec2::ZERO, |sum, (o, _, spatial)| sum + vote(o, errors_left(o, Vec3::ONE), spatial))
}

/// Weighted sum of squared differences between samples and history, with one more sample added.
#[inline(always)]
fn add_scatter(sum: f32, (o, weight, _): Neighbour) -> f32 {
    let difference = root_difference(o.sampled, o.history).min(1e6);
    sum + (difference * difference) * weight
}
