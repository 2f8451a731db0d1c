//! Storage of a sample that keeps its sub-pixel position, in two words, and interpolation of such samples.
//!
//! History that is resampled in every frame loses detail in every frame. Here a texel holds one unfiltered sample of
//! the renderer, and the place of that sample relative to the texel's centre. Reprojection changes the place, not the
//! color. Only the displayed color is interpolated.
//!
//! | word | bits | |
//! |---|---|---|
//! | 0 | 0-26 | red, green, blue: 9 bits each, multiples of 2^(exponent - 24) |
//! | 0 | 27-31 | exponent that the three share |
//! | 1 | 0-7 | code of the level of detail, in steps as in [`surface`](super::surface); 0: empty |
//! | 1 | 8-18 | disparity: [`disparity_code`] without its last five bits |
//! | 1 | 19 | whether the surface moved in the world ([`with_motion`]) |
//! | 1 | 20-25 | x of the place, in 1/24 pixel, plus 32 |
//! | 1 | 26-31 | y of the place |
//!
//! Packing an unpacked sample gives the same words, but for bit 19. All zeros are an empty texel.

use super::lod::{EMPTY_LOD, LOD_STEPS, lod_value};
use super::pack::{disparity_code, disparity_value};
use glam::{Vec2, Vec3};

/// Largest stored color: 511/512 of 2^16.
pub const MAX_COLOR: f32 = 65408.0;

/// Smallest exponent of the largest channel; a smaller channel is stored with fewer bits.
const SMALLEST_EXPONENT: u32 = 111;
/// Largest level of detail in stored steps.
const MOST_STEPS: f32 = 254.0;
/// Stored steps a pixel of a sample's place.
const PLACE_STEPS: f32 = 24.0;

/// Farthest place of a sample from its texel's centre along an axis, in pixels. Farther ones are resampled.
pub const FARTHEST_PX: f32 = 1.2;
/// Distance along each axis, in pixels, up to which a sample counts as lying exactly at a position: half a stored step.
pub const EXACT_PX: f32 = 0.5 / PLACE_STEPS;

/// A sample at this squared distance in pixels or more has no weight.
const REACH_PX2: f32 = 3.0;
/// The same for means of jittered samples.
const MEAN_REACH_PX2: f32 = 1.7;
/// Added to squared distances, so that a sample at the position itself has a finite weight.
const SOFTEN_PX2: f32 = 0.03;
/// Added to the variance of the samples' places, so that a plane through few samples stays flat.
pub const STIFF_PX2: f32 = 0.01;
/// Cost of a level of detail in the choice of the sample to keep, in squared pixels.
const LOD_PX2: f32 = 0.3;

/// Bit of the second word: the surface moved in the world in the frame that stored the sample.
pub const MOVES: u32 = 1 << 19;
/// Motion in the world, in pixels a frame, from which on a surface is stored as one that moves.
const MOVES_PX: f32 = 0.5;
/// Motion at which a surface may have stood still in the previous frame, at the most.
const STARTED_PX: f32 = 2.0;
/// Motion at which a surface may have moved in the previous frame, at least.
const STOPPED_PX: f32 = 0.125;
/// Stands for a motion that is not known: the history of any surface is accepted.
pub const UNKNOWN_MOVED_PX: f32 = 0.5;

/// Stored sample of a surface point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StoredSample {
    /// Linear color, at least 0.
    pub color: Vec3,
    /// Level of detail of the sample: log2 of the block edge in pixels. Negative: the texel is empty.
    pub lod: f32,
    /// Disparity in the frame that stored it; negative: unknown.
    pub disparity: f32,
    /// Place of the sample relative to the texel's centre, in pixels.
    pub place_px: Vec2,
}

impl StoredSample {
    /// Empty texel.
    pub const EMPTY: Self = Self { color: Vec3::ZERO, lod: -1.0, disparity: -1.0, place_px: Vec2::ZERO };
}

