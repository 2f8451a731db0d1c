//! Comparison of samples with history at their pixels.

use super::sparse_history::Found;
use super::view::View;
use crate::kernel::antialias::{Mean, expected_mean_error};
use crate::kernel::color::luma;
use crate::kernel::color::root_difference;
use crate::kernel::noise::expected_noise;
use crate::kernel::reconstruction::{Observation, expected_error, lod_confidence, noisy_lod_confidence};
use crate::kernel::stored_sample::has_moved;
use crate::notes::NoNotes;
use glam::{Vec2, Vec3};

impl View<'_> {
    /// Comparison of the sample of a pixel with history; `None` if either is missing, and at silhouettes.
    #[inline(always)]
    pub(super) fn observe_px(&self, px: [u32; 2], level: u32, sampled: Vec3, usable: bool) -> Option<Observation> {
        let surface = self.surface(px, level);
        // At a silhouette the difference does not say whether anything changed.
        let comparable = usable && !surface.is_silhouette;
        let mut source = self.source(px, &surface, &mut NoNotes).ok().filter(|_| comparable)?;
        if self.antialiases {
            // History is read at the sample's place in its pixel.
            let [x, y] = self.inputs.uniforms.jitter_px;
            source.previous.at = [source.previous.at[0] - x, source.previous.at[1] - y];
        }
        let found = self.interpolated(&source, self.past_albedos(px), &mut NoNotes);
        if found.history.lod < 0.0 {
            return None;
        }
        let own = self.albedo_at(px).truncate();
        let Found { history, noise: past, mean, albedos, .. } = found;
        let texture = self.texture(px, level, surface.is_edge, Some(&history), albedos, Some((sampled, own)));
        let history = texture.map_or(history, |texture| texture.of_sample().of_history(history));
        let [low, high] = history.range;
        let contrast = root_difference(low, high);
        let mut error = if self.antialiases {
            expected_mean_error(
                Mean { lod: history.lod, ..mean },
                contrast,
                has_moved(surface.motion.into(), Vec2::ZERO),
            )
        } else {
            expected_error(history.lod, contrast, has_moved(surface.motion.into(), history.nearest.place_px))
        };
        let is_still_mean = self.antialiases && !has_moved(surface.motion.into(), Vec2::ZERO);
        let deviation = if is_still_mean { mean.deviation } else { 0.0 };
        let mut confidence = lod_confidence(history.lod);
        if self.is_noisy {
            let around = luma(history.color);
            error += expected_noise(past, self.sample_noise(px), around);
            confidence = noisy_lod_confidence(history.lod, past, around);
        }
        Some(Observation { sampled, history: history.color, error, confidence, deviation })
    }
}
