//! One pixel of the weighted reservoir method (Cantory et al., MIG 2025): gate, forget, combine.

use super::sanitize::{self, MAX_HALF};
use super::{color, reservoir};
use glam::Vec3;

/// How a reservoir picks between its sample and the candidate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum SamplerCode {
    /// A-Chao: by the ratio of weight sums.
    AChao = 0,
    /// A-ES: by the larger key.
    AEs = 1,
}

/// How history is forgotten.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum BiasCode {
    /// Not at all.
    None = 0,
    /// A constant factor a frame.
    Exponential = 1,
    /// Bernoulli survival, eq. 5.
    Bernoulli = 2,
}

/// What the gate compares.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum GateCode {
    /// Nothing: always open.
    Off = 0,
    /// Delta E 94.
    DeltaE94 = 1,
    /// L\* alone.
    Lightness = 2,
}

/// Constants of a frame.
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
    /// Color difference below which the gate stays open, in Delta E.
    pub gate_offset: f32,
    /// One over the difference, above the offset, at which the gate is shut.
    pub inv_gate_divisor: f32,
}

/// The history side of a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Past {
    /// Its sample.
    pub color: Vec3,
    /// Its weight sum; 0: there is none.
    pub w_sum: f32,
    /// Log key of its sample (A-ES only).
    pub log_key: f32,
}

impl Past {
    /// None at all.
    pub const EMPTY: Self = Self { color: Vec3::ZERO, w_sum: 0.0, log_key: f32::MIN };
}

/// What was decided.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Decision {
    /// The candidate becomes the sample.
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

/// The history as far as it is trusted: all its weights times `trust` ([`sanitize::trust`]), before gate and bias. Nothing is left
/// of it (a sum of 0) at a trust of 0.
#[inline]
pub fn believe(past: Past, trust: f32, sampler: SamplerCode) -> Past {
    let share = sanitize::trust(trust);
    let log_key = match sampler {
        SamplerCode::AChao => past.log_key,
        SamplerCode::AEs => reservoir::a_es_decay(past.log_key, share),
    };
    Past { color: past.color, w_sum: sanitize::weight(past.w_sum * share), log_key }
}

/// A stored color under this frame's exposure: times `ratio`, kept within halves. `ratio` from 2^-40 to 2^40, beyond which
/// every half leaves the halves, so that no product leaves the normal floats.
#[inline]
pub fn expose(stored: Vec3, ratio: f32) -> Vec3 {
    (stored * ratio).clamp(Vec3::splat(-MAX_HALF), Vec3::splat(MAX_HALF))
}

/// `1 - |dL|` of eq. 7: 1 up to `offset`, 0 from `offset + 1 / inv_divisor` on. `difference` in Delta E.
#[inline]
pub fn gate(difference: f32, offset: f32, inv_divisor: f32) -> f32 {
    1.0 - ((difference - offset) * inv_divisor).clamp(0.0, 1.0)
}

/// Color difference that the gate sees. The candidate is the reference color.
#[inline]
pub fn difference(candidate: Vec3, sample: Vec3, code: GateCode) -> f32 {
    // Equal colors are the common case of a still view, and must give exactly 0.
    if code == GateCode::Off || candidate == sample {
        return 0.0;
    }
    let reference = color::lab(candidate);
    let stored = color::lab(sample);
    if code == GateCode::Lightness { (reference.x - stored.x).abs() } else { color::delta_e94(reference, stored) }
}

/// One frame of one pixel: eq. 7, then Alg. 2 with the candidate as second reservoir. `weight` is 0 for a candidate that must
/// not be used; such a one says nothing about change either, so the gate stays open.
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
    // Products may fall below the normal range, where some devices flush to zero: by the rule of weights, both do.
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
