//#use previous
//#use resample
//#use color
// Stored history of a pixel's surface; shared by the methods that store surfaces (smr, taa). CPU twin:
// src/cpu/levels/surface_history.rs.

@group(0) @binding(15) var past_surfaces: texture_2d_array<u32>;
@group(0) @binding(16) var past_mips: texture_2d_array<f32>;
@group(0) @binding(17) var past_noise: texture_2d_array<u32>;
@group(0) @binding(18) var next_surfaces: texture_storage_2d_array<rg32uint, write>;
@group(0) @binding(19) var next_mips: texture_storage_2d_array<rgba16float, write>;
@group(0) @binding(20) var next_noise: texture_storage_2d_array<r32uint, write>;
@group(0) @binding(21) var candidate_mips: texture_2d_array<f32>;

// All fields but the verdict are valid only if that is VERDICT_VALID.
struct Source {
    previous: Previous,
    texel: vec2i,
    fraction: vec2f,
    nearest: Surface,
}

fn words_at(texel: vec2i, view: u32) -> vec2u {
    let at = clamp(texel, vec2i(0), vec2i(frame.size) - 1);
    return textureLoad(past_surfaces, at, view, 0).xy;
}

fn surface_at(texel: vec2i, view: u32) -> Surface {
    return unpack_surface(words_at(texel, view));
}

// Previous position of a pixel's surface. At a silhouette the nearest texel may show another surface. The texel with
// the second largest weight then replaces it. It is always read, because a branch costs more on software Vulkan.
fn source_of(px: vec2u, view: u32, motion: vec2f, disparity_now: f32) -> Source {
    let at = reprojected(px, view, motion);
    let words = words_at(vec2i(at.at), view);
    let stored = unpack_surface(words);
    var previous = previous_of(px, view, motion, disparity_now, at, stored.lod, stored.disparity);
    let whole = floor(previous.at);
    let texel = vec2i(whole);
    let fraction = previous.at - whole;
    let corner = second_corner(fraction);
    let beside = texel + vec2i(vec2u(corner & 1u, corner >> 1u));
    let other_at = clamp(beside, vec2i(0), vec2i(frame.size) - 1);
    let other_words = words_at(other_at, view);
    let other = unpack_surface(other_words);
    let stands_in = previous.verdict == VERDICT_DISOCCLUDED
        && corner_weight(corner, fraction) > STAND_IN_WEIGHT
        && other.lod >= 0.0
        && same_surface(previous.expected, other.disparity, frame.depth_relative, 0.0);
    if stands_in {
        previous.verdict = VERDICT_VALID;
        previous.nearest_at = vec2u(other_at);
    }
    let chosen = Surface(
        surface_color(select(words, other_words, stands_in)),
        select(stored.lod, other.lod, stands_in),
        select(stored.disparity, other.disparity, stands_in),
    );
    return Source(previous, texel, fraction, chosen);
}

fn tap(texel: vec2i, view: u32, codes: vec2u) -> Tap {
    return surface_tap(textureLoad(past_surfaces, texel, view, 0).xy, codes, DEPTH_TEST == 0u);
}

// History resampled at a position; a position exactly on a texel reads that texel. Where `needed` is false the loops
// have zero iterations: software Vulkan runs the body of an `if` for all pixels.
fn resample(source: Source, view: u32, needed: bool) -> Resampled {
    let between = needed && !(source.fraction.x == 0.0 && source.fraction.y == 0.0);
    var resampled = Resampled(source.nearest.color, source.nearest.color, source.nearest.lod);
    // Variable counts on purpose: Mesa would unroll a constant one and reorder its sums of products.
    let rounds = select(0u, ROUNDS, between);
    for (var once = 0u; once < min(rounds, 1u); once++) {
        let taps = taps_around(source.texel, source.fraction, frame.size);
        let codes = tap_codes(source.previous.expected);
        var gathered = nothing_gathered();
        for (var i = 0u; i < rounds; i++) {
            let four = taps_of(taps, i);
            gathered = gather(
                gathered,
                tap(four.a, view, codes),
                tap(four.b, view, codes),
                tap(four.c, view, codes),
                tap(four.d, view, codes),
                four,
            );
        }
        resampled = resolve(gathered, sharp_sum(taps), source.nearest);
    }
    return resampled;
}

// Stored color scaled to this frame's exposure.
fn exposed(stored: vec3f) -> vec3f {
    return expose(stored, frame.exposure);
}

// Noise of the nearest texel, scaled to this frame's exposure.
fn past_noise_of(source: Source, view: u32) -> Noise {
    return expose_noise(unpack_noise(textureLoad(past_noise, source.previous.nearest_at, view, 0).x), frame.exposure);
}
