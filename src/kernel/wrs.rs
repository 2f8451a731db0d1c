//! One pixel of the weighted reservoir method (Cantory et al., MIG 2025): gate, bias, combine.

use super::sanitize::{self, MAX_HALF};
use super::{approx, color, lab, reservoir};
use glam::Vec3;

/// Sampler: rule by which a reservoir chooses between its sample and the candidate. Code of `Sampler` in shaders.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum SamplerCode {
    /// A-Chao: by the ratio of weight sums.
    AChao = 0,
    /// A-ES: by the larger key.
    AEs = 1,
    /// The expectation of A-Chao: keeps the mean of both by their probabilities.
    AChaoMean = 2,
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

/// Code that matches no candidate's level of detail: for interpolated candidates and for reservoirs without reference.
pub const NO_LEVEL: u32 = 63;

/// Exponent, as in the bits of a float, below which all channels of a packed color share one.
const LEAST_EXPONENT: u32 = 127 - 15;
/// Mantissa bits of a packed channel.
const CHANNEL_BITS: u32 = 7;

/// Largest difference that interpolation of history may add to that of the nearest reservoir from the candidate, in
/// [`luma_root`]: half of that from black to white. Smaller ones are edges.
const FAR_FROM_CANDIDATE: f32 = 0.5;

/// Reference of the gate: the first candidate of the present level of detail since the sample was taken.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reference {
    /// Its color, at least 0.
    pub color: Vec3,
    /// Code of its level of detail, or [`NO_LEVEL`].
    pub level: u32,
}

impl Reference {
    /// No reference.
    pub const NONE: Self = Self { color: Vec3::ZERO, level: NO_LEVEL };
}

/// Code of a level of detail from 0 to 8: the nearest quarter.
#[inline]
pub fn level_code(lod: f32) -> u32 {
    (lod * 4.0 + 0.5) as u32
}

/// Packs a reference into a word: 7 bits a channel, 5 of their common exponent, 6 of the level. Negative channels
/// become 0. The error of a channel is at most 1/127 of the largest one, and packing an unpacked reference gives the
/// same word.
#[inline]
pub fn pack_reference(r: Reference) -> u32 {
    let c = r.color.clamp(Vec3::ZERO, Vec3::splat(MAX_HALF));
    // Half a step is added first, because a mantissa that would be rounded up to 128 needs the next exponent.
    let largest = c.x.max(c.y).max(c.z).to_bits() + (1 << (23 - CHANNEL_BITS));
    let exponent = (largest >> 23).max(LEAST_EXPONENT);
    let scale = f32::from_bits((2 * 127 + CHANNEL_BITS - 1 - exponent) << 23);
    let (x, y, z) = ((c.x * scale + 0.5) as u32, (c.y * scale + 0.5) as u32, (c.z * scale + 0.5) as u32);
    x | y << 7 | z << 14 | (exponent - LEAST_EXPONENT) << 21 | r.level << 26
}

/// Unpacks a reference. Finite for any word.
#[inline]
pub fn unpack_reference(word: u32) -> Reference {
    let exponent = ((word >> 21) & 31) + LEAST_EXPONENT;
    let scale = f32::from_bits((exponent + 1 - CHANNEL_BITS) << 23);
    let channel = |shift: u32| ((word >> shift) & 127) as f32 * scale;
    Reference { color: Vec3::new(channel(0), channel(7), channel(14)), level: word >> 26 }
}

/// Color that the gate compares with a candidate of level `level`: the reference if it has the same level. Otherwise it
/// is the candidate itself, because the two levels do not show whether anything changed.
#[inline]
pub fn compared(candidate: Vec3, level: u32, reference: Reference) -> Vec3 {
    if level != NO_LEVEL && reference.level == level { reference.color } else { candidate }
}

/// Reference after a frame with a candidate of level `level`. `take`: whether the candidate became the sample.
#[inline]
pub fn next_reference(candidate: Vec3, level: u32, take: bool, reference: Reference) -> Reference {
    let is_other_level = level != NO_LEVEL && reference.level != level;
    if take || is_other_level { Reference { color: candidate, level } } else { reference }
}

