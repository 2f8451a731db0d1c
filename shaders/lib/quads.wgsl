//#use color
//#use rng
//#use sanitize
// Twin of src/kernel/quads.rs, which documents the functions.

const IN_FOVEA: u32 = 0u;
const IN_MIDDLE: u32 = 1u;
const IN_PERIPHERY: u32 = 2u;
const RUN_QUADS: u32 = 16u;
const REACH: i32 = 8;
const NOWHERE: u32 = 0x88u;
const WHOLE: u32 = 15u;
const NO_HISTORY_NEED: f32 = 60.0;
const LATER_SHARE: f32 = 0.25;
const FIRST_STEP: u32 = 4u;
const COARSE_CONTRAST: f32 = 4.0;
const COARSEST: f32 = 2.0;
const MOST_CONTRAST: f32 = 60.0;
const FEW_CONTRAST: f32 = 1.0;
const FEW_ERROR: f32 = 0.4;
const ENOUGH_SAMPLES: f32 = 16.0;
const HALF_DEG: f32 = 20.0;
const CLUMPED: f32 = 0.0625;
const MOST_PATHS: u32 = 16u;
const MOST_KNOWN: f32 = 31.0;
const HASH_BITS: u32 = 8u;
const KEYS: u32 = 63u << HASH_BITS;
const CODE_OF_ONE: i32 = 36;
const GROUPS_PER_ROW: u32 = 32768u;

// Region of a quad at `e_deg` degrees from the gaze.
fn region(e_deg: f32, fovea_radius_deg: f32, mid_radius_deg: f32) -> u32 {
    if e_deg < fovea_radius_deg {
        return IN_FOVEA;
    }
    return select(IN_PERIPHERY, IN_MIDDLE, e_deg < mid_radius_deg);
}

// Whether the even pattern has quad (`x`, `y`): one quad in each block of `step_quads` quads a side, at `offset` in its
// block.
fn in_pattern(x: u32, y: u32, step_quads: u32, offset: vec2u) -> bool {
    return (x & (step_quads - 1u)) == offset.x && (y & (step_quads - 1u)) == offset.y;
}

// Whether a frame's pattern has the block of quad (`x`, `y`), of blocks in a checkerboard that alternates: half of the
// blocks a frame.
fn in_turn(x: u32, y: u32, step_quads: u32, turn: u32) -> bool {
    return (((x / step_quads) ^ (y / step_quads) ^ turn) & 1u) == 0u;
}

// The even pattern of a frame, outside the fovea: quads from one of its quads to the next, in the middle region and in
// the periphery; places of its quads in their blocks; and which half of the blocks the periphery shades.
struct EvenPattern {
    steps: vec2u,
    middle: vec2u,
    periphery: vec2u,
    turn: u32,
}

// Whether a frame shades quad (`x`, `y`) whatever its history: all in the fovea, those of the pattern elsewhere.
fn is_even(pattern: EvenPattern, x: u32, y: u32, region_now: u32) -> bool {
    let is_near = in_pattern(x, y, pattern.steps.x, pattern.middle);
    let is_far = in_pattern(x, y, pattern.steps.y, pattern.periphery) && in_turn(x, y, pattern.steps.y, pattern.turn);
    return region_now == IN_FOVEA || select(is_far, is_near, region_now == IN_MIDDLE);
}

// The pixel of quad (`x`, `y`) that is tested in a frame: each of the four in four frames.
fn probed_px(x: u32, y: u32, frame_low: u32) -> vec2u {
    return vec2u(2u * x + ((frame_low ^ x ^ y) & 1u), 2u * y + ((frame_low >> 1u) & 1u));
}

// Number of a pixel in its quad, row by row; also its bit in the quad's mask.
fn place_in_quad(px: vec2u) -> u32 {
    return (px.x & 1u) | ((px.y & 1u) << 1u);
}