/// `v` as a multiple of the step that belongs to `exponent`, an exponent coded as in a float. It is rounded up if its
/// fraction plus `up` is at least 1; an `up` of 0.5 rounds to the nearest.
#[inline]
pub fn multiple(v: f32, exponent: u32, up: f32) -> u32 {
    // A power of two: the product is exact.
    (v * f32::from_bits((262 - exponent) << 23) + up) as u32
}

/// Packs a color: 9 bits a channel and an exponent that the three share, each rounded to the nearest. The color must
/// not be NaN; negative channels become 0. The error of a channel is at most 2^-9 of the largest one.
#[inline]
pub fn pack_color(c: Vec3) -> u32 {
    pack_color_by(c, 0.5)
}

/// As [`pack_color`], with stochastic rounding: if `up` is uniform in \[0, 1), the probability of rounding up is the
/// fraction that is cut off. A mean that is stored in each frame then has no drift and follows small differences.
#[inline]
pub fn pack_color_by(c: Vec3, up: f32) -> u32 {
    let channel = |v: f32| if v > 0.0 { v.min(MAX_COLOR) } else { 0.0 };
    let (r, g, b) = (channel(c.x), channel(c.y), channel(c.z));
    let largest = r.max(g).max(b);
    let exponent = (largest.to_bits() >> 23).max(SMALLEST_EXPONENT);
    // Rounding may carry into a tenth bit.
    let exponent = exponent + (multiple(largest, exponent, up) >> 9);
    multiple(r, exponent, up)
        | multiple(g, exponent, up) << 9
        | multiple(b, exponent, up) << 18
        | (exponent - SMALLEST_EXPONENT) << 27
}

/// Color of a packed word; finite for any word.
#[inline]
pub fn unpack_color(word: u32) -> Vec3 {
    let unit = f32::from_bits(((word >> 27) + (SMALLEST_EXPONENT - 8)) << 23);
    let channel = |bits: u32| (bits & 511) as f32 * unit;
    Vec3::new(channel(word), channel(word >> 9), channel(word >> 18))
}

/// Code of a place along an axis, in pixels.
#[inline]
pub fn pack_place(px: f32) -> u32 {
    (px * PLACE_STEPS + 32.5).floor().clamp(0.0, 63.0) as u32
}

/// Place along an axis of the code in the low six bits, in pixels.
#[inline]
pub fn unpack_place(bits: u32) -> f32 {
    ((bits & 63) as f32 - 32.0) * (1.0 / PLACE_STEPS)
}

/// Packs a sample. The color must not be NaN.
#[inline]
pub fn pack_stored(s: StoredSample) -> [u32; 2] {
    let lod = if s.lod < 0.0 { EMPTY_LOD } else { ((s.lod * LOD_STEPS).min(MOST_STEPS) + 1.5) as u32 };
    let disparity = disparity_code(s.disparity);
    // The last code stands for an unknown disparity.
    let disparity = if disparity == 0xffff { 0x7ff } else { ((disparity + 16) >> 5).min(0x7fe) };
    [pack_color(s.color), lod | disparity << 8 | pack_place(s.place_px.x) << 20 | pack_place(s.place_px.y) << 26]
}

/// Unpacks a sample. The result is finite for any words.
#[inline]
pub fn unpack_stored(words: [u32; 2]) -> StoredSample {
    if is_empty(words) { StoredSample::EMPTY } else { unpack_full(words) }
}

/// Whether a texel is empty.
#[inline]
pub fn is_empty(words: [u32; 2]) -> bool {
    words[1] & 255 == EMPTY_LOD
}

/// A packed sample of a surface that moved by `moved_px` in the world ([`UNKNOWN_MOVED_PX`] if that is not known).
#[inline]
pub fn with_motion(words: [u32; 2], moved_px: f32) -> [u32; 2] {
    [words[0], words[1] | if moved_px > MOVES_PX { MOVES } else { 0 }]
}

/// Whether a stored sample may be of a surface that moved by `moved_px` in the world. Depth cannot tell a foot from the
/// ground on which it stands, but one of them moved. Surfaces that begin or end to move slowly keep their history.
#[inline]
pub fn moved_alike(words: [u32; 2], moved_px: f32) -> bool {
    if words[1] & MOVES != 0 { moved_px >= STOPPED_PX } else { moved_px <= STARTED_PX }
}

