//#use approx
//#use color
//#use lab
//#use reservoir
//#use sanitize
// Twin of src/kernel/wrs.rs: gate, bias, combine; references of the gate.

// wrs::SamplerCode
const SAMPLER_A_CHAO: u32 = 0u;
const SAMPLER_A_ES: u32 = 1u;
const SAMPLER_A_CHAO_MEAN: u32 = 2u;

// wrs::BiasCode
const BIAS_NONE: u32 = 0u;
const BIAS_EXPONENTIAL: u32 = 1u;
const BIAS_BERNOULLI: u32 = 2u;

// wrs::GateCode
const GATE_OFF: u32 = 0u;
const GATE_DELTA_E94: u32 = 1u;
const GATE_LIGHTNESS: u32 = 2u;

const NO_LEVEL: u32 = 63u;
const LEAST_EXPONENT: u32 = 112u;
const CHANNEL_BITS: u32 = 7u;
const FAR_FROM_CANDIDATE: f32 = 0.5;

struct Reference {
    color: vec3f,
    level: u32,
}

// Code of a level of detail from 0 to 8: the nearest quarter.
fn level_code(lod: f32) -> u32 {
    return u32(lod * 4.0 + 0.5);
}

// Packs a reference into a word: 7 bits a channel, 5 of their common exponent, 6 of the level.
fn pack_reference(r: Reference) -> u32 {
    let c = clamp(r.color, vec3f(0.0), vec3f(MAX_HALF));
    let largest = bitcast<u32>(max(max(c.x, c.y), c.z)) + (1u << (23u - CHANNEL_BITS));
    let exponent = max(largest >> 23u, LEAST_EXPONENT);
    let scale = bitcast<f32>((2u * 127u + CHANNEL_BITS - 1u - exponent) << 23u);
    let m = vec3u(c * scale + 0.5);
    return m.x | (m.y << 7u) | (m.z << 14u) | ((exponent - LEAST_EXPONENT) << 21u) | (r.level << 26u);
}

// Unpacks a reference.
fn unpack_reference(word: u32) -> Reference {
    let exponent = ((word >> 21u) & 31u) + LEAST_EXPONENT;
    let scale = bitcast<f32>((exponent + 1u - CHANNEL_BITS) << 23u);
    let channels = vec3u(word & 127u, (word >> 7u) & 127u, (word >> 14u) & 127u);
    return Reference(vec3f(channels) * scale, word >> 26u);
}

// Color that the gate compares with a candidate of level `level`: the reference if it has the same level.
fn compared(candidate: vec3f, level: u32, reference: Reference) -> vec3f {
    return select(candidate, reference.color, level != NO_LEVEL && reference.level == level);
}

// Reference after a frame with a candidate of level `level`.
fn next_reference(candidate: vec3f, level: u32, take: bool, reference: Reference) -> Reference {
    if take || (level != NO_LEVEL && reference.level != level) {
        return Reference(candidate, level);
    }
    return reference;
}

// Sharpened weight of a candidate: its weight by eccentricity (eq. 4), raised to a whole exponent of at least 1.
fn sharpen(candidate_w: f32, exponent: u32) -> f32 {
    var w = candidate_w;
    for (var i = 1u; i < exponent; i++) {
        w *= candidate_w;
    }
    return w;
}

const LEAST_CANDIDATE_W: f32 = 0x1p-100f;

// Weight of a candidate at level of detail `lod`: times the number of samples a pixel, `4^-lod`, to the power
// `exponent`.
fn at_rate(weight: f32, lod: f32, exponent: u32) -> f32 {
    return max(weight * exp2_approx(lod * (-2.0 * f32(exponent))), LEAST_CANDIDATE_W);
}

struct WrsParams {
    sampler_code: u32,
    bias_code: u32,
    exponential_survival: f32,
    gate_code: u32,
    gate_offset: f32,
    inv_gate_divisor: f32,
}

struct Past {
    color: vec3f,
    w_sum: f32,
    log_key: f32,
}

