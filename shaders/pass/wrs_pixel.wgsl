//#use inputs
//#use output
//#use pack
//#use rng
//#use wrs
// Weighted reservoirs in one pass: sanitize, reproject, reject, expose, gate, bias, combine, store and output. CPU
// twin: src/cpu/wrs_pass.rs, which lists the reads and writes.

// Settings as constants of a pipeline: what is off is not compiled.
override SAMPLER: u32 = 0u;
override BIAS: u32 = 2u;
override GATE: u32 = 1u;

@group(0) @binding(8) var past_colors: texture_2d_array<u32>;
@group(0) @binding(9) var past_weights: texture_2d_array<u32>;
@group(0) @binding(10) var past_keys: texture_2d_array<f32>;
@group(0) @binding(11) var next_colors: texture_storage_2d_array<rg32uint, write>;
@group(0) @binding(12) var next_weights: texture_storage_2d_array<r32uint, write>;
@group(0) @binding(13) var next_keys: texture_storage_2d_array<r32float, write>;

// History of a pixel. All fields but the verdict are valid only if that is VERDICT_VALID.
struct History {
    verdict: u32,
    past: Past,
    age: u32,
}

fn no_history(verdict: u32) -> History {
    return History(verdict, Past(vec3<f32>(0.0), 0.0, LOWEST), 0u);
}

// Reservoir of the pixel's surface in the previous frame and age of its sample, or the reason for its rejection.
fn history_of(px: vec2<u32>, view: u32, ray: vec3<f32>, motion: vec2<f32>, disparity_now: f32) -> History {
    if frame.reset != 0u {
        return no_history(VERDICT_RESET);
    }
    let source = nearest(px.x, px.y, motion, frame.size);
    if source.verdict != VERDICT_VALID {
        return no_history(source.verdict);
    }
    let colors = textureLoad(past_colors, source.at, view, 0).xy;
    let stored = unpack(vec3<u32>(colors, textureLoad(past_weights, source.at, view, 0).x));
    if stored.w_sum == 0.0 {
        return no_history(VERDICT_EMPTY);
    }
    var past = Past(stored.color, stored.w_sum, LOWEST);
    if SAMPLER == SAMPLER_A_ES {
        past.log_key = textureLoad(past_keys, source.at, view, 0).x;
    }
    if HAS_TRUST != 0u {
        past = scale_by_trust(past, trust_at(px, view), SAMPLER);
        if past.w_sum == 0.0 {
            return no_history(VERDICT_DISTRUSTED);
        }
    }
    if !is_same_surface(px, view, disparity_now, expected_disparity(view, ray, disparity_now), stored.disparity) {
        return no_history(VERDICT_DISOCCLUDED);
    }
    past.color = expose(past.color, frame.exposure);
    return History(VERDICT_VALID, past, stored.age);
}

// Pixel of a pixel's sample, and the weight of a sample there.
struct Place {
    px: vec2<u32>,
    weight: f32,
}

fn pixel(px: vec2<u32>, view: u32, place: Place) {
    let given = color_at(px, view);
    let candidate = color(given.xyz);
    let motion = motion_at(px, view);
    let constants = frame.views[view];
    let ray = ray_at(px, view);
    var candidate_w = 0.0;
    if candidate.usable {
        let e_deg = eccentricity_deg(ray, constants.gaze_ray.xyz);
        candidate_w = candidate_weight(e_deg, frame.fovea_radius_deg, frame.inv_density_at_fovea);
        candidate_w *= place.weight;
    }
    var gate_offset = frame.gate_offset;
    if NOISY != 0u {
        let noise = noise_at(place.px, view);
        candidate_w *= noise.samples;
        gate_offset += sample_difference(noise, luma(candidate.color));
    }
    let disparity_now = disparity_at(px, view);
    let history = history_of(px, view, ray, motion, disparity_now);
    let valid = history.verdict == VERDICT_VALID;
    let params = WrsParams(SAMPLER, BIAS, frame.exponential_survival, GATE, gate_offset, frame.inv_gate_divisor);
    let draw = unit_draw(bits(px.x, px.y, frame.frame_low, constants.key));
    let decision = step(candidate.color, candidate_w, history.past, params, draw);
    count_pixel(px, view, candidate.usable, disparity_now, history.verdict);
    count_if(valid && decision.take, COUNT_REPLACED);

    let shown = select(history.past.color, candidate.color, decision.take);
    let age = select(min(history.age + 1u, MAX_AGE), 0u, decision.take);
    let survival = select(0.0, decision.survival, valid);
    let quality = decision.w_sum * (1.0 / 16.0);
    let traced = PixelTrace(history.verdict, candidate_w, quality, age, survival, decision.gate, decision.take, motion);
    write_output(px, view, shown, given.w, traced);
    if VIEW != 0u {
        return;
    }
    let words = pack(Stored(shown, disparity_now, decision.w_sum, age));
    textureStore(next_colors, px, view, vec4<u32>(words.xy, 0u, 0u));
    textureStore(next_weights, px, view, vec4<u32>(words.z, 0u, 0u, 0u));
    if SAMPLER == SAMPLER_A_ES {
        textureStore(next_keys, px, view, vec4<f32>(decision.log_key, 0.0, 0.0, 0.0));
    }
}
