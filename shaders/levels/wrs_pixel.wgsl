//#use candidate_lod
//#use inputs
//#use output
//#use mip_noise
//#use pack
//#use past_frame
//#use resample
//#use rng
//#use stored_reservoir
//#use wrs
//#use acuity
// Weighted reservoirs in one pass: sanitize, reproject, reject, expose, gate, bias, combine, store and output. CPU
// twin: src/cpu/levels/wrs_pass.rs, which lists the reads and writes.

// Settings as constants of a pipeline: code for settings that are off is not compiled.
override SAMPLER: u32 = 0u;
override BIAS: u32 = 2u;
override GATE: u32 = 1u;
override WEIGHT_EXPONENT: u32 = 1u;
override RATE_EXPONENT: u32 = 0u;
override HAS_REFERENCES: u32 = 0u;

// Extras are the bits of log keys with A-ES, packed references with HAS_REFERENCES.
@group(0) @binding(15) var past_colors: texture_2d_array<u32>;
@group(0) @binding(16) var past_weights: texture_2d_array<u32>;
@group(0) @binding(17) var past_extras: texture_2d_array<u32>;
@group(0) @binding(18) var next_colors: texture_storage_2d_array<rg32uint, write>;
@group(0) @binding(19) var next_weights: texture_storage_2d_array<r32uint, write>;
@group(0) @binding(20) var next_extras: texture_storage_2d_array<r32uint, write>;

// History of a pixel. All fields but the verdict are valid only if that is VERDICT_VALID.
struct History {
    verdict: u32,
    past: Past,
    age: u32,
    reference: Reference,
}

fn no_history(verdict: u32) -> History {
    return History(verdict, Past(vec3f(0.0), 0.0, LOWEST), 0u, Reference(vec3f(0.0), NO_LEVEL));
}

fn tap(texel: vec2i, view: u32, codes: vec2u) -> Tap {
    let words = textureLoad(past_colors, texel, view, 0).xy;
    let stored = unpack_sample(words);
    return Tap(stored.color, 0.0, stored.valid && (DEPTH_TEST == 0u || has_code(words.y, codes)));
}

// Mean of history at a position, by Catmull-Rom weights, in this frame's exposure. At the centre of a pixel it is
// exactly `nearest_color`.
fn resampled(at: vec2f, view: u32, expected: f32, nearest_color: vec3f, candidate: vec3f) -> vec3f {
    let whole = floor(at);
    let fraction = at - whole;
    let nearest_exposed = expose(nearest_color, frame.exposure);
    var mean = nearest_exposed;
    // Variable counts on purpose: Mesa would unroll a constant one and reorder its sums of products.
    let rounds = select(ROUNDS, 0u, fraction.x == 0.0 && fraction.y == 0.0);
    for (var once = 0u; once < min(rounds, 1u); once++) {
        let taps = taps_around(vec2i(whole), fraction, frame.size);
        let codes = tap_codes(expected);
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
        let resolved = resolve(gathered, sharp_sum(taps), Surface(nearest_color, 0.0, expected)).sharp;
        mean = unspread(candidate, nearest_exposed, expose(resolved, frame.exposure));
    }
    return mean;
}

// Reservoir of the pixel's surface in the previous frame and age of its sample, or the reason for its rejection.
fn history_of(px: vec2u, view: u32, candidate: vec3f, ray: vec3f, motion: vec2f, disparity_now: f32) -> History {
    let source = reprojected(px, view, motion);
    if source.verdict != VERDICT_VALID {
        return no_history(source.verdict);
    }
    let colors = textureLoad(past_colors, source.at, view, 0).xy;
    let stored = unpack(vec3u(colors, textureLoad(past_weights, source.at, view, 0).x));
    if stored.w_sum == 0.0 {
        return no_history(VERDICT_EMPTY);
    }
    var past = Past(stored.color, stored.w_sum, LOWEST);
    if SAMPLER == SAMPLER_A_ES {
        past.log_key = bitcast<f32>(textureLoad(past_extras, source.at, view, 0).x);
    }
    if HAS_TRUST != 0u {
        past = scale_by_trust(past, trust_at(px, view), SAMPLER);
        if past.w_sum == 0.0 {
            return no_history(VERDICT_DISTRUSTED);
        }
    }
    let expected = expected_disparity(view, ray, disparity_now);
    if !is_same_surface(px, view, disparity_now, expected, stored.disparity) {
        return no_history(VERDICT_DISOCCLUDED);
    }
    past.color = expose(past.color, frame.exposure);
    if SAMPLER == SAMPLER_A_CHAO_MEAN && HAS_MOTION != 0u {
        past.color = resampled(vec2f(px) + motion, view, expected, stored.color, candidate);
    }
    var reference = Reference(vec3f(0.0), NO_LEVEL);
    if HAS_REFERENCES != 0u {
        reference = unpack_reference(textureLoad(past_extras, source.at, view, 0).x);
        reference.color = expose(reference.color, frame.exposure);
    }
    return History(VERDICT_VALID, past, stored.age, reference);
}

