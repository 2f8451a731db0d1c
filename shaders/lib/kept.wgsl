//#use surface
// Twin of src/kernel/kept.rs, which documents the layout.

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

// A negative `lod` marks an empty texel.
struct Kept {
    color: vec3<f32>,
    lod: f32,
    disparity: f32,
    place_px: vec2<f32>,
}

// kept::multiple
fn multiple(v: f32, exponent: u32, up: f32) -> u32 {
    // A power of two: the product is exact.
    return u32(v * bitcast<f32>((262u - exponent) << 23u) + up);
}

// kept::pack_color
fn pack_color(c: vec3<f32>) -> u32 {
    return pack_color_by(c, 0.5);
}

// kept::pack_color_by
fn pack_color_by(c: vec3<f32>, up: f32) -> u32 {
    let v = select(vec3<f32>(0.0), min(c, vec3<f32>(MAX_COLOR)), c > vec3<f32>(0.0));
    let largest = max(max(v.x, v.y), v.z);
    let rough = max(bitcast<u32>(largest) >> 23u, SMALLEST_EXPONENT);
    // Rounding may carry into a tenth bit.
    let exponent = rough + (multiple(largest, rough, up) >> 9u);
    return multiple(v.x, exponent, up)
        | (multiple(v.y, exponent, up) << 9u)
        | (multiple(v.z, exponent, up) << 18u)
        | ((exponent - SMALLEST_EXPONENT) << 27u);
}

// kept::unpack_color
fn unpack_color(word: u32) -> vec3<f32> {
    let step = bitcast<f32>(((word >> 27u) + (SMALLEST_EXPONENT - 8u)) << 23u);
    return vec3<f32>(f32(word & 511u), f32((word >> 9u) & 511u), f32((word >> 18u) & 511u)) * step;
}

fn pack_place(v: f32) -> u32 {
    return u32(clamp(floor(v * PLACE_STEPS + 32.5), 0.0, 63.0));
}

fn unpack_place(bits: u32) -> f32 {
    return (f32(bits & 63u) - 32.0) * (1.0f / PLACE_STEPS);
}

// kept::pack_kept
fn pack_kept(s: Kept) -> vec2<u32> {
    var lod = EMPTY_LOD;
    if s.lod >= 0.0 {
        lod = u32(min(s.lod, MAX_LOD) * LOD_STEPS + 1.5);
    }
    let code = disparity_code(s.disparity);
    // The last code stands for an unknown disparity.
    let disparity = select(min((code + 2u) >> 2u, 0x3ffeu), 0x3fffu, code == 0xffffu);
    return vec2<u32>(
        pack_color(s.color),
        lod | (disparity << 6u) | (pack_place(s.place_px.x) << 20u) | (pack_place(s.place_px.y) << 26u),
    );
}

// kept::unpack_kept
fn unpack_kept(words: vec2<u32>) -> Kept {
    if is_empty(words) {
        return Kept(vec3<f32>(0.0), -1.0, -1.0, vec2<f32>(0.0));
    }
    return unpack_full(words);
}

// kept::is_empty
fn is_empty(words: vec2<u32>) -> bool {
    return (words.y & 63u) == EMPTY_LOD;
}

// kept::code_word
fn code_word(words: vec2<u32>) -> u32 {
    return (words.y << 12u) & 0xfffc0000u;
}

// kept::unpack_full
fn unpack_full(words: vec2<u32>) -> Kept {
    let code = (words.y >> 6u) & 0x3fffu;
    return Kept(
        unpack_color(words.x),
        // The limit keeps compilers from merging this factor with later ones.
        min(lod_value(words.y & 63u), MAX_LOD),
        select(disparity_value(code << 2u), -1.0, code == 0x3fffu),
        vec2<f32>(unpack_place(words.y >> 20u), unpack_place(words.y >> 26u)),
    );
}

