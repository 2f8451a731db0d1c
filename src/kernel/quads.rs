//! Planned frames: which pixels of each quad of 2x2 pixels are shaded, and which shaded quads are around a pixel.
//!
//! The mask of a quad has a bit for each of its pixels. Rasterisers shade whole quads; tracers, and renderers at half
//! the resolution, shade single pixels.
//!
//! Everything in the fovea is shaded. Outside it an even pattern moves from frame to frame and visits every quad. A
//! budget of further quads goes where history lacks something: each quad has a *need*, the reduction of its squared
//! error that a sample is expected to bring. All quads whose key reaches a threshold are shaded. A histogram of the
//! keys gives the threshold, without sorting and without exceeding the budget.

use super::color::root_difference;
use super::rng;
use super::sanitize::MAX_HALF;
use glam::Vec3;

/// Region of the fovea: every quad is shaded.
pub const IN_FOVEA: u32 = 0;
/// Middle region.
pub const IN_MIDDLE: u32 = 1;
/// Periphery.
pub const IN_PERIPHERY: u32 = 2;

/// Quads of a row that share a word. Bit `i` of the word is the quad `i - 8` after the first of them.
pub const RUN_QUADS: u32 = 16;
/// Shaded quads are found from this many quads before a quad to one less after it, along each axis.
pub const REACH: i32 = 8;
/// Code of no neighbour.
pub const NOWHERE: u32 = 0x88;

/// Mask of a quad with all of its pixels.
pub const WHOLE: u32 = 15;

/// Need of a quad without history, if it comes first in its block in this frame; in squared units of
/// [`root_difference`](super::color::root_difference).
const NO_HISTORY_NEED: f32 = 60.0;
/// Share of that need for the other quads of the block.
const LATER_SHARE: f32 = 0.25;
/// Quads along each side of a block, of which one comes first.
pub const FIRST_STEP: u32 = 4;
/// Added to the contrast of coarse history, which errs by as much for each level of detail.
const COARSE_CONTRAST: f32 = 4.0;
/// Largest level of detail that counts.
const COARSEST: f32 = 2.0;
/// Largest contrast that counts.
const MOST_CONTRAST: f32 = 60.0;
/// Added to the contrast of a mean of few samples.
const FEW_CONTRAST: f32 = 1.0;
/// Squared share of the contrast by which a single sample errs.
const FEW_ERROR: f32 = 0.4;
/// Number of samples from which a mean needs no more. History without antialiasing counts as such a mean.
pub const ENOUGH_SAMPLES: f32 = 16.0;
/// Eccentricity in degrees at which an error counts half as much as at the gaze.
const HALF_DEG: f32 = 20.0;

/// Share of its need that counts for each quad with a larger need in its block of 2x2 quads.
const CLUMPED: f32 = 0.0625;

/// Largest number of paths of a pixel in a frame.
pub const MOST_PATHS: u32 = 16;
/// Largest number of samples of history that keys of further paths tell apart.
const MOST_KNOWN: f32 = 31.0;

/// Bits of the hash in a key. The unused part of the budget is less than the quads of one key.
const HASH_BITS: u32 = 8;
/// Number of keys; every key is below it.
pub const KEYS: u32 = 63 << HASH_BITS;
/// Code of a need of 1.
const CODE_OF_ONE: i32 = 36;
/// Largest number of workgroups along x of a dispatch whose size the plan computes; further ones lie along y.
pub const GROUPS_PER_ROW: u32 = 32768;

/// Region of a quad at `e_deg` degrees from the gaze.
#[inline]
pub fn region(e_deg: f32, fovea_radius_deg: f32, mid_radius_deg: f32) -> u32 {
    if e_deg < fovea_radius_deg {
        IN_FOVEA
    } else if e_deg < mid_radius_deg {
        IN_MIDDLE
    } else {
        IN_PERIPHERY
    }
}

/// Whether the even pattern has quad (`x`, `y`): one quad in each block of `step` x `step` quads (a power of two), at
/// `offset` in its block ([`offset_px`](super::lattice::offset_px)).
#[inline]
pub fn in_pattern(x: u32, y: u32, step: u32, offset: [u32; 2]) -> bool {
    (x & (step - 1)) == offset[0] && (y & (step - 1)) == offset[1]
}

