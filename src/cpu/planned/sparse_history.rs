//! Stored samples around the previous position of a pixel's surface: the step `ReprojectHistoryColor` of FSR2 (AMD
//! 2022), which resamples history by Lanczos in every frame.

use super::albedo::PastAlbedos;
use super::view::{NO_NOISE, View};
use crate::cpu::inputs::Previous;
use crate::kernel::antialias::{Mean, ONE_SAMPLE_LOD, is_of_surfaces, mean_lod, mean_of};
use crate::kernel::color::expose;
use crate::kernel::noise::{Noise, expose_noise, unpack_noise};
use crate::kernel::pack::{has_code, tap_codes, tap_codes_between};
use crate::kernel::reproject::Verdict;
use crate::kernel::stored_sample::{
    Around, INVERSE_MEAN_REACH, INVERSE_REACH, Interpolated, StoredSample, add_stored, can_replace, code_word,
    interpolate, is_empty, moved_alike, stored_weight, unpack_full, unpack_stored,
};
use crate::notes::{NoteStage, Notes};
use glam::{Vec2, Vec3};

/// The surface whose history a pixel continues.
#[derive(Clone, Copy)]
pub(super) struct Surroundings {
    pub disparity: f32,
    pub motion: [f32; 2],
    /// Disparity to store with the pixel.
    pub stored: f32,
    /// Motion in the world, in pixels a frame.
    pub moved_px: f32,
    /// Disparities of the farthest and the nearest surface around the pixel, if history may show any of them.
    pub mixed: Option<[f32; 2]>,
    /// Whether history is the mean of several surfaces, of which a sample shows one.
    pub is_silhouette: bool,
    /// Whether the pixel is at an edge of a surface.
    pub is_edge: bool,
    /// Whether that edge moves, and is outside the fovea.
    pub is_moving_edge: bool,
}

impl Surroundings {
    #[inline(always)]
    pub fn note(&self, notes: &mut impl Notes) {
        notes.note(NoteStage::Reprojection, "motion of the surface that is continued", self.motion, "px");
        notes.note(NoteStage::Reprojection, "its disparity now", self.disparity, "1/distance");
        notes.note(NoteStage::Reprojection, "its motion in the world", self.moved_px, "px a frame");
        notes.note(NoteStage::Reprojection, "silhouette, history is a mean of surfaces", self.is_silhouette, "");
        notes.note(NoteStage::Reprojection, "moving edge of a surface", self.is_moving_edge, "");
    }
}

/// Where a pixel's history is.
pub(super) struct Source {
    pub previous: Previous,
    /// Whether the nearest stored sample belongs to the surface.
    pub is_same: bool,
    /// Codes of the disparities that history may have.
    pub codes: [u32; 2],
    /// Motion of the surface in the world, in pixels a frame.
    pub moved_px: f32,
}

/// History at a previous position.
pub(super) struct Found {
    pub history: Interpolated,
    /// Noise of the sample to keep.
    pub noise: Noise,
    /// The texel to keep.
    pub mean: Mean,
    /// Alpha at the position, and of the sample to keep.
    pub alpha: [f32; 2],
    /// Sums over the albedos of its texels.
    pub albedos: Option<PastAlbedos>,
}