struct Decision {
    take: bool,
    w_sum: f32,
    log_key: f32,
    gate: f32,
    survival: f32,
}

// Reservoir with all weights multiplied by the history confidence `trust` (`sanitize::trust`), before gate and bias.
fn scale_by_trust(past: Past, history_trust: f32, sampler_code: u32) -> Past {
    let share = trust(history_trust);
    var log_key = past.log_key;
    if sampler_code == SAMPLER_A_ES {
        log_key = a_es_decay(past.log_key, share);
    }
    return Past(past.color, weight(past.w_sum * share), log_key);
}

// Square root of a color's luma; 0 for negative ones.
fn luma_root(c: vec3f) -> f32 {
    return sqrt(max(luma(c), 0.0));
}

// History's mean between reservoirs, or the nearest reservoir's color where that mean lies far from the candidate.
fn unspread(candidate: vec3f, nearest_color: vec3f, resampled_color: vec3f) -> vec3f {
    let root = luma_root(candidate);
    let far = abs(root - luma_root(nearest_color)) + FAR_FROM_CANDIDATE;
    return select(resampled_color, nearest_color, abs(root - luma_root(resampled_color)) > far);
}

// 1 - |dL| (eq. 7)
fn gate(difference: f32, offset: f32, inv_divisor: f32) -> f32 {
    return 1.0 - clamp((difference - offset) * inv_divisor, 0.0, 1.0);
}

// Exactly 0 for equal colors.
fn difference(candidate: vec3f, stored_color: vec3f, code: u32) -> f32 {
    if code == GATE_OFF || all(candidate == stored_color) {
        return 0.0;
    }
    let reference = lab(candidate);
    let stored = lab(stored_color);
    if code == GATE_LIGHTNESS {
        return abs(reference.x - stored.x);
    }
    return delta_e94(reference, stored);
}

// Eq. 7, then Alg. 2 with the candidate as second reservoir.
fn decide_sample(candidate: vec3f, candidate_w: f32, past: Past, params: WrsParams, draw: f32) -> Decision {
    var gate_value = 1.0;
    if candidate_w > 0.0 && past.w_sum > 0.0 {
        let d = difference(candidate, past.color, params.gate_code);
        gate_value = gate(d, params.gate_offset, params.inv_gate_divisor);
    }
    // The survival term uses the sum before the gate (eq. 7).
    var bias = 1.0;
    if params.bias_code == BIAS_EXPONENTIAL {
        bias = params.exponential_survival;
    } else if params.bias_code == BIAS_BERNOULLI {
        bias = bernoulli_survival(past.w_sum, candidate_w);
    }
    // Denormal products become 0, whether or not the device flushes denormals.
    let survival = weight(bias * gate_value);
    let kept = weight(past.w_sum * survival);
    let w_sum = kept + candidate_w;
    if params.sampler_code == SAMPLER_A_CHAO {
        return Decision(kept == 0.0 || draw * w_sum < candidate_w, w_sum, 0.0, gate_value, survival);
    }
    if params.sampler_code == SAMPLER_A_CHAO_MEAN {
        return Decision(kept == 0.0 || kept < candidate_w, w_sum, 0.0, gate_value, survival);
    }
    let old_key = a_es_decay(past.log_key, survival);
    let new_key = a_es_log_key(draw, candidate_w);
    let take = kept == 0.0 || new_key > old_key;
    return Decision(take, w_sum, select(old_key, new_key, take), gate_value, survival);
}

// Color that is stored and shown after `decide_sample`: the candidate or history's sample, or the mean of both by the
// probabilities of A-Chao.
fn combined(candidate: vec3f, candidate_w: f32, past_color: vec3f, decision: Decision, sampler_code: u32) -> vec3f {
    if sampler_code != SAMPLER_A_CHAO_MEAN || candidate_w == decision.w_sum {
        return select(past_color, candidate, decision.take);
    }
    return past_color + (candidate - past_color) * (candidate_w / decision.w_sum);
}