/// Whether a frame's pattern has the block of quad (`x`, `y`), of blocks in a checkerboard that alternates: half of the
/// blocks a frame. `turn`: 0 or 1. Checkerboard rendering (El Mansouri, "Rendering Rainbow Six Siege", GDC 2016) has
/// this order for pixels.
#[inline]
pub fn in_turn(x: u32, y: u32, step: u32, turn: u32) -> bool {
    ((x / step) ^ (y / step) ^ turn) & 1 == 0
}

/// The even pattern of a frame, outside the fovea.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EvenPattern {
    /// Quads from one of its quads to the next, in the middle region and in the periphery: powers of two.
    pub steps: [u32; 2],
    /// Place of its quads in their blocks in the middle region.
    pub middle: [u32; 2],
    /// The same in the periphery.
    pub periphery: [u32; 2],
    /// Which half of the blocks the periphery shades: 0 or 1.
    pub turn: u32,
}

/// Whether a frame shades quad (`x`, `y`) whatever its history: all in the fovea, those of the pattern elsewhere.
#[inline]
pub fn is_even(pattern: EvenPattern, x: u32, y: u32, region: u32) -> bool {
    let [middle, periphery] = pattern.steps;
    let is_far = in_pattern(x, y, periphery, pattern.periphery) && in_turn(x, y, periphery, pattern.turn);
    match region {
        IN_FOVEA => true,
        IN_MIDDLE => in_pattern(x, y, middle, pattern.middle),
        _ => is_far,
    }
}

/// The pixel of quad (`x`, `y`) that is tested in a frame: each of the four in four frames. Neighbouring quads
/// alternate.
#[inline]
pub fn probed_px(x: u32, y: u32, frame: u32) -> [u32; 2] {
    [2 * x + ((frame ^ x ^ y) & 1), 2 * y + (frame >> 1 & 1)]
}

/// Number of a pixel in its quad, row by row; also its bit in the quad's mask.
#[inline]
pub fn place_in_quad(px: [u32; 2]) -> u32 {
    (px[0] & 1) | (px[1] & 1) << 1
}

/// The shaded pixel of the quad at `quad` that is nearest to pixel `px`; the first of equally near ones. `mask`:
/// the quad's mask, not 0.
#[inline]
pub fn nearest_px(mask: u32, quad: [u32; 2], px: [u32; 2]) -> [u32; 2] {
    let mut best = u32::MAX;
    for place in 0..4 {
        let [dx, dy] = [(2 * quad[0] + (place & 1)).abs_diff(px[0]), (2 * quad[1] + (place >> 1)).abs_diff(px[1])];
        let px2 = (dx * dx + dy * dy) << 2 | place;
        best = best.min(if mask >> place & 1 == 1 { px2 } else { u32::MAX });
    }
    [2 * quad[0] + (best & 1), 2 * quad[1] + (best >> 1 & 1)]
}

/// Quadrant of an offset other than 0; the half-axis that begins a quadrant belongs to it.
#[inline]
pub fn quadrant_of(x: i32, y: i32) -> u32 {
    let below = y > 0 || (y == 0 && x > 0);
    if below { u32::from(x <= 0) } else { 2 + u32::from(x >= 0) }
}

/// Code of a sample at an offset in pixels, each from -32 to 31: the smallest of some codes is the nearest sample.
#[inline]
pub fn sample_code(x: i32, y: i32) -> u32 {
    ((x * x + y * y) as u32) << 12 | (x + 32) as u32 | ((y + 32) as u32) << 6
}

/// Offset in pixels of the sample with a code.
#[inline]
pub fn sample_offset(code: u32) -> [i32; 2] {
    [(code & 63) as i32 - 32, (code >> 6 & 63) as i32 - 32]
}

/// Need of quad (`x`, `y`) without history. It does not fall with eccentricity: without history every part of the view
/// is far off. In each block of [`FIRST_STEP`] quads along each axis the quad at `offset` comes first, so that samples
/// are spread evenly from the first frame on.
#[inline]
pub fn no_history_need(x: u32, y: u32, offset: [u32; 2]) -> f32 {
    if in_pattern(x, y, FIRST_STEP, offset) { NO_HISTORY_NEED } else { LATER_SHARE * NO_HISTORY_NEED }
}