// kept::moved_kept
fn moved_kept(s: Kept, texel_px: vec2<f32>, scale: vec2<f32>, lod_shift: f32) -> Kept {
    if s.lod < 0.0 {
        return s;
    }
    let place = (texel_px + s.place_px) * scale;
    let near = max(abs(place.x), abs(place.y)) <= FARTHEST_PX;
    let lod = max(s.lod + lod_shift, 0.0);
    return Kept(s.color, select(max(lod, 1.0), lod, near), s.disparity, place);
}

struct AroundKept {
    weight: f32,
    color: vec3<f32>,
    lod: f32,
    place: vec2<f32>,
    square: vec3<f32>,
    color_x: vec3<f32>,
    color_y: vec3<f32>,
    lowest: vec3<f32>,
    highest: vec3<f32>,
    nearest: Kept,
    cost: f32,
}

fn nothing_around() -> AroundKept {
    let zero = vec3<f32>(0.0);
    let empty = Kept(zero, -1.0, -1.0, vec2<f32>(0.0));
    return AroundKept(0.0, zero, 0.0, vec2<f32>(0.0), zero, zero, zero, vec3<f32>(MAX_COLOR), zero, empty, 1e30);
}

// kept::kept_weight
fn kept_weight(px2: f32, inverse_reach: f32) -> f32 {
    let inside = max(1.0 - px2 * inverse_reach, 0.0);
    return (inside * inside) / (px2 + SOFTEN_PX2);
}

// kept::add_kept
fn add_kept(a: AroundKept, sampled: Kept, texel_px: vec2<f32>, same: bool, inverse_reach: f32) -> AroundKept {
    if !same {
        return a;
    }
    let place = texel_px + sampled.place_px;
    let px2 = place.x * place.x + place.y * place.y;
    let w = kept_weight(px2, inverse_reach);
    let wx = w * place.x;
    let wy = w * place.y;
    let cost = px2 + sampled.lod * LOD_PX2;
    var nearest = a.nearest;
    if cost < a.cost {
        nearest = Kept(sampled.color, sampled.lod, sampled.disparity, place);
    }
    return AroundKept(
        a.weight + w,
        a.color + sampled.color * w,
        a.lod + sampled.lod * w,
        a.place + vec2<f32>(wx, wy),
        a.square + vec3<f32>(wx * place.x, wx * place.y, wy * place.y),
        a.color_x + sampled.color * wx,
        a.color_y + sampled.color * wy,
        min(a.lowest, sampled.color),
        max(a.highest, sampled.color),
        nearest,
        select(a.cost, cost, cost < a.cost),
    );
}

const STAND_IN: f32 = 1.6;

// kept::stands_in
fn stands_in(a: AroundKept) -> bool {
    return a.weight >= STAND_IN;
}

struct Interpolated {
    color: vec3<f32>,
    lod: f32,
    lowest: vec3<f32>,
    highest: vec3<f32>,
    nearest: Kept,
}

// kept::interpolate
fn interpolate(a: AroundKept) -> Interpolated {
    var nearest = a.nearest;
    let distance = max(abs(nearest.place_px.x), abs(nearest.place_px.y));
    if nearest.lod < 0.0 || distance <= EXACT_PX {
        nearest.place_px = vec2<f32>(0.0);
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
    let determinant = max(xx * yy - xy * xy, (stiff * stiff) * 0.5);
    let across = a.color_x * a.weight - a.color * a.place.x;
    let down = a.color_y * a.weight - a.color * a.place.y;
    // The plane's value at the position is the mean, minus its slopes times the mean place.
    let rise = across * (yy * a.place.x - xy * a.place.y) + down * (xx * a.place.y - xy * a.place.x);
    let inverse = 1.0 / a.weight;
    let color = max((a.color - rise / determinant) * inverse, vec3<f32>(0.0));
    return Interpolated(color, a.lod * inverse, a.lowest, a.highest, nearest);
}
