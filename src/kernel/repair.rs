//! Choice of the pixels of a sparse frame to repair: pixels without usable history, within a budget.
//!
//! Hardware shades quads of 2x2 pixels, so whole quads are chosen. Two pixels of each quad are tested, which costs
//! three quarters of testing all four and gives nearly the same pictures. A quad's key consists of the larger priority
//! of these two, then of a hash. All quads whose key reaches a threshold are chosen. A histogram of the keys gives the
//! threshold, without sorting and without exceeding the budget.

use super::rng;

/// History of this level of detail or more is coarse: no sample fell on the pixel, or later samples contradicted it.
pub const WANTED_LOD: f32 = 1.0;
/// Number of rings around the gaze. More rings give a finer order from the gaze outwards.
const RINGS: u32 = 31;
/// Rings a degree. The rings reach to 60 degrees; the last one contains the rest.
const RINGS_PER_DEG: f32 = 0.5;
/// Bits of the hash in a key. The unused part of the budget is less than the quads of one key: about 1/256 of a ring's
/// quads.
const HASH_BITS: u32 = 8;
/// Number of keys; every key is below it.
pub const KEYS: u32 = (2 * RINGS + 1) << HASH_BITS;

/// Priority, 0 (none) to 62, for the repair of a pixel that the frame does not sample, at `e_deg` degrees from the
/// gaze. Pixels without history come before those whose history is coarse, and within either class the nearer ones come
/// first. `lod`: level of detail of history at the pixel, negative without history.
#[inline]
pub fn priority(lod: f32, e_deg: f32) -> u32 {
    let has_history = lod >= 0.0;
    if has_history && lod < WANTED_LOD {
        return 0;
    }
    let ring = (e_deg * RINGS_PER_DEG).min((RINGS - 1) as f32) as u32;
    (if has_history { RINGS } else { 2 * RINGS }) - ring
}

/// One of the two pixels of quad (`x`, `y`) that are tested in a frame, for `i` 0 or 1. They lie on a diagonal, which
/// covers both columns and both rows; the next frame tests the other diagonal. Neighbouring quads alternate, because a
/// lattice has its samples at the same place in all of them.
#[inline]
pub fn asked_px(i: u32, x: u32, y: u32, frame: u32) -> [u32; 2] {
    [2 * x + ((i ^ frame ^ x ^ y) & 1), 2 * y + i]
}

/// Key of quad (`x`, `y`). `priority`: the larger priority of its two tested pixels. The key of a priority of 0 is 0.
/// The hash gives another order in every frame, so that the quads beyond the budget are spread evenly. `frame` and
/// `key` select the view's random stream ([`rng::bits`]).
#[inline]
pub fn quad_key(priority: u32, x: u32, y: u32, frame: u32, key: u32) -> u32 {
    // The inverted key selects a random stream other than the pixels'.
    let hash = rng::bits(x, y, frame, !key) >> (32 - HASH_BITS);
    if priority == 0 { 0 } else { priority << HASH_BITS | hash }
}

/// Number of quads that `budget` pays for: a share, 0 to 1, of `columns` x `rows` quads.
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
