//! Albedo demodulation of planned frames: light is interpolated and remembered, and texture is the pixel's own.
//!
//! Denoisers and ray reconstruction divide colors by albedo (Schied et al. 2017), which fails where albedo says
//! nothing: gloss, metal, glass, the sky. Here colors stay colors. Between two places a color changes by the quotient
//! of their albedos, as far as that explains the contrast of the colors at hand.
//!
//! An albedo is red, green and blue from 0 to 1. Every texel of history has that of its color in a word, with the
//! number of albedos of which it is the mean; 0: it is not known.
//!
//! | bits | |
//! |---|---|
//! | 0-26 | red, green, blue: 9 bits each, in 512ths |
//! | 27-31 | number of albedos |

use super::color::luma;
use super::sanitize::{MAX_HALF, is_finite};
use glam::{Vec2, Vec3, Vec4};

/// Stored steps of an albedo.
const ALBEDO_STEPS: f32 = 512.0;
/// Largest stored albedo.
const LARGEST_ALBEDO: f32 = 511.0 / ALBEDO_STEPS;
/// Added to albedos in quotients: light that a surface reflects without its texture.
const ALBEDO_FLOOR: f32 = 0.04;
/// Largest quotient; the smallest one is its inverse.
const MOST_QUOTIENT: f32 = 4.0;
/// Largest number of albedos in a mean, and in one that is read between its texels.
const MOST_ALBEDOS: [f32; 2] = [29.0, 3.0];
/// Cost of a clip of history's albedo to those around: the share of its albedos that a mean loses, per clip distance. A
/// clip by a quarter costs all.
const ALBEDO_CLIP_COST: f32 = 4.0;
/// Contrast that albedo must explain in full: a share of the colors' contrast, and a constant (100 from black to
/// white).
const EXPLAINED: [f32; 2] = [0.5, 0.1];

/// Albedo of a pixel as the renderer wrote it, limited to what is stored; 0 for NaN.
#[inline]
pub fn limited_albedo(given: Vec3) -> Vec3 {
    let limited = |v: f32| if v > 0.0 { v.min(LARGEST_ALBEDO) } else { 0.0 };
    Vec3::new(limited(given.x), limited(given.y), limited(given.z))
}

/// The same, and 1; or 0 if it is unknown, because a channel, or their sum, is NaN or infinite.
#[inline]
pub fn given_albedo(given: Vec3) -> Vec4 {
    limited_albedo(given).extend(if is_finite((given.x + given.y) + given.z) { 1.0 } else { 0.0 })
}

/// Factor on a color whose albedo changes.
#[inline]
pub fn quotient(to: Vec3, from: Vec3) -> Vec3 {
    // The limit, below which all albedos are, keeps compilers from adding the floor to an earlier term.
    let raised = |albedo: Vec3| albedo.min(Vec3::splat(LARGEST_ALBEDO)) + Vec3::splat(ALBEDO_FLOOR);
    (raised(to) / raised(from)).clamp(Vec3::splat(1.0 / MOST_QUOTIENT), Vec3::splat(MOST_QUOTIENT))
}

/// Luma of an albedo, and the floor.
#[inline]
pub fn raised_luma(albedo: Vec3) -> f32 {
    // The limit is for compilers, as in `quotient`.
    luma(albedo).min(LARGEST_ALBEDO) + ALBEDO_FLOOR
}

/// Smallest and largest luma of some colors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LumaRanges {
    /// Luma of the pixel's albedo, and the floor.
    pub own: f32,
    /// Of the colors as they are.
    pub color: Vec2,
    /// If all had the pixel's albedo.
    pub lit: Vec2,
}

/// Ranges of no color around a pixel with the albedo `own`.
#[inline]
pub fn no_lumas(own: Vec3) -> LumaRanges {
    let none = Vec2::new(MAX_HALF, 0.0);
    LumaRanges { own: raised_luma(own), color: none, lit: none }
}

/// With a color of the albedo `there`.
#[inline]
pub fn with_luma(ranges: LumaRanges, color: Vec3, there: Vec3) -> LumaRanges {
    let light = luma(color);
    let lit = light * (ranges.own / raised_luma(there)).clamp(1.0 / MOST_QUOTIENT, MOST_QUOTIENT);
    let widened = |range: Vec2, v: f32| Vec2::new(range.x.min(v), range.y.max(v));
    LumaRanges { color: widened(ranges.color, light), lit: widened(ranges.lit, lit), ..ranges }
}

