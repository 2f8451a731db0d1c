//! Gain and fit of history around the samples of lattices.

use super::view::{Samples, View};
use crate::kernel::antialias::scattered_error;
use crate::kernel::depth::INVALID_DISPARITY;
use crate::kernel::smr::root_difference;
use crate::kernel::sparse_smr::{
    LIGHT_RELATIVE, Lit, Observation, ObservedAround, add_observation, agreement, capped_error, errors_left, fit,
    fit_around, fit_of_samples, mean_error, mean_fit, neighbour_weight, own_fit, pack_lit, relight, vote,
};
use glam::{Vec2, Vec3};

impl View<'_> {
    /// Gain and fit around a sample, packed ([`pack_lit`]).
    #[inline(always)]
    pub(super) fn light(&self, lattice: usize, point: [u32; 2], observed: &[Samples]) -> [u32; 2] {
        let own = self.observation(lattice, point, observed);
        let grid = &self.lattices[lattice];
        let disparity_of = |point: [u32; 2]| {
            let [x, y] = grid.px_of(point);
            self.inputs.disparity(x, y)
        };
        let disparity = disparity_of(point);
        let neighbours = || {
            (0..9).filter_map(|tap| {
                let offset = [tap % 3 - 1, tap / 3 - 1];
                let at = [0, 1].map(|i| point[i].checked_add_signed(offset[i]).filter(|&v| v < grid.points[i]));
                let [Some(x), Some(y)] = at else { return None };
                let other = self.observation(lattice, [x, y], observed)?;
                let alike = self.alike(disparity, disparity_of([x, y]), LIGHT_RELATIVE);
                let spatial = neighbour_weight(offset);
                alike.then(|| {
                    (other, own.map_or(spatial * other.confidence, |own| agreement(own, other, spatial)), spatial)
                })
            })
        };
        let around = observed_around(neighbours());
        // A single noisy sample does not show whether history fits.
        let judged = own.filter(|_| !self.is_noisy);
        let fit_of_own = |gain| judged.map_or(1.0, |own| own_fit(own, gain));
        // A sample without disparity is interpolated only where no other sample is near.
        let disparity = if self.is_doubtful(lattice, point, observed) { INVALID_DISPARITY } else { disparity };
        let unlit = Lit { gain: Vec3::ONE, fit: 1.0, own_fit: fit_of_own(Vec3::ONE), is_own: own.is_some(), disparity };
        if around.weight < 1e-6 {
            return pack_lit(unlit);
        }
        let (gain, left) = self.relit_around(around, neighbours, 1.0);
        let confidence = (around.weight / around.spatial).min(1.0);
        let fit = if self.is_noisy {
            fit(left / around.weight, confidence).min(mean_fit(around, confidence))
        } else {
            fit_around(around, left, fit_of_samples(around, capped_around(neighbours())))
        };
        pack_lit(Lit { gain, fit, own_fit: fit_of_own(gain), ..unlit })
    }

    /// Gain of history around a sample, and the weighted sum of the differences that it leaves. It is used if these are
    /// at most `tolerance` times those without it.
    #[inline(always)]
    pub(super) fn relit_around<I: Iterator<Item = Neighbour>>(
        &self,
        around: ObservedAround,
        neighbours: impl Fn() -> I,
        tolerance: f32,
    ) -> (Vec3, f32) {
        let errors = |gain| neighbours().fold(0.0, |sum, (o, weight, _)| sum + errors_left(o, gain) * weight);
        let without = errors(Vec3::ONE);
        let error = match self.antialiases {
            true => scattered_error(around, neighbours().fold(0.0, add_scatter)),
            false => mean_error(around),
        };
        let gain = if self.relights { relight(around, error) } else { Vec3::ONE };
        let with_gain = if gain == Vec3::ONE { without } else { errors(gain) };
        if with_gain <= without * tolerance { (gain, with_gain) } else { (Vec3::ONE, without) }
    }
}

/// Observation beside a sample, its weight, and its weight by position alone.
pub(super) type Neighbour = (Observation, f32, f32);

/// Sums over the observations around a sample.
#[inline(always)]
pub(super) fn observed_around(neighbours: impl Iterator<Item = Neighbour>) -> ObservedAround {
    neighbours.fold(ObservedAround::default(), |a, (o, weight, spatial)| add_observation(a, o, weight, spatial))
}

/// Sum of [`capped_error`] around a sample, without a gain.
#[inline(always)]
fn capped_around(neighbours: impl Iterator<Item = Neighbour>) -> f32 {
    neighbours.fold(0.0, |sum, (o, _, spatial)| sum + capped_error(o, errors_left(o, Vec3::ONE), spatial))
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
