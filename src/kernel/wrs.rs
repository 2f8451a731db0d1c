//! One pixel of the weighted reservoir method (Cantory et al., MIG 2025): gate, bias, combine.

use super::sanitize::{self, MAX_HALF};
use super::{color, reservoir};
use glam::Vec3;

/// Sampler: rule by which a reservoir chooses between its sample and the candidate. Code of `Sampler` in shaders.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum SamplerCode {
    /// A-Chao: by the ratio of weight sums.
    AChao = 0,
    /// A-ES: by the larger key.
    AEs = 1,
}

/// Bias: decay of the history's weight sum. Code of `Bias` in shaders.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum BiasCode {
    /// No decay.
    None = 0,
    /// Constant factor a frame.
    Exponential = 1,
    /// Bernoulli survival, eq. 5.
    Bernoulli = 2,
}

/// Color difference of the gate. Code of `GateMetric` in shaders.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum GateCode {
    /// No gate.
    Off = 0,
    /// Delta E 94.
    DeltaE94 = 1,
    /// L\* alone.
    Lightness = 2,
}

/// Parameters of wrs, from `Settings`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WrsParams {
    /// Sampler.
    pub sampler: SamplerCode,
    /// Bias.
    pub bias: BiasCode,
    /// Factor of the exponential bias, in \[0, 1\].
    pub exponential_survival: f32,
    /// Gate metric.
    pub gate: GateCode,
    /// Color difference up to which the gate value is 1, in Delta E.
    pub gate_offset: f32,
    /// Inverse of the difference, above the offset, at which the gate value is 0.
    pub inv_gate_divisor: f32,
}

/// Reservoir of a pixel's history.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Past {
    /// Color of the sample.
    pub color: Vec3,
    /// Weight sum; 0: there is no history.
    pub w_sum: f32,
    /// Log key of the sample (A-ES only).
    pub log_key: f32,
}

impl Past {
    /// No history.
    pub const EMPTY: Self = Self { color: Vec3::ZERO, w_sum: 0.0, log_key: f32::MIN };
}

/// Result of [`step`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Decision {
    /// Whether the candidate becomes the sample.
    pub take: bool,
    /// Weight sum after the frame.
    pub w_sum: f32,
    /// Log key of the sample after the frame (A-ES only).
    pub log_key: f32,
    /// Gate value in \[0, 1\]; 1: candidate and sample look alike.
    pub gate: f32,
    /// Share of the history's weight sum that survived, gate and bias together.
    pub survival: f32,
}

/// Reservoir with all weights multiplied by the history confidence `trust` ([`sanitize::trust`]), before gate and bias.
/// Empty (a weight sum of 0) for a trust of 0.
#[inline]
pub fn scale_by_trust(past: Past, trust: f32, sampler: SamplerCode) -> Past {
    let share = sanitize::trust(trust);
    let log_key = match sampler {
        SamplerCode::AChao => past.log_key,
        SamplerCode::AEs => reservoir::a_es_decay(past.log_key, share),
    };
    Past { color: past.color, w_sum: sanitize::weight(past.w_sum * share), log_key }
}

/// Stored color scaled to this frame's exposure: times `ratio`, clamped to halves. `ratio` from 2^-40 to 2^40: beyond
/// that every half over- or underflows, and within it no product over- or underflows as a float.
#[inline]
pub fn expose(stored: Vec3, ratio: f32) -> Vec3 {
    (stored * ratio).clamp(Vec3::splat(-MAX_HALF), Vec3::splat(MAX_HALF))
}

/// Gate value `1 - |dL|` of eq. 7: 1 up to `offset`, 0 from `offset + 1 / inv_divisor` on. `difference` in Delta E.
#[inline]
pub fn gate(difference: f32, offset: f32, inv_divisor: f32) -> f32 {
    1.0 - ((difference - offset) * inv_divisor).clamp(0.0, 1.0)
}

/// Color difference for the gate, in Delta E; the candidate is the reference color.
#[inline]
pub fn difference(candidate: Vec3, sample: Vec3, code: GateCode) -> f32 {
    // Equal colors are the common case in a still view, and must give exactly 0.
    if code == GateCode::Off || candidate == sample {
        return 0.0;
    }
    let reference = color::lab(candidate);
    let stored = color::lab(sample);
    if code == GateCode::Lightness { (reference.x - stored.x).abs() } else { color::delta_e94(reference, stored) }
}

/// One frame of one pixel: gate (eq. 7), bias, then Alg. 2 with the candidate as second reservoir. A `weight` of 0
/// marks an unusable candidate; it says nothing about a change of color either, so the gate value is 1.
#[inline]
pub fn step(candidate: Vec3, weight: f32, past: Past, params: &WrsParams, draw: f32) -> Decision {
    let mut gate_value = 1.0;
    if weight > 0.0 && past.w_sum > 0.0 {
        let d = difference(candidate, past.color, params.gate);
        gate_value = gate(d, params.gate_offset, params.inv_gate_divisor);
    }
    // The survival term uses the sum before the gate (eq. 7).
    let bias = match params.bias {
        BiasCode::None => 1.0,
        BiasCode::Exponential => params.exponential_survival,
        BiasCode::Bernoulli => reservoir::bernoulli_survival(past.w_sum, weight),
    };
    // Products may be denormal, which some devices flush to zero: sanitizing as weights makes all of them 0.
    let survival = sanitize::weight(bias * gate_value);
    let kept = sanitize::weight(past.w_sum * survival);
    let w_sum = kept + weight;
    let (take, log_key) = match params.sampler {
        SamplerCode::AChao => (kept == 0.0 || draw * w_sum < weight, 0.0),
        SamplerCode::AEs => {
            let old = reservoir::a_es_decay(past.log_key, survival);
            let new = reservoir::a_es_log_key(draw, weight);
            let take = kept == 0.0 || new > old;
            (take, if take { new } else { old })
        }
    };
    Decision { take, w_sum, log_key, gate: gate_value, survival }
}