// The shaded pixel of the quad at `quad` that is nearest to pixel `px`; the first of equally near ones.
fn nearest_px(mask: u32, quad: vec2u, px: vec2u) -> vec2u {
    var best = 0xffffffffu;
    for (var place = 0u; place < 4u; place++) {
        let offset = vec2i(2u * quad + vec2u(place & 1u, place >> 1u)) - vec2i(px);
        let px2 = (u32(offset.x * offset.x + offset.y * offset.y) << 2u) | place;
        best = select(best, min(best, px2), ((mask >> place) & 1u) == 1u);
    }
    return 2u * quad + vec2u(best & 1u, (best >> 1u) & 1u);
}

// Quadrant of an offset other than 0; the half-axis that begins a quadrant belongs to it.
fn quadrant_of(x: i32, y: i32) -> u32 {
    let below = y > 0 || (y == 0 && x > 0);
    return select(2u + u32(x >= 0), u32(x <= 0), below);
}

// Code of a sample at an offset in pixels, each from -32 to 31: the smallest of some codes is the nearest sample.
fn sample_code(x: i32, y: i32) -> u32 {
    return (u32(x * x + y * y) << 12u) | u32(x + 32) | (u32(y + 32) << 6u);
}

// Offset in pixels of the sample with a code.
fn sample_offset(code: u32) -> vec2i {
    return vec2i(vec2u(code & 63u, (code >> 6u) & 63u)) - 32;
}

// Need of quad (`x`, `y`) without history.
fn no_history_need(x: u32, y: u32, offset: vec2u) -> f32 {
    return select(LATER_SHARE * NO_HISTORY_NEED, NO_HISTORY_NEED, in_pattern(x, y, FIRST_STEP, offset));
}

// Reduction of a pixel's squared error that a sample of its own is expected to bring, from history of level of detail
// `lod`, of `samples` samples and with the local contrast `contrast`.
fn need(lod: f32, samples: f32, contrast: f32) -> f32 {
    let limited = min(contrast, MOST_CONTRAST);
    let coarse = (limited + COARSE_CONTRAST) * min(lod, COARSEST);
    let single = limited + FEW_CONTRAST;
    let few = (single * single) * (FEW_ERROR / (samples * (samples + 1.0)));
    return coarse * coarse + select(0.0, few, samples < ENOUGH_SAMPLES);
}

// What the stored samples around a pixel's previous position say about its need: of the nearest one its squared
// distance in pixels, color, level of detail (negative without any) and number of samples; smallest and largest color
// of all.
struct PastAround {
    nearest_px2: f32,
    color: vec3f,
    lod: f32,
    samples: f32,
    lowest: vec3f,
    highest: vec3f,
}

// No stored sample.
fn no_past() -> PastAround {
    return PastAround(MAX_HALF, vec3f(0.0), -1.0, ENOUGH_SAMPLES, vec3f(MAX_HALF), vec3f(0.0));
}

// With a stored sample at a squared distance from the position.
fn with_past(around: PastAround, c: vec3f, lod: f32, samples: f32, px2: f32) -> PastAround {
    let lowest = min(around.lowest, c);
    let highest = max(around.highest, c);
    if px2 < around.nearest_px2 {
        return PastAround(px2, c, lod, samples, lowest, highest);
    }
    return PastAround(around.nearest_px2, around.color, around.lod, around.samples, lowest, highest);
}

// Need of the pixel; negative without a stored sample.
fn need_around(around: PastAround) -> f32 {
    let contrast = root_difference(around.lowest, around.highest);
    return select(need(around.lod, around.samples, contrast), -1.0, around.lod < 0.0);
}

// Share of a squared error that counts at `e_deg` degrees from the gaze.
fn acuity(e_deg: f32) -> f32 {
    let share = 1.0 / (1.0 + e_deg * (1.0f / HALF_DEG));
    return share * share;
}

// Share of the need of quad `i` that counts, of a block of 2x2 quads with these needs: less for each quad whose need is
// larger, so that chosen quads do not clump.
fn share_in_block(needs: vec4f, i: u32) -> f32 {
    var share = 1.0;
    for (var other = 0u; other < 4u; other++) {
        let is_larger = needs[other] > needs[i] || (needs[other] == needs[i] && other < i);
        share *= select(1.0, CLUMPED, other != i && is_larger);
    }
    return share;
}

