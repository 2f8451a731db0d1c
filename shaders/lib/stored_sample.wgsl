//#use lod
//#use pack
// Twin of src/kernel/stored_sample.rs, which documents the layout.

const MAX_COLOR: f32 = 65408.0;
const SMALLEST_EXPONENT: u32 = 111u;
const PLACE_STEPS: f32 = 24.0;
const FARTHEST_PX: f32 = 1.2;
const EXACT_PX: f32 = 0.5f / PLACE_STEPS;
const REACH_PX2: f32 = 3.0;
const MEAN_REACH_PX2: f32 = 1.7;
const INVERSE_REACH: f32 = 1.0f / REACH_PX2;
const INVERSE_MEAN_REACH: f32 = 1.0f / MEAN_REACH_PX2;
const SOFTEN_PX2: f32 = 0.03;
const STIFF_PX2: f32 = 0.01;
const LOD_PX2: f32 = 0.3;
const MOST_STEPS: f32 = 254.0;
const MOVES: u32 = 0x80000u;
const MOVES_PX: f32 = 0.5;
const STARTED_PX: f32 = 2.0;
const STOPPED_PX: f32 = 0.125;
const UNKNOWN_MOVED_PX: f32 = 0.5;

// A negative `lod` marks an empty texel.
struct StoredSample {
    color: vec3f,
    lod: f32,
    disparity: f32,
    place_px: vec2f,
}

// `v` as a multiple of the step that belongs to `exponent`, an exponent coded as in a float.
fn multiple(v: f32, exponent: u32, up: f32) -> u32 {
    // A power of two: the product is exact.
    return u32(v * bitcast<f32>((262u - exponent) << 23u) + up);
}

// Packs a color: 9 bits a channel and an exponent that the three share, each rounded to the nearest.
fn pack_color(c: vec3f) -> u32 {
    return pack_color_by(c, 0.5);
}

// As `pack_color`, with stochastic rounding: if `up` is uniform in [0, 1), the probability of rounding up is the
// fraction that is cut off.
fn pack_color_by(c: vec3f, up: f32) -> u32 {
    let v = select(vec3f(0.0), min(c, vec3f(MAX_COLOR)), c > vec3f(0.0));
    let largest = max(max(v.x, v.y), v.z);
    let rough = max(bitcast<u32>(largest) >> 23u, SMALLEST_EXPONENT);
    // Rounding may carry into a tenth bit.
    let exponent = rough + (multiple(largest, rough, up) >> 9u);
    return multiple(v.x, exponent, up)
        | (multiple(v.y, exponent, up) << 9u)
        | (multiple(v.z, exponent, up) << 18u)
        | ((exponent - SMALLEST_EXPONENT) << 27u);
}

// Color of a packed word; finite for any word.
fn unpack_color(word: u32) -> vec3f {
    let unit = bitcast<f32>(((word >> 27u) + (SMALLEST_EXPONENT - 8u)) << 23u);
    return vec3f(f32(word & 511u), f32((word >> 9u) & 511u), f32((word >> 18u) & 511u)) * unit;
}

// Code of a place along an axis, in pixels.
fn pack_place(v: f32) -> u32 {
    return u32(clamp(floor(v * PLACE_STEPS + 32.5), 0.0, 63.0));
}

// Place along an axis of the code in the low six bits, in pixels.
fn unpack_place(bits: u32) -> f32 {
    return (f32(bits & 63u) - 32.0) * (1.0f / PLACE_STEPS);
}

// Packs a sample.
fn pack_stored(s: StoredSample) -> vec2u {
    var lod = EMPTY_LOD;
    if s.lod >= 0.0 {
        lod = u32(min(s.lod * LOD_STEPS, MOST_STEPS) + 1.5);
    }
    let code = disparity_code(s.disparity);
    // The last code stands for an unknown disparity.
    let disparity = select(min((code + 16u) >> 5u, 0x7feu), 0x7ffu, code == 0xffffu);
    return vec2u(
        pack_color(s.color),
        lod | (disparity << 8u) | (pack_place(s.place_px.x) << 20u) | (pack_place(s.place_px.y) << 26u),
    );
}

// Unpacks a sample.
fn unpack_stored(words: vec2u) -> StoredSample {
    if is_empty(words) {
        return StoredSample(vec3f(0.0), -1.0, -1.0, vec2f(0.0));
    }
    return unpack_full(words);
}

// Whether a texel is empty.
fn is_empty(words: vec2u) -> bool {
    return (words.y & 255u) == EMPTY_LOD;
}

// A packed sample of a surface that moved by `moved_px` in the world.
fn with_motion(words: vec2u, moved_px: f32) -> vec2u {
    return vec2u(words.x, words.y | select(0u, MOVES, moved_px > MOVES_PX));
}

// Whether a stored sample may be of a surface that moved by `moved_px` in the world.
fn moved_alike(words: vec2u, moved_px: f32) -> bool {
    return select(moved_px <= STARTED_PX, moved_px >= STOPPED_PX, (words.y & MOVES) != 0u);
}

// Word for `has_code`, with the code of a sample's disparity in its high half.
fn code_word(words: vec2u) -> u32 {
    return (words.y << 13u) & 0xffe00000u;
}

// Unpacks the sample of a texel that is not empty.
fn unpack_full(words: vec2u) -> StoredSample {
    let code = (words.y >> 8u) & 0x7ffu;
    return StoredSample(
        unpack_color(words.x),
        // The limit keeps compilers from merging this factor with later ones.
        min(lod_value(words.y & 255u), MOST_STEPS),
        select(disparity_value(code << 5u), -1.0, code == 0x7ffu),
        vec2f(unpack_place(words.y >> 20u), unpack_place(words.y >> 26u)),
    );
}

