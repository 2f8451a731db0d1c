//#use previous
//#use resample
//#use sparse
//#use wrs
// Stored samples around the previous position of a pixel's surface, for smr on sparse frames. CPU twin:
// src/cpu/sparse_pass.rs.

@group(0) @binding(8) var past_kept: texture_2d_array<u32>;

fn kept_words(texel: vec2<i32>, view: u32) -> vec2<u32> {
    return textureLoad(past_kept, clamp(texel, vec2<i32>(0), vec2<i32>(frame.size) - 1), view, 0).xy;
}

fn kept_at(texel: vec2<i32>, view: u32) -> Kept {
    return unpack_kept(kept_words(texel, view));
}

// Previous position of a pixel's surface.
fn kept_source(px: vec2<u32>, view: u32, motion: vec2<f32>, disparity_now: f32) -> Previous {
    let at = reprojected(px, motion);
    let stored = kept_at(vec2<i32>(at.at), view);
    return previous_of(px, view, motion, disparity_now, at, stored.lod, stored.disparity);
}

// Whether history may be at a previous position.
fn may_have_history(previous: Previous) -> bool {
    return previous.verdict == VERDICT_VALID || previous.verdict == VERDICT_DISOCCLUDED;
}

// History, and the texel of the sample to keep.
struct KeptHistory {
    found: Interpolated,
    texel: vec2<i32>,
}

// History at a previous position, in this frame's exposure. At a silhouette, where the nearest stored sample is of
// another surface, samples beside it stand in for it if they are near enough. Where `needed` is false the loop has zero
// iterations: software Vulkan runs the body of an `if` for all pixels.
fn kept_history(previous: Previous, view: u32, needed: bool) -> KeptHistory {
    var around = nothing_around();
    let first = vec2<i32>(floor(previous.at));
    var nearest_texel = first;
    let codes = tap_codes(previous.expected);
    let taps = select(0u, 4u, needed);
    for (var tap = 0u; tap < taps; tap++) {
        let texel = first + vec2<i32>(vec2<u32>(tap & 1u, tap >> 1u));
        let words = kept_words(texel, view);
        let same = !is_empty(words) && (DEPTH_TEST == 0u || has_code(code_word(words), codes));
        let cost = around.cost;
        around = add_kept(around, unpack_full(words), vec2<f32>(texel) - previous.at, same);
        nearest_texel = select(nearest_texel, texel, around.cost < cost);
    }
    if previous.verdict == VERDICT_DISOCCLUDED && !stands_in(around) {
        around = nothing_around();
    }
    var found = interpolate(around);
    found.color = expose(found.color, frame.exposure);
    found.lowest = expose(found.lowest, frame.exposure);
    found.highest = expose(found.highest, frame.exposure);
    found.nearest.color = expose(found.nearest.color, frame.exposure);
    return KeptHistory(found, nearest_texel);
}

// Whether history has moved since its samples were shaded, by more than their stored places resolve.
fn has_moved(motion: vec2<f32>, place_px: vec2<f32>) -> bool {
    return max(abs(motion.x), abs(motion.y)) > EXACT_PX || max(abs(place_px.x), abs(place_px.y)) > EXACT_PX;
}
