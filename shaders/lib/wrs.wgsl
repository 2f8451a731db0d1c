//#use color
//#use reservoir
//#use sanitize
// Twin of src/kernel/wrs.rs: gate, bias, combine.

// wrs::SamplerCode
const SAMPLER_A_CHAO: u32 = 0u;
const SAMPLER_A_ES: u32 = 1u;

// wrs::BiasCode
const BIAS_NONE: u32 = 0u;
const BIAS_EXPONENTIAL: u32 = 1u;
const BIAS_BERNOULLI: u32 = 2u;

// wrs::GateCode
const GATE_OFF: u32 = 0u;
const GATE_DELTA_E94: u32 = 1u;
const GATE_LIGHTNESS: u32 = 2u;

struct WrsParams {
    sampler_code: u32,
    bias_code: u32,
    exponential_survival: f32,
    gate_code: u32,
    gate_offset: f32,
    inv_gate_divisor: f32,
}

struct Past {
    color: vec3<f32>,
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

// wrs::scale_by_trust
fn scale_by_trust(past: Past, history_trust: f32, sampler_code: u32) -> Past {
    let share = trust(history_trust);
    var log_key = past.log_key;
    if sampler_code == SAMPLER_A_ES {
        log_key = a_es_decay(past.log_key, share);
    }
    return Past(past.color, weight(past.w_sum * share), log_key);
}

// wrs::expose
fn expose(stored_color: vec3<f32>, ratio: f32) -> vec3<f32> {
    return clamp(stored_color * ratio, vec3<f32>(-MAX_HALF), vec3<f32>(MAX_HALF));
}

// wrs::gate (eq. 7): 1 - |dL|
fn gate(difference: f32, offset: f32, inv_divisor: f32) -> f32 {
    return 1.0 - clamp((difference - offset) * inv_divisor, 0.0, 1.0);
}

// wrs::difference; exactly 0 for equal colors.
fn difference(candidate: vec3<f32>, stored_color: vec3<f32>, code: u32) -> f32 {
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

// wrs::step: eq. 7, then Alg. 2 with the candidate as second reservoir.
fn step(candidate: vec3<f32>, candidate_w: f32, past: Past, params: WrsParams, draw: f32) -> Decision {
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
    let old_key = a_es_decay(past.log_key, survival);
    let new_key = a_es_log_key(draw, candidate_w);
    let take = kept == 0.0 || new_key > old_key;
    return Decision(take, w_sum, select(old_key, new_key, take), gate_value, survival);
}