/// Ranges of colors that get an exposure.
#[inline]
pub fn exposed_lumas(ranges: LumaRanges, exposure: f32) -> LumaRanges {
    LumaRanges { color: ranges.color * exposure, lit: ranges.lit * exposure, ..ranges }
}

/// Degree to which albedo explains the contrast of some colors, in \[0, 1\].
#[inline]
pub fn explained(ranges: LumaRanges) -> f32 {
    let root = |v: f32| v.max(0.0).sqrt();
    let contrast = (root(ranges.color.y) - root(ranges.color.x)) * 100.0;
    let left = (root(ranges.lit.y) - root(ranges.lit.x)) * 100.0;
    ((contrast - left) / (contrast * EXPLAINED[0] + EXPLAINED[1])).clamp(0.0, 1.0)
}

/// The part of a factor that is explained.
#[inline]
pub fn part(factor: Vec3, explained: f32) -> Vec3 {
    // Compilers rewrite `1.0 + (factor - 1.0) * explained` as this sum, which rounds in another way.
    factor * explained + Vec3::splat(1.0 - explained)
}

/// Albedo between two.
#[inline]
pub fn between(from: Vec3, to: Vec3, share: f32) -> Vec3 {
    from + (to - from) * share
}

/// Sums over the samples around a pixel, by their albedo.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AlbedoSums {
    /// Albedos times weights, and these weights.
    pub sum: Vec4,
    /// Of the samples, and if all had the pixel's albedo.
    pub lumas: LumaRanges,
}

/// Sums over no sample around a pixel with the albedo `own`.
#[inline]
pub fn no_albedos(own: Vec3) -> AlbedoSums {
    AlbedoSums { sum: Vec4::ZERO, lumas: no_lumas(own) }
}

/// Adds a sample with its albedo `there` around a pixel with the albedo `own`, which stands for an unknown one.
#[inline]
pub fn add_albedo(sums: AlbedoSums, own: Vec4, there: Vec4, color: Vec3, weight: f32) -> AlbedoSums {
    let known = if there.w > 0.0 { there } else { own }.truncate();
    AlbedoSums { sum: sums.sum + (known * weight).extend(weight), lumas: with_luma(sums.lumas, color, known) }
}

/// What albedo changes in a candidate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AlbedoChange {
    /// Albedo of the changed colors.
    pub albedo: Vec3,
    /// Factor on the colors.
    pub factor: Vec3,
}

impl AlbedoChange {
    /// Of a candidate without albedo.
    pub const NONE: Self = Self::none(Vec3::ZERO);

    /// Of a pixel's own sample.
    #[inline]
    pub const fn none(albedo: Vec3) -> Self {
        Self { albedo, factor: Vec3::ONE }
    }
}

/// What the albedo `own` of a pixel between samples changes in its candidate. `has_surface`: whether one of the samples
/// shows the pixel's surface.
#[inline]
pub fn candidate_change(sums: AlbedoSums, own: Vec4, has_surface: bool) -> AlbedoChange {
    let mean = sums.sum.truncate() * (1.0 / sums.sum.w);
    let explained = if has_surface && own.w > 0.0 { explained(sums.lumas) } else { 0.0 };
    let own = own.truncate();
    AlbedoChange { albedo: between(mean, own, explained), factor: part(quotient(own, mean), explained) }
}

/// What the pixel's own albedo says beside history.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OwnAlbedo {
    /// That of this frame.
    pub albedo: Vec3,
    /// Smallest and largest around it.
    pub around: [Vec3; 2],
}

/// Albedos of a pixel's history.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PastAlbedo {
    /// At the position.
    pub shown: Vec3,
    /// Of the sample to keep.
    pub kept: Vec3,
    /// Degree to which the pixel's albedo explains history's contrast.
    pub explained: f32,
}

/// Albedos of history, with the degree to which the pixel's own explains its contrast. An albedo that is alike
/// everywhere explains nothing: stored albedos differ by their rounding.
#[inline]
pub fn past_albedo(own: OwnAlbedo, shown: Vec3, kept: Vec3, explained: f32) -> PastAlbedo {
    let all = [own.around[0].min(kept), own.around[1].max(kept)];
    let differs = (all[1] - all[0]).max_element() > 1.0 / ALBEDO_STEPS;
    // A plane through texels may exceed them.
    PastAlbedo { shown: shown.max(all[0]).min(all[1]), kept, explained: if differs { explained } else { 0.0 } }
}