/// Word for [`has_code`](super::pack::has_code), with the code of a sample's disparity in its high half.
#[inline]
pub fn code_word(words: [u32; 2]) -> u32 {
    (words[1] << 13) & 0xffe0_0000
}

/// Unpacks the sample of a texel that is not empty. The result is finite for any words.
#[inline]
pub fn unpack_full(words: [u32; 2]) -> StoredSample {
    let disparity = (words[1] >> 8) & 0x7ff;
    StoredSample {
        color: unpack_color(words[0]),
        // The limit keeps compilers from merging this factor with later ones.
        lod: lod_value(words[1] & 255).min(MOST_STEPS),
        disparity: if disparity == 0x7ff { -1.0 } else { disparity_value(disparity << 5) },
        place_px: Vec2::new(unpack_place(words[1] >> 20), unpack_place(words[1] >> 26)),
    }
}

/// A stored sample in an image of another size. `texel_px`: its texel's place relative to the new texel, in old pixels;
/// `scale`: new size over old size; `lod_shift`: log2 of it. The sample becomes coarse if its place is too far to be
/// stored.
#[inline]
pub fn moved_stored(s: StoredSample, texel_px: Vec2, scale: Vec2, lod_shift: f32) -> StoredSample {
    if s.lod < 0.0 {
        return s;
    }
    let place_px = (texel_px + s.place_px) * scale;
    let near = place_px.x.abs().max(place_px.y.abs()) <= FARTHEST_PX;
    let lod = (s.lod + lod_shift).max(0.0);
    StoredSample { lod: if near { lod } else { lod.max(1.0) }, place_px, ..s }
}

/// Packs a sample of [`moved_stored`] in place of the `old` one.
#[inline]
pub fn resized_stored(old: [u32; 2], s: StoredSample) -> [u32; 2] {
    let words = pack_stored(s);
    [words[0], words[1] | (old[1] & MOVES)]
}

/// Least sum of weights at which samples beside a position replace the nearest one: the weight of one sample at 0.65
/// px.
const STAND_IN: f32 = 1.6;

/// Sums over the samples around a position, and the sample to keep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Around {
    /// Weights.
    pub weight: f32,
    /// Colors times weights.
    pub color: Vec3,
    /// Levels of detail times weights.
    pub lod: f32,
    /// Places relative to the position, times weights.
    pub place: Vec2,
    /// Products of these places, xx, xy and yy, times weights.
    pub square: Vec3,
    /// Colors times x, times weights.
    pub color_x: Vec3,
    /// Colors times y, times weights.
    pub color_y: Vec3,
    /// Smallest and largest color.
    pub range: [Vec3; 2],
    /// The sample to keep. Its place is relative to the position.
    pub nearest: StoredSample,
    /// Cost of that choice.
    pub cost: f32,
}

impl Around {
    /// No sample yet.
    pub const NOTHING: Self = Self {
        weight: 0.0,
        color: Vec3::ZERO,
        lod: 0.0,
        place: Vec2::ZERO,
        square: Vec3::ZERO,
        color_x: Vec3::ZERO,
        color_y: Vec3::ZERO,
        range: [Vec3::splat(MAX_COLOR), Vec3::ZERO],
        nearest: StoredSample::EMPTY,
        cost: 1e30,
    };
}

/// Inverse of the squared distance in pixels at which the weight of a sample falls to 0.
pub const INVERSE_REACH: f32 = 1.0 / REACH_PX2;
/// The same for means of jittered samples; nine of them are interpolated.
pub const INVERSE_MEAN_REACH: f32 = 1.0 / MEAN_REACH_PX2;

/// Weight of a sample at squared distance `px2` from the position that is interpolated. `inverse_reach`: inverse of the
/// squared distance at which the weight falls to 0.
#[inline]
pub fn stored_weight(px2: f32, inverse_reach: f32) -> f32 {
    let inside = (1.0 - px2 * inverse_reach).max(0.0);
    (inside * inside) / (px2 + SOFTEN_PX2)
}

