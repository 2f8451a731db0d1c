//! Which pixels of a sparse frame want a sample of their own, because history has nothing for them, and which of them
//! a budget pays for.
//!
//! Hardware shades quads of 2x2 pixels, so that quads are chosen. Two pixels of each are asked, for three quarters
//! of the cost of four and nearly the same pictures. A quad has a key: the largest priority of these, then a hash. The
//! chosen ones are those whose key reaches a threshold, which a histogram of the keys gives: without sorting, and
//! without going beyond the budget.

use super::rng;

/// Level of detail from which on history is coarse: no sample fell on the pixel, or what did was contradicted since.
pub const WANTED_LOD: f32 = 1.0;
/// Number of rings around the gaze. More follow the order from the gaze outwards more closely.
const RINGS: u32 = 31;
/// Rings a degree: they reach to 60 degrees, and the last one has the rest.
const RINGS_PER_DEG: f32 = 0.5;
/// Bits of the hash in a key. A budget is used up to one key: 1/256 of the quads of a ring.
const HASH_BITS: u32 = 8;
/// Number of keys; every key is below it.
pub const KEYS: u32 = (2 * RINGS + 1) << HASH_BITS;

/// How much a pixel that the frame does not sample, `e_deg` degrees from the gaze, wants a sample of its own: 0, not at
/// all, to 62. Pixels without history come before those whose history is coarse, and within either class the nearer
/// ones come first. `lod`: level of detail of history at the pixel; negative: there is none.
#[inline]
pub fn priority(lod: f32, e_deg: f32) -> u32 {
    let has_history = lod >= 0.0;
    if has_history && lod < WANTED_LOD {
        return 0;
    }
    let ring = (e_deg * RINGS_PER_DEG).min((RINGS - 1) as f32) as u32;
    (if has_history { RINGS } else { 2 * RINGS }) - ring
}

/// One of the two pixels of quad (`x`, `y`) that are asked in a frame, `i` 0 or 1: those of a diagonal, so that both
/// columns and both rows are; and those of the other diagonal in the next frame. Quads beside each other take turns,
/// because a lattice has its samples at the same place in all of them.
#[inline]
pub fn asked_px(i: u32, x: u32, y: u32, frame: u32) -> [u32; 2] {
    [2 * x + ((i ^ frame ^ x ^ y) & 1), 2 * y + i]
}

/// Key of quad (`x`, `y`), whose asked pixels' largest priority is `priority`: 0 if they want nothing. The hash gives
/// another order in every frame, so that what the budget leaves out is spread evenly. `frame` and `key`: of the view's
/// random stream ([`rng::bits`]).
#[inline]
pub fn quad_key(priority: u32, x: u32, y: u32, frame: u32, key: u32) -> u32 {
    // The inverted key is that of another stream than the pixels'.
    let hash = rng::bits(x, y, frame, !key) >> (32 - HASH_BITS);
    if priority == 0 { 0 } else { priority << HASH_BITS | hash }
}

/// Number of quads that `budget` pays for: a share, 0 to 1, of `columns` x `rows` quads.
pub fn budget_quads(budget: f32, [columns, rows]: [u32; 2]) -> u32 {
    // Of f64, so that the product is not rounded up.
    (f64::from(budget) * f64::from(columns) * f64::from(rows)) as u32
}

/// Smallest key, at least 1, of which all quads of this and of larger keys are within `budget` quads. `counts`: number
/// of quads by key.
pub fn threshold(counts: &[u32], budget: u32) -> u32 {
    let mut key = counts.len();
    let mut left = budget;
    while key > 1 && counts[key - 1] <= left {
        key -= 1;
        left -= counts[key];
    }
    key as u32
}
