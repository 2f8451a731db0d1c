//! Albedo in the pass: of the samples around a pixel, of history's texels, and of the result. Twin:
//! `shaders/planned/sparse_albedo.wgsl`.

use super::view::View;
use crate::kernel::demodulation::{
    LumaRanges, OwnAlbedo, PastAlbedo, Retextured, Texture, between, explained, exposed_lumas, given_albedo,
    kept_albedos, limited_albedo, no_lumas, past_albedo, retextured, texture_of, textured, unpack_albedo, with_luma,
};
use crate::kernel::reconstruction::Reconstructed;
use crate::kernel::rng;
use crate::kernel::stored_sample::{Around, Interpolated, StoredSample, interpolate, stored_weight};
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

/// The texture of a pixel's colors, and the albedos that they had before.
pub(super) struct PixelTexture {
    pub texture: Texture,
    /// Albedo of the sample or candidate.
    of_sample: Vec3,
    /// Of history.
    past: PastAlbedo,
    /// Whether the pixel's albedo is known.
    is_known: bool,
}

impl PixelTexture {
    /// History with this texture.
    #[inline(always)]
    pub fn of_history(&self, history: Interpolated) -> Interpolated {
        let factor = textured(self.texture, self.past.shown);
        let nearest = history.nearest;
        Interpolated {
            color: history.color * factor,
            range: history.range.map(|color| color * factor),
            nearest: StoredSample { color: nearest.color * textured(self.texture, self.past.kept), ..nearest },
            ..history
        }
    }

    /// With the texture of the sample as it is.
    #[inline(always)]
    pub fn of_sample(self) -> Self {
        Self { texture: Texture { albedo: self.of_sample, ..self.texture }, ..self }
    }

    /// Factor on the sample or candidate.
    #[inline(always)]
    pub fn on_sample(&self) -> Vec3 {
        textured(self.texture, self.of_sample)
    }
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

    /// The texture of a pixel's colors; `None` in frames without albedo. `at_edge`: whether it is at an edge of a
    /// surface; `history` and `past`: its history, if it has one, and the albedos of that; `sample`: color of this
    /// frame, and its albedo, if there is one.
    #[inline(always)]
    pub(super) fn texture(
        &self,
        px: [u32; 2],
        level: u32,
        at_edge: bool,
        history: Option<&Interpolated>,
        past: Option<PastAlbedos>,
        sample: Option<(Vec3, Vec3)>,
    ) -> Option<PixelTexture> {
        let past = past.or_else(|| self.past_albedos(px))?;
        let nearest_px = history.map_or(Vec2::ZERO, |history| history.nearest.place_px);
        let is_known = past.is_known && past.own.w > 0.0;
        let own = self.own_albedo(px, past.own.truncate());
        let kept = unpack_albedo(past.kept);
        let lumas = exposed_lumas(past.lumas, self.inputs.exposure);
        let lumas = sample.map_or(lumas, |(color, albedo)| with_luma(lumas, color, albedo));
        // At an edge history mixes surfaces, and one albedo does not explain the colors of several.
        let share = if level > 0 && history.is_some() && is_known && !at_edge { explained(lumas) } else { 0.0 };
        let of_past = past_albedo(own, past.shown, kept.truncate(), share);
        let texture = texture_of(own, of_past, kept_albedos(kept.w, nearest_px));
        let of_sample = sample.map_or(Vec3::ZERO, |(_, albedo)| albedo);
        Some(PixelTexture { texture, of_sample, past: of_past, is_known: past.own.w > 0.0 })
    }

    /// What the texture changes in the color that the pixel stores. `samples`: number of samples in its mean, if it has
    /// no history or is in the fovea.
    #[inline(always)]
    pub(super) fn retextured(
        &self,
        [x, y]: [u32; 2],
        pixel: &PixelTexture,
        result: &Reconstructed,
        samples: Option<f32>,
    ) -> Retextured {
        let PixelTexture { texture, of_sample, past, is_known } = *pixel;
        let old = if result.keeps_nearest { past.kept } else { past.shown };
        let of_color = between(of_sample, old, result.stored_share);
        let count = if is_known { samples.unwrap_or(texture.kept + 1.0) } else { 0.0 };
        let up = rng::unit_draw(rng::bits(x, y, self.frame_low, self.inputs.uniforms.key));
        retextured(texture, of_color, count, up)
    }
}
