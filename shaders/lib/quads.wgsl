//#use rng
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

fn region(e_deg: f32, fovea_radius_deg: f32, mid_radius_deg: f32) -> u32 {
    if e_deg < fovea_radius_deg {
        return IN_FOVEA;
    }
    return select(IN_PERIPHERY, IN_MIDDLE, e_deg < mid_radius_deg);
}

fn in_pattern(x: u32, y: u32, step_quads: u32, offset: vec2u) -> bool {
    return (x & (step_quads - 1u)) == offset.x && (y & (step_quads - 1u)) == offset.y;
}

fn in_turn(x: u32, y: u32, step_quads: u32, turn: u32) -> bool {
    return (((x / step_quads) ^ (y / step_quads) ^ turn) & 1u) == 0u;
}

fn asked_px(x: u32, y: u32, frame_low: u32) -> vec2u {
    return vec2u(2u * x + ((frame_low ^ x ^ y) & 1u), 2u * y + ((frame_low >> 1u) & 1u));
}

fn place_in_quad(px: vec2u) -> u32 {
    return (px.x & 1u) | ((px.y & 1u) << 1u);
}

fn nearest_px(mask: u32, quad: vec2u, px: vec2u) -> vec2u {
    var best = 0xffffffffu;
    for (var place = 0u; place < 4u; place++) {
        let offset = vec2i(2u * quad + vec2u(place & 1u, place >> 1u)) - vec2i(px);
        let px2 = (u32(offset.x * offset.x + offset.y * offset.y) << 2u) | place;
        best = select(best, min(best, px2), ((mask >> place) & 1u) == 1u);
    }
    return 2u * quad + vec2u(best & 1u, (best >> 1u) & 1u);
}

fn quadrant_of(x: i32, y: i32) -> u32 {
    let below = y > 0 || (y == 0 && x > 0);
    return select(2u + u32(x >= 0), u32(x <= 0), below);
}

fn sample_code(x: i32, y: i32) -> u32 {
    return (u32(x * x + y * y) << 12u) | u32(x + 32) | (u32(y + 32) << 6u);
}

fn sample_offset(code: u32) -> vec2i {
    return vec2i(vec2u(code & 63u, (code >> 6u) & 63u)) - 32;
}

fn no_history_need(x: u32, y: u32, offset: vec2u) -> f32 {
    return select(LATER_SHARE * NO_HISTORY_NEED, NO_HISTORY_NEED, in_pattern(x, y, FIRST_STEP, offset));
}

fn need(lod: f32, samples: f32, contrast: f32) -> f32 {
    let limited = min(contrast, MOST_CONTRAST);
    let coarse = (limited + COARSE_CONTRAST) * min(lod, COARSEST);
    let single = limited + FEW_CONTRAST;
    let few = (single * single) * (FEW_ERROR / (samples * (samples + 1.0)));
    return coarse * coarse + select(0.0, few, samples < ENOUGH_SAMPLES);
}

fn acuity(e_deg: f32) -> f32 {
    let share = 1.0 / (1.0 + e_deg * (1.0f / HALF_DEG));
    return share * share;
}

fn share_in_block(needs: vec4f, i: u32) -> f32 {
    var share = 1.0;
    for (var other = 0u; other < 4u; other++) {
        let is_larger = needs[other] > needs[i] || (needs[other] == needs[i] && other < i);
        share *= select(1.0, CLUMPED, other != i && is_larger);
    }
    return share;
}

fn quad_key(needed: f32, x: u32, y: u32, frame_low: u32, key: u32) -> u32 {
    let hash = bits(x, y, frame_low, ~key) >> (32u - HASH_BITS);
    let halves = i32(bitcast<u32>(needed) >> 22u) - 254 + CODE_OF_ONE;
    return select(0u, (u32(clamp(halves, 1, 62)) << HASH_BITS) | hash, needed > 0.0);
}

fn known_samples(samples: f32) -> u32 {
    return u32(clamp(samples, 1.0, MOST_KNOWN));
}

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

fn paths(first: u32, further: u32, samples: u32, is_even: bool, threshold: u32) -> u32 {
    var count = u32(is_even || first >= threshold);
    for (var path = 2u; path <= MOST_PATHS && path_key(further, samples, path) >= threshold; path++) {
        count++;
    }
    return count;
}

fn neighbour(x: i32, y: i32) -> u32 {
    let inside = x >= -REACH && y >= -REACH && x < REACH && y < REACH;
    let code = (u32(x * x + y * y) << 8u) | u32(x + REACH) | (u32(y + REACH) << 4u);
    return select(0xffffffffu, code, inside);
}

fn window(word: u32, x: u32) -> u32 {
    return (word >> (x % RUN_QUADS)) & 0xffffu;
}

fn offset_bits(low: i32, high: i32) -> u32 {
    return (0xffffu << u32(low + REACH)) & (0xffffu >> u32(REACH - 1 - high));
}

fn first_of(window: u32, low: i32, high: i32, y: i32) -> u32 {
    let bits = window & offset_bits(low, high);
    return select(neighbour(i32(firstTrailingBit(bits)) - REACH, y), 0xffffffffu, bits == 0u);
}

fn last_of(window: u32, low: i32, high: i32, y: i32) -> u32 {
    let bits = window & offset_bits(low, high);
    return select(neighbour(i32(firstLeadingBit(bits)) - REACH, y), 0xffffffffu, bits == 0u);
}

fn octant_offsets(rows: i32) -> vec2i {
    return vec2i(2 * rows / 5, (5 * rows + 1) / 2);
}

fn neighbour_offset(code: u32) -> vec2i {
    return vec2i(vec2u(code & 15u, (code >> 4u) & 15u)) - REACH;
}
