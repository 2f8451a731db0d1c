//#use previous
//#use resample
//#use wrs
// Stored history of a pixel's surface, at its previous position; shared by the methods that store surfaces (smr, taa).
// CPU twin: src/cpu/surface_history.rs.

@group(0) @binding(9) var past_surfaces: texture_2d_array<u32>;
@group(0) @binding(10) var past_mips: texture_2d_array<f32>;
@group(0) @binding(11) var next_surfaces: texture_storage_2d_array<rg32uint, write>;
@group(0) @binding(12) var next_mips: texture_storage_2d_array<rgba16float, write>;
@group(0) @binding(13) var past_noise: texture_2d_array<u32>;
@group(0) @binding(14) var candidate_mips: texture_2d_array<f32>;
@group(0) @binding(15) var next_noise: texture_storage_2d_array<r32uint, write>;

// All fields but the verdict are valid only if that is VERDICT_VALID.
struct Source {
    previous: Previous,
    texel: vec2<i32>,
    fraction: vec2<f32>,
    nearest: Surface,
}

fn words_at(texel: vec2<i32>, view: u32) -> vec2<u32> {
    let at = clamp(texel, vec2<i32>(0), vec2<i32>(frame.size) - 1);
    return textureLoad(past_surfaces, at, view, 0).xy;
}

fn surface_at(texel: vec2<i32>, view: u32) -> Surface {
    return unpack_surface(words_at(texel, view));
}

// Previous position of a pixel's surface. At a silhouette the nearest texel may show another surface. Then the one with
// the second largest weight stands in for it. It is read without a branch, which costs more on software Vulkan.
fn source_of(px: vec2<u32>, view: u32, motion: vec2<f32>, disparity_now: f32) -> Source {
    let at = reprojected(px, motion);
    let words = words_at(vec2<i32>(at.at), view);
    let stored = unpack_surface(words);
    var previous = previous_of(px, view, motion, disparity_now, at, stored.lod, stored.disparity);
    let whole = floor(previous.at);
    let texel = vec2<i32>(whole);
    let fraction = previous.at - whole;
    let corner = second_corner(fraction);
    let beside = texel + vec2<i32>(vec2<u32>(corner & 1u, corner >> 1u));
    let other_at = clamp(beside, vec2<i32>(0), vec2<i32>(frame.size) - 1);
    let other_words = words_at(other_at, view);
    let other = unpack_surface(other_words);
    let stands_in = previous.verdict == VERDICT_DISOCCLUDED
        && corner_weight(corner, fraction) > STAND_IN_WEIGHT
        && other.lod >= 0.0
        && same_surface(previous.expected, other.disparity, frame.depth_relative, 0.0);
    if stands_in {
        previous.verdict = VERDICT_VALID;
        previous.nearest_at = vec2<u32>(other_at);
    }
    return Source(previous, texel, fraction, unpack_surface(select(words, other_words, stands_in)));
}

fn component(v: vec4<f32>, i: u32) -> f32 {
    return select(select(v.x, v.y, i == 1u), select(v.z, v.w, i == 3u), i > 1u);
}

// History resampled at a position; a position exactly on a texel reads that texel. Where `needed` is false the loop has
// zero iterations: software Vulkan runs the body of an `if` for all pixels.
fn resample(source: Source, view: u32, needed: bool) -> Resampled {
    let between = needed && !(source.fraction.x == 0.0 && source.fraction.y == 0.0);
    let sharp_x = catmull_rom(source.fraction.x);
    let sharp_y = catmull_rom(source.fraction.y);
    let smooth_x = linear_weights(source.fraction.x);
    let smooth_y = linear_weights(source.fraction.y);
    var gathered = Gathered(vec3<f32>(0.0), 0.0, vec3<f32>(0.0), 0.0, 0.0, 0u);
    let taps = select(0u, TAPS, between);
    for (var tap = 0u; tap < taps; tap++) {
        let at = tap_at(tap);
        let s = surface_at(source.texel + vec2<i32>(at) - 1, view);
        var same = s.lod >= 0.0;
        if DEPTH_TEST != 0u {
            same = same && same_surface(source.previous.expected, s.disparity, TAP_RELATIVE, 0.0);
        }
        let sharp = component(sharp_x, at.x) * component(sharp_y, at.y);
        let smooth_w = component(smooth_x, at.x) * component(smooth_y, at.y);
        gathered = gather(gathered, s, same, sharp, smooth_w);
    }
    // Without taps this is the nearest texel.
    return resolve(gathered, source.nearest);
}

// Stored color scaled to this frame's exposure.
fn exposed(stored: vec3<f32>) -> vec3<f32> {
    return expose(stored, frame.exposure);
}

// Noise of the nearest texel, scaled to this frame's exposure.
fn past_noise_of(source: Source, view: u32) -> Noise {
    return expose_noise(unpack_noise(textureLoad(past_noise, source.previous.nearest_at, view, 0).x), frame.exposure);
}