// Pixel of the sample nearest to a pixel, and the weight of its place.
struct Place {
    px: vec2u,
    weight: f32,
}

// Code of the candidate's level of detail. `sampled`: whether the pixel has a sample of its own. On planned frames
// such a candidate is a full-rate one, and all others are interpolated.
fn level_code_of(px: vec2u, view: u32, e_deg: f32, sampled: bool) -> u32 {
    if FILTER == FILTER_QUADS {
        return select(NO_LEVEL, 0u, sampled);
    }
    return level_code(candidate_lod(px, view, e_deg));
}

fn weighted_pixel(px: vec2u, view: u32, place: Place) {
    let given = color_at(px, view);
    let candidate = color(given.xyz);
    let motion = motion_at(px, view);
    let constants = frame.views[view];
    let ray = ray_at(px, view);
    var candidate_w = 0.0;
    let e_deg = region_angle_deg(ray, constants.gaze_ray);
    if candidate.usable {
        let acuity_w = candidate_weight(e_deg, frame.fovea_radius_deg, frame.inv_density_at_fovea);
        candidate_w = sharpen(acuity_w, WEIGHT_EXPONENT) * place.weight;
        if RATE_EXPONENT != 0u && FILTER != FILTER_QUADS {
            candidate_w = at_rate(candidate_w, candidate_lod(px, view, e_deg), RATE_EXPONENT);
        }
    }
    var gate_offset = frame.gate_offset;
    if NOISY != 0u {
        let noise = noise_at(place.px, view);
        candidate_w *= noise.samples;
        gate_offset += sample_difference(noise, luma(candidate.color));
    }
    let disparity_now = disparity_at(px, view);
    let history = history_of(px, view, candidate.color, ray, motion, disparity_now);
    let valid = history.verdict == VERDICT_VALID;
    let params = WrsParams(SAMPLER, BIAS, frame.exponential_survival, GATE, gate_offset, frame.inv_gate_divisor);
    let draw = unit_draw(bits(px.x, px.y, frame.frame_low, constants.key));
    let level = level_code_of(px, view, e_deg, all(place.px == px));
    var past = history.past;
    if HAS_REFERENCES != 0u {
        past.color = compared(candidate.color, level, history.reference);
    }
    let decision = decide_sample(candidate.color, candidate_w, past, params, draw);
    count_pixel(px, view, candidate.usable, disparity_now, history.verdict);
    count_if(valid && decision.take, COUNT_REPLACED);

    let shown = combined(candidate.color, candidate_w, history.past.color, decision, SAMPLER);
    let age = select(min(history.age + 1u, MAX_AGE), 0u, decision.take);
    let survival = select(0.0, decision.survival, valid);
    let quality = decision.w_sum * (1.0 / 16.0);
    let traced = PixelTrace(history.verdict, candidate_w, quality, age, survival, decision.gate, decision.take, motion);
    write_output(px, view, shown, given.w, traced);
    if VIEW != 0u {
        return;
    }
    var words = pack(Stored(shown, disparity_now, decision.w_sum, age));
    if SAMPLER == SAMPLER_A_CHAO_MEAN && decision.w_sum == 0.0 {
        words = EMPTY_WORDS;
    }
    textureStore(next_colors, px, view, vec4u(words.xy, 0u, 0u));
    textureStore(next_weights, px, view, vec4u(words.z, 0u, 0u, 0u));
    if SAMPLER == SAMPLER_A_ES {
        textureStore(next_extras, px, view, vec4u(bitcast<u32>(decision.log_key), 0u, 0u, 0u));
    }
    if HAS_REFERENCES != 0u {
        var reference = history.reference;
        if candidate.usable {
            reference = next_reference(candidate.color, level, decision.take, reference);
        }
        textureStore(next_extras, px, view, vec4u(pack_reference(reference), 0u, 0u, 0u));
    }
}