impl View<'_> {
    #[inline(always)]
    pub(super) fn stored_words(&self, x: i32, y: i32) -> [u32; 2] {
        let [width, height] = self.inputs.size.map(|s| s as i32);
        self.words[(y.clamp(0, height - 1) * width + x.clamp(0, width - 1)) as usize]
    }

    /// Alpha of a stored sample; `None` in frames without alpha.
    #[inline(always)]
    fn stored_alpha(&self, x: i32, y: i32) -> Option<f32> {
        let [width, height] = self.inputs.size.map(|s| s as i32);
        let at = (y.clamp(0, height - 1) * width + x.clamp(0, width - 1)) as usize;
        self.alpha.as_ref().map(|alpha| alpha.past[at])
    }

    /// Whether a stored sample may show a surface whose history has one of `codes`, and which moved by `moved_px` in
    /// the world.
    #[inline(always)]
    pub(super) fn is_reusable(&self, words: [u32; 2], codes: [u32; 2], moved_px: f32) -> bool {
        !self.inputs.tests_depth() || (has_code(code_word(words), codes) && moved_alike(words, moved_px))
    }

    /// Noise of a stored sample, in this frame's exposure.
    #[inline(always)]
    pub(super) fn stored_noise(&self, [x, y]: [i32; 2]) -> Noise {
        if !self.is_noisy {
            return NO_NOISE;
        }
        let [width, height] = self.inputs.size.map(|s| s as i32);
        let word = self.noise[(y.clamp(0, height - 1) * width + x.clamp(0, width - 1)) as usize];
        expose_noise(unpack_noise(word), self.inputs.exposure)
    }

    /// Previous position of a pixel's surface, or the verdict that rejects its history.
    #[inline(always)]
    pub(super) fn source(
        &self,
        [x, y]: [u32; 2],
        surface: &Surroundings,
        notes: &mut impl Notes,
    ) -> Result<Source, Verdict> {
        let moved_px = surface.moved_px;
        let (mut found, mut alike) = (0.0, false);
        let stored = |[qx, qy]: [u32; 2]| {
            let words = self.stored_words(qx as i32, qy as i32);
            let stored = unpack_stored(words);
            (found, alike) = (stored.disparity, !self.inputs.tests_depth() || moved_alike(words, moved_px));
            [stored.lod, stored.disparity]
        };
        let (previous, is_same) = self.inputs.reprojected(x, y, surface.motion, surface.disparity, stored, notes)?;
        notes.note(NoteStage::Reprojection, "the texel's surface moved alike in the world", alike, "");
        let Some(mixed) = surface.mixed else {
            let codes = tap_codes(previous.expected);
            return Ok(Source { previous, is_same: is_same && alike, codes, moved_px });
        };
        let [farthest, nearest] = mixed.map(|disparity| self.inputs.expected_disparity(x, y, disparity));
        let is_same = alike && (is_same || is_of_surfaces(found, farthest, nearest));
        notes.note(NoteStage::Reprojection, "one of the surfaces around, which move together", is_same, "");
        Ok(Source { previous, is_same, codes: tap_codes_between(farthest, nearest), moved_px })
    }

    /// History at a previous position, in this frame's exposure. At a silhouette the nearest stored sample may belong
    /// to another surface (`is_same` is false). Samples beside it then replace it if they are near enough. `albedos`:
    /// sums over none.
    #[inline(always)]
    pub(super) fn interpolated<N: Notes>(
        &self,
        Source { previous, is_same, codes, moved_px }: &Source,
        mut albedos: Option<PastAlbedos>,
        notes: &mut N,
    ) -> Found {
        // The place of a mean may lie anywhere around its texel's centre, so that the eight texels around the nearest
        // one also count.
        let (columns, [x, y]) = match self.antialiases {
            true => (3, previous.at.map(|v| (v + 0.5).floor() as i32 - 1)),
            false => (2, previous.at.map(|v| v.floor() as i32)),
        };
        let inverse_reach = if self.antialiases { INVERSE_MEAN_REACH } else { INVERSE_REACH };
        let mut around = Around::NOTHING;
        // The same samples with their alpha in place of their color.
        let mut alphas = Around::NOTHING;
        let mut nearest_texel = [x, y];
        let mut kept_lod = ONE_SAMPLE_LOD;
        for tap in 0..columns * columns {
            let (tx, ty) = (x + tap % columns, y + tap / columns);
            let words = self.stored_words(tx, ty);
            let same = !is_empty(words) && self.is_reusable(words, *codes, *moved_px);
            let texel_px = Vec2::new(tx as f32 - previous.at[0], ty as f32 - previous.at[1]);
            let cost = around.cost;
            let mut stored = unpack_full(words);
            let lod = stored.lod;
            if self.antialiases {
                stored.lod = mean_lod(lod);
            }
            if N::ON {
                let place = texel_px + stored.place_px;
                let weight = stored_weight(place.x * place.x + place.y * place.y, inverse_reach);
                let values = [tx as f32, ty as f32, place.x, place.y, weight, stored.lod, f32::from(same)];
                let unit = "x y px, sample from position px, weight, log2 px, same surface";
                notes.note(NoteStage::History, "texel", values, unit);
            }
            around = add_stored(around, stored, texel_px, same, inverse_reach);
            if let Some(alpha) = self.stored_alpha(tx, ty) {
                let stored = StoredSample { color: Vec3::splat(alpha), ..stored };
                alphas = add_stored(alphas, stored, texel_px, same, inverse_reach);
            }
            let is_nearest = around.cost < cost;
            if same {
                let word = self.stored_albedo(tx, ty);
                albedos = albedos.map(|albedos| albedos.add(word, stored, texel_px, inverse_reach, is_nearest));
            }
            if is_nearest {
                (nearest_texel, kept_lod) = ([tx, ty], lod);
            }
        }
        notes.note(NoteStage::History, "sum of weights", around.weight, "");
        let around = if *is_same || can_replace(around) { around } else { Around::NOTHING };
        let albedos = albedos.map(|albedos| albedos.with_shown(around));
        let found = interpolate(around);
        let exposed = |c: Vec3| expose(c, self.inputs.exposure);
        let nearest = StoredSample { color: exposed(found.nearest.color), ..found.nearest };
        let history = Interpolated { color: exposed(found.color), range: found.range.map(exposed), nearest, ..found };
        notes.note(NoteStage::History, "color", history.color, "linear light");
        notes.note(NoteStage::History, "level of detail", history.lod, "log2 px, below 0: none");
        notes.note(NoteStage::History, "sample to keep", nearest.color, "linear light");
        notes.note(NoteStage::History, "its place", nearest.place_px, "px from the position");
        let kept = mean_of(kept_lod);
        notes.note(NoteStage::History, "its number of samples", kept.samples, "");
        notes.note(NoteStage::History, "their standard deviation", kept.deviation, "100 from black to white");
        let alpha = self.alpha.as_ref().map_or([1.0; 2], |_| {
            // A plane through samples may exceed them; an alpha may not.
            let Interpolated { color, range: [low, high], nearest, .. } = interpolate(alphas);
            [color.x.max(low.x).min(high.x), nearest.color.x]
        });
        Found { history, noise: self.stored_noise(nearest_texel), mean: kept, alpha, albedos }
    }
}
