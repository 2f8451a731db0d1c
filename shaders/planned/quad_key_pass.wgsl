//#use sparse_history
//#use sparse_noise
//#use quad_state
// Region, even pattern and key of the quads of a frame. CPU twin: `plan_quads` in src/cpu/planned/quad_plan.rs. One
// invocation a block of 2x2 quads of view `frame.first_view`.
//
// Up to 7 reads and 1 write a quad: depth, motion, trust and four stored samples of one pixel; 1 atomic sum a quad,
// up to 16 in noisy frames.

// Whether the method has history to choose by.
override HAS_SPARSE_HISTORY: u32 = 0u;

@group(0) @binding(23) var keys_out: texture_storage_2d_array<r32uint, write>;

// Need of a pixel: of its first path, without the noise of history, negative without history; due to that noise; and
// the samples of history.
struct PixelNeed {
    first: f32,
    noise: f32,
    samples: u32,
}

// Need of a pixel, from the four stored samples around its previous position.
fn need_at(px: vec2u, view: u32) -> PixelNeed {
    let motion = motion_at(px, view);
    var is_valid = reprojected(px, view, motion).verdict == VERDICT_VALID;
    if HAS_TRUST != 0u {
        is_valid = is_valid && trust(trust_at(px, view)) > 0.0;
    }
    let disparity_now = disparity_at(px, view);
    let codes = tap_codes(expected_disparity(view, ray_at(px, view), disparity_now));
    let moved_px = moved_px_at(px, view, disparity_now, motion);
    let at = vec2f(px) + motion;
    let first = floor(at);
    var around = no_past();
    var past = Noise(1.0, 0.0);
    var noises = NoiseSum(0.0, 0.0, 0.0);
    let taps = select(0u, 4u, is_valid);
    for (var tap = 0u; tap < taps; tap++) {
        let texel = first + vec2f(vec2u(tap & 1u, tap >> 1u));
        let words = stored_words(vec2i(texel), view);
        if !is_empty(words) && is_reusable(words, codes, moved_px) {
            let stored = unpack_full(words);
            let offset = texel - at;
            let px2 = offset.x * offset.x + offset.y * offset.y;
            if NOISY != 0u {
                let noise_here = stored_noise(vec2i(texel), view);
                noises = add_noise(noises, noise_here, 1.0);
                if px2 < around.nearest_px2 {
                    past = noise_here;
                }
            }
            var mean = Mean(stored.lod, ENOUGH_SAMPLES, 0.0, 0.0);
            if ANTIALIAS != 0u {
                mean = mean_of(stored.lod);
            }
            around = with_past(around, stored.color, mean.lod, mean.samples, px2);
        }
    }
    var found = PixelNeed(need_around(around), 0.0, 1u);
    if NOISY != 0u && around.lod >= 0.0 {
        // The variance of few samples is uncertain: the mean of all four takes its place.
        past.variance = mean_noise(noises).variance;
        found.noise = noise_need(past, luma(expose(around.color, frame.exposure)));
        found.samples = known_samples(past.samples);
    }
    return found;
}

// Number in its quad of the pixel of the even pattern, where single pixels are shaded.
fn even_place(region_now: u32) -> u32 {
    return place_in_quad(select(frame.pattern_px.zw, frame.pattern_px.xy, region_now == IN_MIDDLE));
}

// Whether the lens shows a pixel of a quad.
fn is_seen_quad(quad: vec2u, view: u32) -> bool {
    var seen = false;
    for (var i = 0u; i < 4u; i++) {
        let px = 2u * quad + vec2u(i & 1u, i >> 1u);
        seen = seen || (all(px < frame.size) && is_seen(px, view));
    }
    return seen;
}

// The even pattern of the frame.
fn even_pattern() -> EvenPattern {
    let steps = vec2u(1u << (u32(frame.lod_mid) - 1u), 1u << (u32(frame.lod_far) - 1u));
    return EvenPattern(steps, frame.pattern_px.xy / 2u, frame.pattern_px.zw / 2u, frame.frame_low & 1u);
}