/// Reduction of a pixel's squared error that a sample of its own is expected to bring, from history of level of detail
/// `lod`, of `samples` samples and with the local contrast `contrast`. In squared units of
/// [`root_difference`](super::color::root_difference). Adaptive sampling by the expected reduction of the error is
/// Rousselle, Knaus and Zwicker's (SIGGRAPH Asia 2011).
#[inline]
pub fn need(lod: f32, samples: f32, contrast: f32) -> f32 {
    let contrast = contrast.min(MOST_CONTRAST);
    let coarse = (contrast + COARSE_CONTRAST) * lod.min(COARSEST);
    let single = contrast + FEW_CONTRAST;
    let few = (single * single) * (FEW_ERROR / (samples * (samples + 1.0)));
    coarse * coarse + if samples < ENOUGH_SAMPLES { few } else { 0.0 }
}

/// What the stored samples around a pixel's previous position say about its [`need`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PastAround {
    /// Squared distance of the nearest one in pixels.
    pub nearest_px2: f32,
    /// Its color.
    pub color: Vec3,
    /// Its level of detail; negative without any.
    pub lod: f32,
    /// Its number of samples.
    pub samples: f32,
    /// Smallest color of all.
    pub lowest: Vec3,
    /// Largest one.
    pub highest: Vec3,
}

/// No stored sample.
#[inline]
pub fn no_past() -> PastAround {
    let lowest = Vec3::splat(MAX_HALF);
    PastAround {
        nearest_px2: MAX_HALF,
        color: Vec3::ZERO,
        lod: -1.0,
        samples: ENOUGH_SAMPLES,
        lowest,
        highest: Vec3::ZERO,
    }
}

/// With a stored sample at a squared distance from the position.
#[inline]
pub fn with_past(around: PastAround, color: Vec3, lod: f32, samples: f32, px2: f32) -> PastAround {
    let (lowest, highest) = (around.lowest.min(color), around.highest.max(color));
    if px2 < around.nearest_px2 {
        PastAround { nearest_px2: px2, color, lod, samples, lowest, highest }
    } else {
        PastAround { lowest, highest, ..around }
    }
}

/// [`need`] of the pixel; negative without a stored sample.
#[inline]
pub fn need_around(around: PastAround) -> f32 {
    let contrast = root_difference(around.lowest, around.highest);
    if around.lod < 0.0 { -1.0 } else { need(around.lod, around.samples, contrast) }
}

/// Share of a squared error that counts at `e_deg` degrees from the gaze.
#[inline]
pub fn acuity(e_deg: f32) -> f32 {
    let share = 1.0 / (1.0 + e_deg * (1.0 / HALF_DEG));
    share * share
}

/// Share of the need of quad `i` that counts, of a block of 2x2 quads with these needs: less for each quad whose need
/// is larger, so that chosen quads do not clump.
#[inline]
pub fn share_in_block(needs: [f32; 4], i: u32) -> f32 {
    let own = needs[i as usize];
    let mut share = 1.0;
    for (other, need) in (0..).zip(needs) {
        let is_larger = need > own || (need == own && other < i);
        share *= if other != i && is_larger { CLUMPED } else { 1.0 };
    }
    share
}

/// Key of a quad of the need `need`, 0 for none: its binary logarithm in half steps, then a hash, which gives another
/// order in every frame, so that equal quads beyond the budget are spread evenly. `frame` and `key` select the view's
/// random stream ([`rng::bits`]).
#[inline]
pub fn quad_key(need: f32, x: u32, y: u32, frame: u32, key: u32) -> u32 {
    // The inverted key selects a random stream other than the pixels'.
    let hash = rng::bits(x, y, frame, !key) >> (32 - HASH_BITS);
    // Exponent and first bit of the mantissa.
    let halves = (need.to_bits() >> 22) as i32 - 2 * 127 + CODE_OF_ONE;
    if need > 0.0 { (halves.clamp(1, 62) as u32) << HASH_BITS | hash } else { 0 }
}

/// Samples of a mean as a whole number, from 1 to 31, for [`path_key`].
#[inline]
pub fn known_samples(samples: f32) -> u32 {
    samples.clamp(1.0, MOST_KNOWN) as u32
}