/// Adds a stored sample whose texel lies `texel_px` from the position, if it is on the `same` surface.
#[inline]
pub fn add_stored(a: Around, sample: StoredSample, texel_px: Vec2, same: bool, inverse_reach: f32) -> Around {
    if !same {
        return a;
    }
    let place = texel_px + sample.place_px;
    let px2 = place.x * place.x + place.y * place.y;
    let w = stored_weight(px2, inverse_reach);
    let (wx, wy) = (w * place.x, w * place.y);
    let cost = px2 + sample.lod * LOD_PX2;
    let nearer = cost < a.cost;
    Around {
        weight: a.weight + w,
        color: a.color + sample.color * w,
        lod: a.lod + sample.lod * w,
        place: a.place + Vec2::new(wx, wy),
        square: a.square + Vec3::new(wx * place.x, wx * place.y, wy * place.y),
        color_x: a.color_x + sample.color * wx,
        color_y: a.color_y + sample.color * wy,
        range: [a.range[0].min(sample.color), a.range[1].max(sample.color)],
        nearest: if nearer { StoredSample { place_px: place, ..sample } } else { a.nearest },
        cost: if nearer { cost } else { a.cost },
    }
}

/// Whether samples beside a position may replace the nearest one, which belongs to another surface.
#[inline]
pub fn can_replace(a: Around) -> bool {
    a.weight >= STAND_IN
}

/// History at a position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interpolated {
    /// Color to show.
    pub color: Vec3,
    /// Level of detail.
    pub lod: f32,
    /// Smallest and largest color of the samples around the position.
    pub range: [Vec3; 2],
    /// Sample to keep, or an empty one. Its place is relative to the position.
    pub nearest: StoredSample,
}

/// Color at the position: the sample that lies there, bit for bit; otherwise the value of a plane through the samples
/// around it, by weighted least squares.
#[inline]
pub fn interpolate(a: Around) -> Interpolated {
    let Around { nearest, range, .. } = a;
    let away = nearest.place_px.x.abs().max(nearest.place_px.y.abs());
    if nearest.lod < 0.0 || away <= EXACT_PX {
        let place_px = Vec2::ZERO;
        return Interpolated {
            color: nearest.color,
            lod: nearest.lod,
            range,
            nearest: StoredSample { place_px, ..nearest },
        };
    }
    if a.weight < 1e-4 {
        // All samples are far away.
        return Interpolated { color: nearest.color, lod: nearest.lod, range, nearest };
    }
    // Moments times the squared weight. This avoids quotients, which shader compilers reorder.
    let stiff = (a.weight * a.weight) * STIFF_PX2;
    let xx = (a.square.x * a.weight - a.place.x * a.place.x) + stiff;
    let xy = a.square.y * a.weight - a.place.x * a.place.y;
    let yy = (a.square.z * a.weight - a.place.y * a.place.y) + stiff;
    // At least `stiff` squared, because variances are not negative.
    let det = (xx * yy - xy * xy).max((stiff * stiff) * 0.5);
    let across = a.color_x * a.weight - a.color * a.place.x;
    let down = a.color_y * a.weight - a.color * a.place.y;
    // The plane's value at the position is the mean, minus its slopes times the mean place.
    let rise = across * (yy * a.place.x - xy * a.place.y) + down * (xx * a.place.y - xy * a.place.x);
    let inverse = 1.0 / a.weight;
    let color = ((a.color - rise / det) * inverse).max(Vec3::ZERO);
    Interpolated { color, lod: a.lod * inverse, range, nearest }
}

/// Whether history has moved since its samples were shaded, by more than the resolution of their stored places.
/// `motion` and `place_px`: in pixels.
#[inline(always)]
pub fn has_moved(motion: Vec2, place_px: Vec2) -> bool {
    motion.x.abs().max(motion.y.abs()) > EXACT_PX || place_px.x.abs().max(place_px.y.abs()) > EXACT_PX
}