fn block(at: vec2u, view: u32) {
    var needs = vec4f(0.0);
    var noise_needs = vec4f(0.0);
    var samples = vec4u(1u);
    var words = vec4u(0u);
    var even_count = 0u;
    let quads = (frame.size + 1u) / 2u;
    for (var i = 0u; i < 4u; i++) {
        let quad = 2u * at + vec2u(i & 1u, i >> 1u);
        if any(quad >= quads) {
            continue;
        }
        let e_deg = region_angle_deg(ray_at(2u * quad, view), frame.views[view].gaze_ray);
        let region_now = region(e_deg, frame.fovea_radius_deg, frame.mid_radius_deg);
        var even = is_seen_quad(quad, view) && is_even(even_pattern(), quad.x, quad.y, region_now);
        let is_single = frame.single_pixels != 0u && region_now != IN_FOVEA;
        if is_single {
            let alone = 2u * quad + vec2u(even_place(region_now) & 1u, even_place(region_now) >> 1u);
            even = even && all(alone < frame.size) && is_seen(alone, view);
        }
        let probed = place_in_quad(probed_px(quad.x, quad.y, frame.frame_low));
        let place = select(probed, even_place(region_now), even);
        var pixels = WHOLE;
        if is_single {
            pixels = 1u << place;
        }
        // Not `words[i] = ...`: FXC, which wgpu has on Windows without another compiler, cannot write vectors so.
        let is_i = vec4u(0u, 1u, 2u, 3u) == vec4u(i);
        words = select(words, vec4u(key_word(0u, region_now, even, pixels)), is_i);
        let px = 2u * quad + vec2u(place & 1u, place >> 1u);
        even_count += u32(even);
        let is_probed = region_now != IN_FOVEA && (!even || NOISY != 0u) && all(px < frame.size);
        if HAS_SPARSE_HISTORY != 0u && frame.has_budget != 0u && is_probed && is_seen(px, view) {
            let found = need_at(px, view);
            let first = vec2u(frame.first_quad & 0xffffu, frame.first_quad >> 16u);
            let no_history = no_history_need(quad.x, quad.y, first);
            let needed = select(found.first * acuity(e_deg), no_history, found.first < 0.0) * f32(!even);
            needs = select(needs, vec4f(needed), is_i);
            noise_needs = select(noise_needs, vec4f(found.noise * acuity(e_deg)), is_i);
            samples = select(samples, vec4u(found.samples), is_i);
        }
    }
    if even_count > 0u {
        atomicAdd(&state.even, even_count);
    }
    for (var i = 0u; i < 4u; i++) {
        let quad = 2u * at + vec2u(i & 1u, i >> 1u);
        if any(quad >= quads) {
            continue;
        }
        let even = (words[i] & 0x10000u) != 0u;
        let needed = needs[i] * share_in_block(needs, i) + noise_needs[i];
        let view_key = frame.views[view].key;
        let key = quad_key(select(needed, 0.0, even), quad.x, quad.y, frame.frame_low, view_key);
        if key > 0u {
            atomicAdd(&state.counts[key], 1u);
        }
        var word = words[i] | key;
        if NOISY != 0u {
            let further = quad_key(noise_needs[i], quad.x, quad.y, frame.frame_low, view_key);
            for (var path = 2u; path <= MOST_PATHS; path++) {
                let key_of_path = path_key(further, samples[i], path);
                if key_of_path == 0u {
                    break;
                }
                atomicAdd(&state.further[key_of_path], 1u);
            }
            word |= further_word(further, samples[i]);
        }
        textureStore(keys_out, quad, view, vec4u(word, 0u, 0u, 0u));
    }
}

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if all(4u * id.xy < frame.size) {
        block(id.xy, frame.first_view);
    }
}