/// Key of a pixel's path number `path` (from 1 on) in a frame, from its first path's, `key`; 0 for none. The
/// variance V of one sample makes an error V / n of the mean of n `samples` ([`known_samples`]), of which path k takes
/// V / (n + k - 1) - V / (n + k) = V / ((n + k - 1)(n + k)). The key falls by the binary logarithm of that, in whole
/// half steps.
#[inline]
pub fn path_key(key: u32, samples: u32, path: u32) -> u32 {
    let first = samples * (samples + 1);
    let own = (samples + path - 1) * (samples + path);
    let (first2, own2) = (first * first, own * own);
    // The largest `halves` with 2^halves <= own2 / first2.
    let most = own2.ilog2() - first2.ilog2();
    let halves = most - u32::from(first2 << most > own2);
    let fall = halves << HASH_BITS;
    if key >= fall + (1 << HASH_BITS) { key - fall } else { 0 }
}

/// Number of paths of a pixel whose first path has the key `first` and whose further paths have the keys that
/// [`path_key`] makes of `further`: as many as there are keys from `threshold` on. `is_even`: it has its first path in
/// any case.
#[inline]
pub fn paths(first: u32, further: u32, samples: u32, is_even: bool, threshold: u32) -> u32 {
    let mut count = u32::from(is_even || first >= threshold);
    // Keys fall from path to path.
    let mut path = 2;
    while path <= MOST_PATHS && path_key(further, samples, path) >= threshold {
        count += 1;
        path += 1;
    }
    count
}

/// Number of quads that `budget` pays for: a share of `columns` x `rows` quads.
pub fn budget_quads(budget: f32, [columns, rows]: [u32; 2]) -> u32 {
    // In f64, so that the product is not rounded up.
    (f64::from(budget) * f64::from(columns) * f64::from(rows)) as u32
}

/// Smallest key, at least 1, such that at most `budget` quads have this key or a larger one. `counts`: number of quads
/// by key.
pub fn threshold(counts: &[u32], budget: u32) -> u32 {
    let mut key = counts.len();
    let mut left = budget;
    while key > 1 && counts[key - 1] <= left {
        key -= 1;
        left -= counts[key];
    }
    key as u32
}

/// Code of a neighbour at an offset in quads, in eight bits, below its squared distance: the smallest of some
/// neighbours is the nearest. `u32::MAX`: out of reach.
#[inline]
pub fn neighbour(x: i32, y: i32) -> u32 {
    if x < -REACH || y < -REACH || x >= REACH || y >= REACH {
        return u32::MAX;
    }
    ((x * x + y * y) as u32) << 8 | (x + REACH) as u32 | ((y + REACH) as u32) << 4
}

/// Bits of the shaded quads within reach of the quad in column `x`, of the word of its run: bit `i` is the quad at the
/// offset `i - 8`.
#[inline]
pub fn window(word: u32, x: u32) -> u32 {
    word >> (x % RUN_QUADS) & 0xffff
}

/// Bits of a window at the offsets from `low` (-8 to 20) to `high` (-20 to 7).
#[inline]
pub fn offset_bits(low: i32, high: i32) -> u32 {
    (0xffff << (low + REACH)) & (0xffff >> (REACH - 1 - high))
}

/// Code of the first shaded quad of a window, `y` rows below, at the offsets from `low` to `high`;
/// `u32::MAX` without one.
#[inline]
pub fn first_of(window: u32, low: i32, high: i32, y: i32) -> u32 {
    let bits = window & offset_bits(low, high);
    if bits == 0 { u32::MAX } else { neighbour(bits.trailing_zeros() as i32 - REACH, y) }
}

/// Code of the last such quad.
#[inline]
pub fn last_of(window: u32, low: i32, high: i32, y: i32) -> u32 {
    let bits = window & offset_bits(low, high);
    if bits == 0 { u32::MAX } else { neighbour(bits.ilog2() as i32 - REACH, y) }
}

/// Offsets in a row that is `rows` away, above 0: the largest one of the octant around the column, and the smallest one
/// of those around the row. Octants lie around the axes and the diagonals.
#[inline]
pub fn octant_offsets(rows: i32) -> [i32; 2] {
    // 2/5 is about the tangent of 22.5 degrees.
    [2 * rows / 5, (5 * rows + 1) / 2]
}

/// Offset in quads of the neighbour with a code.
#[inline]
pub fn neighbour_offset(code: u32) -> [i32; 2] {
    [(code & 15) as i32 - REACH, (code >> 4 & 15) as i32 - REACH]
}
