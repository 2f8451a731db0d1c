//! Weighted reservoirs of one sample: update, combine, and the biases that let history decay.
//!
//! Sources: Cantory et al., "Enhancing Foveated Rendering with Weighted Reservoir Sampling", MIG 2025 (the paper); Chao
//! 1982; Efraimidis and Spirakis 2006.

use super::{approx, sanitize};

/// State of a reservoir of size one, besides its sample.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Reservoir {
    /// Sum of the weights of all candidates seen, >= 0. Zero: empty.
    pub w_sum: f32,
    /// Number of candidates seen; saturates.
    pub count: u32,
}

/// A-Chao update (the paper's Alg. 1): adds a candidate of weight `w` and returns whether it becomes the sample. `draw`
/// in \[0, 1).
///
/// A candidate of weight 0 or NaN is never taken.
#[inline]
pub fn update(reservoir: &mut Reservoir, w: f32, draw: f32) -> bool {
    let w = sanitize::weight(w);
    reservoir.w_sum += w;
    reservoir.count = reservoir.count.saturating_add(1);
    draw * reservoir.w_sum < w
}

/// Combines two reservoirs (the paper's Alg. 2): the reservoir of both streams, and whether the second's sample is
/// kept.
///
/// The comparison is strict on the second weight: with the published `<=` on the first, a draw of 0 would keep the
/// sample of an empty first reservoir. Two empty reservoirs keep the second's sample, the newer one.
#[inline]
pub fn combine(first: Reservoir, second: Reservoir, draw: f32) -> (Reservoir, bool) {
    let w1 = sanitize::weight(first.w_sum);
    let w2 = sanitize::weight(second.w_sum);
    let w_sum = w1 + w2;
    let merged = Reservoir { w_sum, count: first.count.saturating_add(second.count) };
    (merged, w1 == 0.0 || draw * w_sum < w2)
}

/// Bernoulli survival (eq. 5): factor on the history's weight sum before a candidate reservoir of sum `w_new` is
/// combined with it, `1 - w_new / (w_sum + w_new)`, computed without cancellation. In \[0, 1\]; 1 for two empty
/// reservoirs.
#[inline]
pub fn bernoulli_survival(w_sum: f32, w_new: f32) -> f32 {
    let total = w_sum + w_new;
    if total > 0.0 { w_sum / total } else { 1.0 }
}

/// Exponential bias, for comparison: factor on the history's weight sum after one frame, `exp(-lambda)`.
#[inline]
pub fn exponential_survival(lambda_per_frame: f32) -> f32 {
    approx::exp_approx(-lambda_per_frame)
}

/// Logarithm of the A-ES key of a sample of weight `w`: `ln(draw) / w`, at most 0; the largest key wins. `f32::MIN` for
/// a weight of 0.
///
/// A draw of exactly 0 counts as half a step of the generator's grid; its key would otherwise be minus infinity.
#[inline]
pub fn a_es_log_key(draw: f32, w: f32) -> f32 {
    let w = sanitize::weight(w);
    if w == 0.0 {
        return f32::MIN;
    }
    (approx::ln_approx(draw.max(1.0 / 33_554_432.0)) / w).max(f32::MIN)
}

/// Log key of history after all its weights were multiplied by `survival` in \[0, 1\]: `key / survival`. `f32::MIN` for
/// invalid keys (NaN, infinite or above 0), which no candidate's key could ever exceed.
#[inline]
pub fn a_es_decay(log_key: f32, survival: f32) -> f32 {
    let is_key = matches!(log_key.to_bits(), 0 | 0x8000_0000..=0xff7f_ffff);
    if survival <= 0.0 || !is_key {
        return f32::MIN;
    }
    (log_key / survival).max(f32::MIN)
}