// Key of a quad of the need `need`, 0 for none: its binary logarithm in half steps, then a hash.
fn quad_key(needed: f32, x: u32, y: u32, frame_low: u32, key: u32) -> u32 {
    let hash = bits(x, y, frame_low, ~key) >> (32u - HASH_BITS);
    let halves = i32(bitcast<u32>(needed) >> 22u) - 254 + CODE_OF_ONE;
    return select(0u, (u32(clamp(halves, 1, 62)) << HASH_BITS) | hash, needed > 0.0);
}

// Samples of a mean as a whole number, from 1 to 31, for `path_key`.
fn known_samples(samples: f32) -> u32 {
    return u32(clamp(samples, 1.0, MOST_KNOWN));
}

// Key of a pixel's path number `path` (from 1 on) in a frame, from its first path's, `key`; 0 for none.
fn path_key(key: u32, samples: u32, path: u32) -> u32 {
    let first = samples * (samples + 1u);
    let own = (samples + path - 1u) * (samples + path);
    let first2 = first * first;
    let own2 = own * own;
    let most = firstLeadingBit(own2) - firstLeadingBit(first2);
    let halves = most - u32((first2 << most) > own2);
    let fall = halves << HASH_BITS;
    return select(0u, key - fall, key >= fall + (1u << HASH_BITS));
}

// Number of paths of a pixel whose first path has the key `first` and whose further paths have the keys that
// `path_key` makes of `further`: as many as there are keys from `threshold` on.
fn paths(first: u32, further: u32, samples: u32, is_even: bool, threshold: u32) -> u32 {
    var count = u32(is_even || first >= threshold);
    for (var path = 2u; path <= MOST_PATHS && path_key(further, samples, path) >= threshold; path++) {
        count++;
    }
    return count;
}

// Code of a neighbour at an offset in quads, in eight bits, below its squared distance: the smallest of some neighbours
// is the nearest.
fn neighbour(x: i32, y: i32) -> u32 {
    let inside = x >= -REACH && y >= -REACH && x < REACH && y < REACH;
    let code = (u32(x * x + y * y) << 8u) | u32(x + REACH) | (u32(y + REACH) << 4u);
    return select(0xffffffffu, code, inside);
}

// Bits of the shaded quads within reach of the quad in column `x`: bit i is the quad at the offset i - 8.
fn window(word: u32, x: u32) -> u32 {
    return (word >> (x % RUN_QUADS)) & 0xffffu;
}

// Bits of a window at the offsets from `low` (-8 to 20) to `high` (-20 to 7).
fn offset_bits(low: i32, high: i32) -> u32 {
    return (0xffffu << u32(low + REACH)) & (0xffffu >> u32(REACH - 1 - high));
}

// Code of the first shaded quad of a window, `y` rows below, at the offsets from `low` to `high`; `u32::MAX` without
// one.
fn first_of(window: u32, low: i32, high: i32, y: i32) -> u32 {
    let bits = window & offset_bits(low, high);
    return select(neighbour(i32(firstTrailingBit(bits)) - REACH, y), 0xffffffffu, bits == 0u);
}

// Code of the last such quad.
fn last_of(window: u32, low: i32, high: i32, y: i32) -> u32 {
    let bits = window & offset_bits(low, high);
    return select(neighbour(i32(firstLeadingBit(bits)) - REACH, y), 0xffffffffu, bits == 0u);
}

// Offsets in a row that is `rows` away, above 0: the largest one of the octant around the column, and the smallest one
// of those around the row.
fn octant_offsets(rows: i32) -> vec2i {
    return vec2i(2 * rows / 5, (5 * rows + 1) / 2);
}

// Offset in quads of the neighbour with a code.
fn neighbour_offset(code: u32) -> vec2i {
    return vec2i(vec2u(code & 15u, (code >> 4u) & 15u)) - REACH;
}