/// Sharpened weight of a candidate: its weight by eccentricity `weight` (eq. 4), raised to a whole exponent of at least
/// 1 by multiplication.
#[inline]
pub fn sharpen(weight: f32, exponent: u32) -> f32 {
    let mut w = weight;
    for _ in 1..exponent {
        w *= weight;
    }
    w
}

/// Least weight of a usable candidate: 2^-100. A weight below 2^-126 would become 0, which marks an unusable candidate.
const LEAST_CANDIDATE_W: f32 = f32::from_bits((127 - 100) << 23);

/// Weight of a candidate at level of detail `lod` (0 to 8.9): `weight` times the number of samples a pixel, `4^-lod`,
/// to the power `exponent` (at most 4).
#[inline]
pub fn at_rate(weight: f32, lod: f32, exponent: u32) -> f32 {
    (weight * approx::exp2_approx(lod * (-2.0 * exponent as f32))).max(LEAST_CANDIDATE_W)
}

/// Reservoir of a pixel's history.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Past {
    /// Color of the sample.
    pub color: Vec3,
    /// Weight sum; 0 without history.
    pub w_sum: f32,
    /// Log key of the sample (A-ES only).
    pub log_key: f32,
}

impl Past {
    /// No history.
    pub const EMPTY: Self = Self { color: Vec3::ZERO, w_sum: 0.0, log_key: f32::MIN };
}

/// Result of [`decide_sample`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Decision {
    /// Whether the candidate becomes the sample; for means, whether it has more than half of the weight.
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
        SamplerCode::AChao | SamplerCode::AChaoMean => past.log_key,
        SamplerCode::AEs => reservoir::a_es_decay(past.log_key, share),
    };
    Past { color: past.color, w_sum: sanitize::weight(past.w_sum * share), log_key }
}

/// Square root of a color's luma; 0 for negative ones.
#[inline]
pub fn luma_root(c: Vec3) -> f32 {
    color::luma(c).max(0.0).sqrt()
}

/// History's mean at a position between reservoirs: `resampled`, or the color of the `nearest` reservoir where the
/// interpolation moves it away from the candidate by more than `FAR_FROM_CANDIDATE`. The gate judges the nearest
/// reservoir alone. A firefly in a reservoir beside it would otherwise spread past the gate.
#[inline]
pub fn unspread(candidate: Vec3, nearest: Vec3, resampled: Vec3) -> Vec3 {
    let root = luma_root(candidate);
    let far = (root - luma_root(nearest)).abs() + FAR_FROM_CANDIDATE;
    if (root - luma_root(resampled)).abs() > far { nearest } else { resampled }
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
    let reference = lab::lab(candidate);
    let stored = lab::lab(sample);
    if code == GateCode::Lightness { (reference.x - stored.x).abs() } else { lab::delta_e94(reference, stored) }
}

/// Color that is stored and shown after [`decide_sample`]: the candidate or history's sample, or the mean of both by
/// the probabilities of A-Chao. Equal colors, and a candidate with all the weight, stay unchanged bit for bit.
#[inline]
pub fn combined(candidate: Vec3, weight: f32, past: Vec3, decision: &Decision, sampler: SamplerCode) -> Vec3 {
    if sampler != SamplerCode::AChaoMean || weight == decision.w_sum {
        return if decision.take { candidate } else { past };
    }
    past + (candidate - past) * (weight / decision.w_sum)
}

/// One frame of one pixel: gate (eq. 7), bias, then Alg. 2 with the candidate as second reservoir. The gate compares
/// the candidate with `past.color`: the sample, or the result of [`compared`]. A `weight` of 0 marks an unusable
/// candidate. Such a candidate does not show whether the color changed, so the gate value is 1.
#[inline]
pub fn decide_sample(candidate: Vec3, weight: f32, past: Past, params: &WrsParams, draw: f32) -> Decision {
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
        SamplerCode::AChaoMean => (kept == 0.0 || kept < weight, 0.0),
        SamplerCode::AEs => {
            let old = reservoir::a_es_decay(past.log_key, survival);
            let new = reservoir::a_es_log_key(draw, weight);
            let take = kept == 0.0 || new > old;
            (take, if take { new } else { old })
        }
    };
    Decision { take, w_sum, log_key, gate: gate_value, survival }
}