/// Number of albedos that a mean keeps. `place_px`: of its sample; one that is read between texels blurs.
#[inline]
pub fn kept_albedos(count: f32, place_px: Vec2) -> f32 {
    let away = (place_px.x.abs().max(place_px.y.abs()) * 4.0).min(1.0);
    count.min(MOST_ALBEDOS[0] + (MOST_ALBEDOS[1] - MOST_ALBEDOS[0]) * away)
}

/// Mean of `kept` albedos of history, as far as this frame has such, and of the pixel's own.
#[inline]
pub fn mean_albedo(past: Vec3, own: OwnAlbedo, kept: f32) -> Vec3 {
    let clipped = past.max(own.around[0]).min(own.around[1]);
    clipped + (own.albedo - clipped) * (1.0 / (kept + 1.0))
}

/// The one texture that a pixel's colors get before they are compared and blended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Texture {
    /// Its albedo.
    pub albedo: Vec3,
    /// Albedo to store.
    pub stored: Vec3,
    /// Degree to which albedo explains the contrast of the colors.
    pub explained: f32,
    /// Number of albedos that history's mean keeps.
    pub kept: f32,
}

/// The mean of this texture in all frames. `count`: number of albedos in history's mean. A mean outside of the albedos
/// around is of another texture, and loses them.
#[inline]
pub fn texture_of(own: OwnAlbedo, past: PastAlbedo, count: f32) -> Texture {
    let outside = past.kept - past.kept.max(own.around[0]).min(own.around[1]);
    let kept = count * (1.0 - (outside.abs().max_element() * ALBEDO_CLIP_COST).min(1.0));
    Texture {
        albedo: mean_albedo(past.shown, own, kept),
        stored: mean_albedo(past.kept, own, kept),
        explained: past.explained,
        kept,
    }
}

/// Factor on a color of the albedo `of_color` that gets a texture.
#[inline]
pub fn textured(texture: Texture, of_color: Vec3) -> Vec3 {
    part(quotient(texture.albedo, of_color), texture.explained)
}

/// What a pixel's texture changes in the color that it stores.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Retextured {
    /// Factor on the color.
    pub factor: Vec3,
    /// Share of this frame's place in that of the stored sample.
    pub place_share: f32,
    /// Word of the stored color's albedo ([`pack_albedo`]).
    pub word: u32,
}

/// The color to store, whose albedo was `of_color` before it got the texture. `count`: number of albedos to store;
/// `up`: uniform in \[0, 1).
#[inline]
pub fn retextured(texture: Texture, of_color: Vec3, count: f32, up: f32) -> Retextured {
    let target = between(of_color, texture.stored, texture.explained);
    let word = pack_albedo(target, count, up);
    // The color follows the rounding of its albedo: errors do not add up.
    let stored = texture.stored + (unpack_albedo(word).truncate() - target);
    Retextured {
        factor: part(quotient(stored, texture.albedo), texture.explained),
        place_share: texture.explained * (1.0 / (texture.kept + 1.0)),
        word,
    }
}

/// Packs an albedo, of which there are `count`; 0: unknown. It is rounded stochastically: if `up` is uniform in
/// \[0, 1), the mean of what is stored is the albedo itself.
#[inline]
pub fn pack_albedo(a: Vec3, count: f32, up: f32) -> u32 {
    if count <= 0.0 {
        return 0;
    }
    let channel = |v: f32| (v.clamp(0.0, LARGEST_ALBEDO) * ALBEDO_STEPS + up) as u32;
    let count = (count.clamp(0.0, 31.0) + 0.5) as u32;
    channel(a.x) | channel(a.y) << 9 | channel(a.z) << 18 | count << 27
}

/// Albedo of a packed word, and the number of albedos in it.
#[inline]
pub fn unpack_albedo(word: u32) -> Vec4 {
    let channel = |bits: u32| (bits & 511) as f32 * (1.0 / ALBEDO_STEPS);
    Vec4::new(channel(word), channel(word >> 9), channel(word >> 18), (word >> 27) as f32)
}