// A stored sample in an image of another size.
fn moved_stored(s: StoredSample, texel_px: vec2f, scale: vec2f, lod_shift: f32) -> StoredSample {
    if s.lod < 0.0 {
        return s;
    }
    let place = (texel_px + s.place_px) * scale;
    let near = max(abs(place.x), abs(place.y)) <= FARTHEST_PX;
    let lod = max(s.lod + lod_shift, 0.0);
    return StoredSample(s.color, select(max(lod, 1.0), lod, near), s.disparity, place);
}

// Packs a sample of `moved_stored` in place of the `old` one.
fn resized_stored(old: vec2u, s: StoredSample) -> vec2u {
    let words = pack_stored(s);
    return vec2u(words.x, words.y | (old.y & MOVES));
}

struct AroundStored {
    weight: f32,
    color: vec3f,
    lod: f32,
    place: vec2f,
    square: vec3f,
    color_x: vec3f,
    color_y: vec3f,
    lowest: vec3f,
    highest: vec3f,
    nearest: StoredSample,
    cost: f32,
}

// Sums over no sample, from which `add_stored` starts.
fn nothing_around() -> AroundStored {
    let zero = vec3f(0.0);
    let empty = StoredSample(zero, -1.0, -1.0, vec2f(0.0));
    return AroundStored(0.0, zero, 0.0, vec2f(0.0), zero, zero, zero, vec3f(MAX_COLOR), zero, empty, 1e30);
}

// Weight of a sample at squared distance `px2` from the position that is interpolated.
fn stored_weight(px2: f32, inverse_reach: f32) -> f32 {
    let inside = max(1.0 - px2 * inverse_reach, 0.0);
    return (inside * inside) / (px2 + SOFTEN_PX2);
}

// Adds a stored sample whose texel lies `texel_px` from the position, if it is on the `same` surface.
fn add_stored(a: AroundStored, sampled: StoredSample, texel_px: vec2f, same: bool, inverse_reach: f32) -> AroundStored {
    if !same {
        return a;
    }
    let place = texel_px + sampled.place_px;
    let px2 = place.x * place.x + place.y * place.y;
    let w = stored_weight(px2, inverse_reach);
    let wx = w * place.x;
    let wy = w * place.y;
    let cost = px2 + sampled.lod * LOD_PX2;
    var nearest = a.nearest;
    if cost < a.cost {
        nearest = StoredSample(sampled.color, sampled.lod, sampled.disparity, place);
    }
    return AroundStored(
        a.weight + w,
        a.color + sampled.color * w,
        a.lod + sampled.lod * w,
        a.place + vec2f(wx, wy),
        a.square + vec3f(wx * place.x, wx * place.y, wy * place.y),
        a.color_x + sampled.color * wx,
        a.color_y + sampled.color * wy,
        min(a.lowest, sampled.color),
        max(a.highest, sampled.color),
        nearest,
        select(a.cost, cost, cost < a.cost),
    );
}

const STAND_IN: f32 = 1.6;

// Whether samples beside a position may replace the nearest one, which belongs to another surface.
fn can_replace(a: AroundStored) -> bool {
    return a.weight >= STAND_IN;
}

struct Interpolated {
    color: vec3f,
    lod: f32,
    lowest: vec3f,
    highest: vec3f,
    nearest: StoredSample,
}

// Color at the position: the sample that lies there, bit for bit; otherwise the value of a plane through the samples
// around it, by weighted least squares.
fn interpolate(a: AroundStored) -> Interpolated {
    var nearest = a.nearest;
    let away = max(abs(nearest.place_px.x), abs(nearest.place_px.y));
    if nearest.lod < 0.0 || away <= EXACT_PX {
        nearest.place_px = vec2f(0.0);
        return Interpolated(nearest.color, nearest.lod, a.lowest, a.highest, nearest);
    }
    if a.weight < 1e-4 {
        // All samples are far away.
        return Interpolated(nearest.color, nearest.lod, a.lowest, a.highest, nearest);
    }
    // Moments times the squared weight. This avoids quotients, which shader compilers reorder.
    let stiff = (a.weight * a.weight) * STIFF_PX2;
    let xx = (a.square.x * a.weight - a.place.x * a.place.x) + stiff;
    let xy = a.square.y * a.weight - a.place.x * a.place.y;
    let yy = (a.square.z * a.weight - a.place.y * a.place.y) + stiff;
    // At least `stiff` squared, because variances are not negative.
    let det = max(xx * yy - xy * xy, (stiff * stiff) * 0.5);
    let across = a.color_x * a.weight - a.color * a.place.x;
    let down = a.color_y * a.weight - a.color * a.place.y;
    // The plane's value at the position is the mean, minus its slopes times the mean place.
    let rise = across * (yy * a.place.x - xy * a.place.y) + down * (xx * a.place.y - xy * a.place.x);
    let inverse = 1.0 / a.weight;
    let color = max((a.color - rise / det) * inverse, vec3f(0.0));
    return Interpolated(color, a.lod * inverse, a.lowest, a.highest, nearest);
}

// Whether history has moved since its samples were shaded, by more than the resolution of their stored places. `motion`
// and `place_px`: in pixels.
fn has_moved(motion: vec2f, place_px: vec2f) -> bool {
    return max(abs(motion.x), abs(motion.y)) > EXACT_PX || max(abs(place_px.x), abs(place_px.y)) > EXACT_PX;
}
