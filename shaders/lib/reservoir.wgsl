//#use approx
//#use sanitize
// Twin of src/kernel/reservoir.rs (equations and algorithms: Cantory et al., MIG 2025).

// f32::MIN
const LOWEST: f32 = -0x1.fffffep127;

struct Reservoir {
    w_sum: f32,
    count: u32,
}

struct Combined {
    reservoir: Reservoir,
    keep_second: bool,
}

// Alg. 1.
fn update(reservoir: ptr<function, Reservoir>, candidate_weight: f32, draw: f32) -> bool {
    let w = weight(candidate_weight);
    let w_sum = (*reservoir).w_sum + w;
    *reservoir = Reservoir(w_sum, saturating_add((*reservoir).count, 1u));
    return draw * w_sum < w;
}

// Alg. 2, with a strict comparison for the second.
fn combine(first: Reservoir, second: Reservoir, draw: f32) -> Combined {
    let w1 = weight(first.w_sum);
    let w2 = weight(second.w_sum);
    let w_sum = w1 + w2;
    let merged = Reservoir(w_sum, saturating_add(first.count, second.count));
    return Combined(merged, w1 == 0.0 || draw * w_sum < w2);
}

// 1 - w_new / (w_sum + w_new) (eq. 5)
fn bernoulli_survival(w_sum: f32, w_new: f32) -> f32 {
    let total = w_sum + w_new;
    if total > 0.0 {
        return w_sum / total;
    }
    return 1.0;
}

// exp(-lambda)
fn exponential_survival(lambda_per_frame: f32) -> f32 {
    return exp_approx(-lambda_per_frame);
}

// ln(draw) / w
fn a_es_log_key(draw: f32, sample_weight: f32) -> f32 {
    let w = weight(sample_weight);
    if w == 0.0 {
        return LOWEST;
    }
    return max(ln_approx(max(draw, 1.0 / 33554432.0)) / w, LOWEST);
}

// key / survival
fn a_es_decay(log_key: f32, survival: f32) -> f32 {
    let key_bits = bitcast<u32>(log_key);
    let is_key = key_bits == 0u || (key_bits >= 0x80000000u && key_bits <= 0xff7fffffu);
    if survival <= 0.0 || !is_key {
        return LOWEST;
    }
    return max(log_key / survival, LOWEST);
}

// u32::saturating_add
fn saturating_add(a: u32, b: u32) -> u32 {
    return a + min(b, 0xffffffffu - a);
}
