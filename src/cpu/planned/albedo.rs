//! Albedo in the pass: of the samples around a pixel, of history's texels, and of the result. Twin:
//! `shaders/planned/sparse_albedo.wgsl`.

use super::view::View;
use crate::kernel::demodulation::{
    LumaRanges, OwnAlbedo, Retextured, between, explained, given_albedo, kept_albedos, limited_albedo, no_lumas,
    past_albedo, retextured, unpack_albedo, with_luma,
};
use crate::kernel::reconstruction::Reconstructed;
use crate::kernel::rng;
use crate::kernel::stored_sample::{Around, StoredSample, interpolate, stored_weight};
use glam::{Vec2, Vec3, Vec4};

/// Pixels beside one, as offsets from the pixel above and left of it.
const BESIDE: [[u32; 2]; 4] = [[0, 1], [2, 1], [1, 0], [1, 2]];

/// Sums over the texels of history around a position, by their albedo.
#[derive(Clone, Copy)]
pub(super) struct PastAlbedos {
    /// Albedo of the pixel.
    own: Vec4,
    /// Of the texels' albedos, as [`Around`] has them of their colors: by weight, and by that times the place.
    sums: [Vec3; 3],
    /// Of the stored colors, and if all had the albedo of the pixel.
    lumas: LumaRanges,
    /// Packed albedo of the sample to keep.
    kept: u32,
    /// Whether all albedos are known.
    is_known: bool,
    /// Albedo at the position.
    shown: Vec3,
}

impl PastAlbedos {
    /// Adds a texel of the pixel's surface with the albedo `word`. `is_nearest`: whether it is the one to keep so far.
    #[inline(always)]
    pub fn add(self, word: u32, stored: StoredSample, texel_px: Vec2, inverse_reach: f32, is_nearest: bool) -> Self {
        let there = unpack_albedo(word).truncate();
        let place = texel_px + stored.place_px;
        let weight = stored_weight(place.x * place.x + place.y * place.y, inverse_reach);
        let shares = [weight, weight * place.x, weight * place.y];
        Self {
            sums: [0, 1, 2].map(|i| self.sums[i] + there * shares[i]),
            lumas: with_luma(self.lumas, stored.color, there),
            kept: if is_nearest { word } else { self.kept },
            is_known: self.is_known && word != 0,
            ..self
        }
    }

    /// With the albedo at the position. `around`: sums over the colors of the same texels.
    #[inline(always)]
    pub fn with_shown(self, around: Around) -> Self {
        let [color, color_x, color_y] = self.sums;
        let nearest = StoredSample { color: unpack_albedo(self.kept).truncate(), ..around.nearest };
        let albedos = Around { color, color_x, color_y, nearest, ..around };
        Self { shown: interpolate(albedos).color, ..self }
    }
}

/// A pixel's candidate, history and result, whose texture becomes its own.
pub(super) struct Untextured {
    pub px: [u32; 2],
    pub level: u32,
    /// Whether it is at an edge of a surface.
    pub at_edge: bool,
    /// Albedo of the candidate.
    pub of_candidate: Vec3,
    pub past: Option<PastAlbedos>,
    pub result: Reconstructed,
    /// Number of samples in the mean.
    pub samples: f32,
}

impl View<'_> {
    /// Albedo of a pixel as it was given; black in frames without.
    #[inline(always)]
    fn given_albedo_at(&self, [x, y]: [u32; 2]) -> Vec3 {
        self.albedo.as_ref().map_or(Vec3::ZERO, |albedo| albedo.given.at(x as usize, y as usize).into())
    }

    /// Albedo of a pixel.
    #[inline(always)]
    pub(super) fn albedo_at(&self, px: [u32; 2]) -> Vec4 {
        given_albedo(self.given_albedo_at(px))
    }

    /// Packed albedo of a texel of history.
    #[inline(always)]
    pub(super) fn stored_albedo(&self, x: i32, y: i32) -> u32 {
        let [width, height] = self.inputs.size.map(|s| s as i32);
        let at = (y.clamp(0, height - 1) * width + x.clamp(0, width - 1)) as usize;
        self.albedo.as_ref().map_or(0, |albedo| albedo.past[at])
    }

    /// Albedo of a pixel, and the smallest and largest of it and the four beside it.
    #[inline(always)]
    fn own_albedo(&self, px: [u32; 2], own: Vec3) -> OwnAlbedo {
        let around = BESIDE.iter().fold([own; 2], |range, offset| {
            let at = [0, 1].map(|i| (px[i] + offset[i]).max(1).min(self.inputs.size[i]) - 1);
            let there = limited_albedo(self.given_albedo_at(at));
            [range[0].min(there), range[1].max(there)]
        });
        OwnAlbedo { albedo: own, around }
    }

    /// Sums over no texel; `None` in frames without albedo.
    #[inline(always)]
    pub(super) fn past_albedos(&self, px: [u32; 2]) -> Option<PastAlbedos> {
        self.albedo.as_ref()?;
        let own = self.albedo_at(px);
        Some(PastAlbedos {
            own,
            sums: [Vec3::ZERO; 3],
            lumas: no_lumas(own.truncate()),
            kept: 0,
            is_known: true,
            shown: Vec3::ZERO,
        })
    }

    /// What the pixel's own albedo changes in its result, and the word to store; `None` in frames without.
    #[inline(always)]
    pub(super) fn retexture(&self, pixel: &Untextured) -> Option<Retextured> {
        let past = match pixel.past {
            Some(past) => past,
            None => self.past_albedos(pixel.px)?,
        };
        let own = self.own_albedo(pixel.px, past.own.truncate());
        let kept_albedo = unpack_albedo(past.kept);
        let is_outside = pixel.level > 0 && pixel.past.is_some();
        let is_known = past.is_known && past.own.w > 0.0;
        // At an edge history mixes surfaces, and one albedo does not explain the colors of several.
        let share =
            if is_outside && is_known && !pixel.at_edge { explained(past.lumas, self.inputs.exposure) } else { 0.0 };
        let found = past_albedo(own, past.shown, kept_albedo.truncate(), share);
        let result = &pixel.result;
        let old = if result.keeps_nearest { found.kept } else { found.shown };
        let of_shown = between(pixel.of_candidate, found.shown, result.share);
        let of_stored = between(pixel.of_candidate, old, result.stored_share);
        let kept = kept_albedos(kept_albedo.w, result.stored.place_px);
        let count = match (past.own.w > 0.0, is_outside) {
            (false, _) => 0.0,
            (true, true) => kept + 1.0,
            (true, false) => pixel.samples,
        };
        let [x, y] = pixel.px;
        let up = rng::unit_draw(rng::bits(x, y, self.frame_low, self.inputs.uniforms.key));
        Some(retextured(own, found, [of_shown, of_stored], kept, count, up))
    }
}
