//! Reconstruction of planned frames: comparison of each new sample with history, estimation of changes of light, and
//! colors of the pixels between samples.
//!
//! Three steps. At each sample, history is compared with the sample **at the sample's own pixel at full rate**
//! ([`Observation`]): it needs no low-pass and no match of scales. Then the gain of a change of light, and the fit of
//! history after it, are estimated from each shaded quad and the eight around it ([`relight`]). Then each pixel
//! interpolates gain and fit, and blends its own history with the interpolated samples ([`reconstruct`]).

use super::approx::{self, smooth_step};
use super::color::{DARK, luma, root_difference};
use super::lod::COARSER_WIDTH;
use super::noise::{Noise, history_share, noise_after, noise_confidence, noise_visibility};
use super::pack::{disparity_code, half_bits, half_value};
use super::stored_sample::{StoredSample, pack_color, unpack_color};
use glam::{Vec2, Vec3};
use std::f32::consts::LOG2_E;

/// Relative difference of disparity within which neighbouring samples share an estimate of light.
pub const LIGHT_RELATIVE: f32 = 0.1;
/// Expected difference between a sample and history that has not moved. The precision of storage causes it. In units of
/// [`root_difference`].
const STILL_ERROR: f32 = 0.3;
/// Expected difference between a sample and history that has moved.
pub const MOVED_ERROR: f32 = 0.6;
/// Share of history's local contrast (the difference of the smallest and the largest color around) that is added to the
/// expected difference where history moved or is coarse. It covers errors of interpolation and of inexact places.
pub const CONTRAST_ERROR: f32 = 0.375;
/// Added to the expected error where the gate compares single samples.
const GATE_ERROR: f32 = 0.7;
/// Standard errors of a mean difference at which relighting starts; it is complete at twice as many.
const RELIGHT_ERRORS: f32 = 2.5;
/// Deviation of the samples in a pixel that textures may have without moire.
const PLAIN_DEVIATION: f32 = 8.0;
/// Expected errors within which neighbours agree with a sample's own gain.
const AGREE_ERRORS: f32 = 4.0;
/// Added to the expected errors when a neighbour is compared with a sample's own gain, in units of [`root_difference`].
const AGREE_ERROR: f32 = 0.8;
/// Gate: mean difference at which the fit starts to fall, and width over which it falls to 0, in expected errors.
const FIT_ERRORS: [f32; 2] = [2.0, 4.0];
/// Share of the confident samples around that agrees with a gain, from which on it is used, and the slope from there to
/// the complete gain. A square of four of nine samples is 0.56, a straight edge 0.75.
const AGREED: [f32; 2] = [0.6, 6.0];
/// Share of the other samples around a sample that must contradict history, so that it is replaced where they do not
/// agree with the sample, and width over which it is.
const AGAINST: [f32; 2] = [0.5, 0.25];
/// Share of the errors without a gain that a gain of quads must leave at most, or it is not used.
const RELIT_ERRORS: f32 = 0.8;
/// The same for the gain of a block.
const BLOCK_ERRORS: f32 = 0.7;
/// Edge in quads of the blocks of a [`block_gain`].
pub const BLOCK_QUADS: u32 = 16;
/// Share of the samples of a block, by confidence, to which its gain must bring history nearer.
const BLOCK_MAJORITY: f32 = 0.6;
/// Least number of samples of a block with a gain.
const BLOCK_LEAST: f32 = 24.0;
/// Part of the variance of a sample's error that the samples of a block have in common, as the jitter is the same.
const BLOCK_SHARED: f32 = 0.0625;
/// Largest deviation of an observation, and steps in which it is stored.
const MOST_DEVIATION: f32 = 63.75;
const DEVIATION_STEPS: f32 = 4.0;
/// Smallest and largest gain.
const SAMPLE_GAIN: [f32; 2] = [0.2, 5.0];
/// Levels of detail that history loses when light doubles: history that has moved, and single samples that have not.
/// Means that have not moved lose samples instead.
const LOD_LOSS_PER_STOP: [f32; 2] = [4.0, 1.0];
/// Levels of detail by which history must be finer than the candidate to replace it fully.
const FINER_WIDTH: f32 = 0.25;
/// Share of the samples' range by which a gain may exceed their largest value.
const OVERSHOOT: f32 = 0.25;
/// Factor on `Smr::accumulate`, the share of equally fine history: samples at their own pixels need less averaging.
const ACCUMULATE: f32 = 0.5;
/// Least share of history at which its nearest sample is stored again, instead of the shown color.
const KEEP_SHARE: f32 = 0.9;
/// Noisy samples: standard errors of a mean difference at which the fit starts to fall; it is 0 at twice as many.
const MEAN_ERRORS: f32 = 3.0;
/// Noisy samples: limit on the samples of a history coarser than the candidate, in frames. A larger limit reduces
/// noise, and keeps blurred history for longer.
const BLURRED_FRAMES: f32 = 8.0;
/// Noisy samples: least share of history at which the mean is stored in the place of its nearest sample.
const STAY_SHARE: f32 = 0.5;

/// Comparison of a sample with history at its pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Observation {
    /// The sample's color.
    pub sampled: Vec3,
    /// History's color at the sample's pixel.
    pub history: Vec3,
    /// Expected difference between sample and history if nothing changed, in units of [`root_difference`]. Negative
    /// without history or without a usable sample.
    pub error: f32,
    /// Confidence in the difference, in \[0, 1\]: lower for coarse history, which differs from a point sample anyway.
    pub confidence: f32,
    /// Deviation of the samples in a still mean, in the same units.
    pub deviation: f32,
}

/// No comparison.
#[inline(always)]
pub fn no_observation() -> Observation {
    Observation { sampled: Vec3::ZERO, history: Vec3::ZERO, error: -1.0, confidence: 0.0, deviation: 0.0 }
}

/// Observation in two words: history's color; expected error as a half, confidence and deviation.
#[inline(always)]
pub fn pack_observation(o: Observation) -> [u32; 2] {
    [pack_color(o.history), half_bits(o.error) | pack_known(o.confidence, o.deviation) << 16]
}

/// Inverse of [`pack_observation`], with the sample's color.
#[inline(always)]
pub fn unpack_observation(words: [u32; 2], sampled: Vec3) -> Observation {
    let known = words[1] >> 16;
    Observation {
        sampled,
        history: unpack_color(words[0]),
        error: half_value(words[1]),
        confidence: known_confidence(known),
        deviation: known_deviation(known),
    }
}

/// Whether packed words are a comparison.
#[inline(always)]
pub fn is_observed(words: [u32; 2]) -> bool {
    half_value(words[1]) >= 0.0
}

/// Confidence and deviation of an observation, in sixteen bits.
#[inline]
pub fn pack_known(confidence: f32, deviation: f32) -> u32 {
    (confidence * 255.0 + 0.5) as u32 | ((deviation.min(MOST_DEVIATION) * DEVIATION_STEPS + 0.5) as u32) << 8
}

/// Confidence of [`pack_known`].
#[inline]
pub fn known_confidence(word: u32) -> f32 {
    (word & 255) as f32 * (1.0 / 255.0)
}

/// Deviation of [`pack_known`].
#[inline]
pub fn known_deviation(word: u32) -> f32 {
    (word >> 8 & 255) as f32 * (1.0 / DEVIATION_STEPS)
}

/// Expected difference between a sample and history of level of detail `lod` with local contrast `contrast`.
#[inline]
pub fn expected_error(lod: f32, contrast: f32, moved: bool) -> f32 {
    let coarse = lod.clamp(0.0, 1.0);
    let by_motion = if moved { CONTRAST_ERROR } else { 0.0 };
    (if moved { MOVED_ERROR } else { STILL_ERROR }) + contrast * (by_motion + CONTRAST_ERROR * coarse)
}

/// Confidence in a difference from history at level of detail `lod`, in \[0, 1\].
#[inline]
pub fn lod_confidence(lod: f32) -> f32 {
    1.0 - lod.clamp(0.0, 1.0)
}

/// As [`lod_confidence`], for noisy samples at a luma. Where history's noise is visible, noise dominates the expected
/// difference, and coarse history counts as much as fine history.
#[inline]
pub fn noisy_lod_confidence(lod: f32, past: Noise, luma: f32) -> f32 {
    lod_confidence(lod).max(noise_visibility(past, luma))
}

/// Gain for one channel, limited.
#[inline]
pub fn ratio(observed: f32, predicted: f32) -> f32 {
    ((observed + DARK) / (predicted + DARK)).clamp(SAMPLE_GAIN[0], SAMPLE_GAIN[1])
}

/// Per-channel ratios of two colors, limited.
#[inline]
pub fn ratios(observed: Vec3, predicted: Vec3) -> Vec3 {
    Vec3::new(ratio(observed.x, predicted.x), ratio(observed.y, predicted.y), ratio(observed.z, predicted.z))
}

/// Weight of a neighbour's observation in a sample's estimate: smaller if it contradicts the sample's own gain, as at
/// the edge of a shadow. `spatial`: weight by position.
#[inline]
pub fn agreement(own: Observation, other: Observation, spatial: f32) -> f32 {
    let difference = root_difference(other.sampled, ratios(own.sampled, own.history) * other.history);
    let errors = difference.min(1e6) / (AGREE_ERRORS * (own.error + other.error) + AGREE_ERROR);
    (spatial * other.confidence) / (1.0 + errors * errors)
}

/// Sums of the observations at a sample and its neighbours.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ObservedAround {
    /// Sampled colors, times weights.
    pub sampled: Vec3,
    /// Colors of history, times weights.
    pub history: Vec3,
    /// Expected errors, times weights.
    pub error: f32,
    /// Deviations, times weights.
    pub deviation: f32,
    /// Weights.
    pub weight: f32,
    /// Squared weights.
    pub squared: f32,
    /// Weights by position alone.
    pub spatial: f32,
    /// Weights by position and confidence.
    pub known: f32,
}

/// Sums over no observation.
#[inline(always)]
pub fn none_around() -> ObservedAround {
    ObservedAround::default()
}

/// Adds an observation of `weight`.
#[inline]
pub fn add_observation(a: ObservedAround, o: Observation, weight: f32, spatial: f32) -> ObservedAround {
    ObservedAround {
        sampled: a.sampled + o.sampled * weight,
        history: a.history + o.history * weight,
        error: a.error + o.error * weight,
        deviation: a.deviation + o.deviation * weight,
        weight: a.weight + weight,
        squared: a.squared + weight * weight,
        spatial: a.spatial + spatial,
        known: a.known + spatial * o.confidence,
    }
}

/// Sums over the observations of both.
#[inline(always)]
pub fn add_around(a: ObservedAround, b: ObservedAround) -> ObservedAround {
    ObservedAround {
        sampled: a.sampled + b.sampled,
        history: a.history + b.history,
        error: a.error + b.error,
        deviation: a.deviation + b.deviation,
        weight: a.weight + b.weight,
        squared: a.squared + b.squared,
        spatial: a.spatial + b.spatial,
        known: a.known + b.known,
    }
}

/// Mean of the observations at the pixels of a quad, from their sums with weights of 1, and from the sum of their
/// confidences; none without any.
#[inline(always)]
pub fn mean_observation(a: ObservedAround, confidence: f32) -> Observation {
    let inverse = 1.0 / a.weight.max(1.0);
    Observation {
        sampled: a.sampled * inverse,
        history: a.history * inverse,
        error: if a.weight == 0.0 { -1.0 } else { a.error * inverse },
        confidence: confidence * inverse,
        deviation: a.deviation * inverse,
    }
}

/// Weight by position of a quad around another one. `distance2` and `least`: squared distances in quads, its own and
/// the smallest of those around.
#[inline(always)]
pub fn spatial_weight(distance2: f32, least: f32) -> f32 {
    1.0 / (1.0 + distance2 / least)
}

/// Weight of an observation around a quad with the observation `own`, from its weight by position.
#[inline(always)]
pub fn neighbour_weight(own: Observation, other: Observation, spatial: f32) -> f32 {
    if own.error < 0.0 { spatial * other.confidence } else { agreement(own, other, spatial) }
}

/// Expected difference of one sample from history around it.
#[inline]
pub fn mean_error(a: ObservedAround) -> f32 {
    a.error * (1.0 / a.weight)
}

/// Degree to which the samples around agree on a gain, in \[0, 1\]. All pixels around a sample are multiplied by its
/// gain. If the confident samples around contradict it, as beside a small lamp of one frame or beside what it left,
/// that gain spreads marks. Where no other sample is confident, a single one is enough.
#[inline]
pub fn agreed(a: ObservedAround) -> f32 {
    ((a.weight - a.known * AGREED[0]) * (AGREED[1] / a.known.max(1e-6))).clamp(0.0, 1.0)
}

/// Degree to which the jitter cannot explain a mean difference, in \[0, 1\]. The jitter moves all samples of a frame
/// alike, so that the errors of moire are not independent. It shows in the deviation of the samples in still means.
#[inline]
pub fn not_jitter(a: ObservedAround, difference: f32) -> f32 {
    let beyond = (a.deviation - PLAIN_DEVIATION * a.weight) * (1.0 / a.weight);
    if beyond > 0.0 { smooth_step(FIT_ERRORS[0], FIT_ERRORS[1], difference / beyond.max(1e-3)) } else { 1.0 }
}

/// Gain of the light around a sample: the ratio of the means of samples and of history at the same pixels, blended to 1
/// where chance explains the difference of the means, or where other samples contradict it ([`agreed`]). `error`:
/// expected difference of one sample. `coherent`: whether the errors of samples may be alike.
#[inline]
pub fn relight(a: ObservedAround, error: f32) -> Vec3 {
    if a.weight < 1e-6 {
        return Vec3::ONE;
    }
    let inverse = 1.0 / a.weight;
    let (sampled, history) = (a.sampled * inverse, a.history * inverse);
    let difference = root_difference(sampled, history);
    // The standard error of a weighted mean.
    let from = (error * (a.squared.sqrt() * inverse)) * RELIGHT_ERRORS;
    let changed = (smooth_step(from, from, difference) * not_jitter(a, difference)) * agreed(a);
    // A share of 1 gives the ratio bit for bit.
    ratios(sampled, history) * changed + Vec3::splat(1.0 - changed)
}

/// Weight of an observation in the sums for [`block_gain`]: its confidence, divided by its largest channel above white,
/// so that a lamp or a firefly does not stand for the block.
#[inline(always)]
pub fn block_weight(o: Observation) -> f32 {
    o.confidence / o.sampled.max_element().max(o.history.max_element()).max(1.0)
}

/// Gain of the light in a block of [`BLOCK_QUADS`] quads along each axis, from all comparisons in it. On contrasted
/// surfaces the few samples around a quad do not tell a change of light from the errors of sampling; those of a block
/// do. Errors that its samples have alike (`BLOCK_SHARED`) do not fall with their number.
#[inline]
pub fn block_gain(a: ObservedAround, error: f32) -> Vec3 {
    relight(ObservedAround { squared: a.squared + BLOCK_SHARED * (a.weight * a.weight), ..a }, error)
}

/// Vote of a sample on the gain of its block, for [`has_majority`]: its confidence if the gain brings history nearer to
/// the sample, and 1.
#[inline]
pub fn block_vote(o: Observation, gain: Vec3) -> Vec2 {
    let is_nearer = errors_left(o, gain) < errors_left(o, Vec3::ONE);
    Vec2::new(if is_nearer { o.confidence } else { 0.0 }, 1.0)
}

/// Whether most samples of a block are for its gain, by the sum of their [`block_vote`]s, and whether there are enough.
/// A lamp that changes beside a wall that does not has no majority, unless the few samples of a block all hit lamps.
#[inline(always)]
pub fn has_majority(votes: Vec2) -> bool {
    votes.y >= BLOCK_LEAST && votes.x >= votes.y * BLOCK_MAJORITY
}

/// Difference between a sample and history after a gain, in expected errors.
#[inline]
pub fn errors_left(o: Observation, gain: Vec3) -> f32 {
    root_difference(o.sampled, gain * o.history) / (o.error + GATE_ERROR)
}

/// Whether a gain is used: whether it leaves less than the errors `without` it. Both are sums of [`errors_left`].
/// `is_of_block`: a [`block_gain`] must leave less than the gain around a quad.
#[inline(always)]
pub fn gain_helps(left: f32, without: f32, is_of_block: bool) -> bool {
    left <= without * if is_of_block { BLOCK_ERRORS } else { RELIT_ERRORS }
}

/// Degree to which history after a gain fits at a sample's own pixel, in \[0, 1\]. It limits the fit of the
/// neighbourhood: a sample that hit a sparkle, for example, contradicts history even where its neighbours agree.
#[inline]
pub fn center_fit(own: Observation, gain: Vec3) -> f32 {
    fit(errors_left(own, gain), own.confidence)
}

/// Degree to which history fits the samples, in \[0, 1\], from the mean of [`errors_left`]. `confidence`: confidence in
/// that mean, in \[0, 1\]; with a confidence of 0, history fits.
#[inline]
pub fn fit(errors: f32, confidence: f32) -> f32 {
    1.0 - confidence * smooth_step(FIT_ERRORS[0], FIT_ERRORS[1], errors)
}

/// Vote of another sample on whether history fits, for [`fit_by_votes`]: its weight if it contradicts history, and its
/// weight. `errors`: of [`errors_left`] without a gain.
#[inline]
pub fn vote(o: Observation, errors: f32, spatial: f32) -> Vec2 {
    let weight = spatial * o.confidence;
    Vec2::new(smooth_step(FIT_ERRORS[0], FIT_ERRORS[1], errors) * weight, weight)
}

/// Fit of history around a sample by the majority of the other samples, in \[0, 1\]. `votes`: sum of their [`vote`]s.
/// `own`: fit at the sample alone without a gain, 0 if it was not compared: where history fits there, the others say
/// nothing about it.
#[inline]
pub fn fit_by_votes(a: ObservedAround, votes: Vec2, own: f32) -> f32 {
    let against = smooth_step(AGAINST[0], AGAINST[1], votes.x / votes.y.max(1e-6));
    (1.0 - (a.known / a.spatial).min(1.0) * against).max(own)
}

/// Degree to which history fits around a sample, in \[0, 1\]. `left`: [`errors_left`] with the gain, times weights.
/// Where the samples around contradict the sample ([`agreed`]), the fit is `by_others`: a pixel that was a sparkle's is
/// replaced alone ([`center_fit`]), and the history around it stays.
#[inline]
pub fn fit_around(a: ObservedAround, left: f32, by_others: f32) -> f32 {
    let by_own = fit(left / a.weight, (a.weight / a.spatial).min(1.0));
    let share = agreed(a);
    by_own * share + by_others * (1.0 - share)
}

/// As [`fit`], for noisy samples, from the difference of the means of samples and of history. Samples together
/// distinguish smaller changes from noise than a single sample.
#[inline]
pub fn mean_fit(a: ObservedAround, confidence: f32) -> f32 {
    let inverse = 1.0 / a.weight;
    let from = ((a.error * inverse) * (a.squared.sqrt() * inverse)) * MEAN_ERRORS;
    1.0 - confidence * smooth_step(from, from, root_difference(a.sampled * inverse, a.history * inverse))
}

/// As [`fit_around`], for noisy samples.
#[inline(always)]
pub fn noisy_fit_around(a: ObservedAround, left: f32) -> f32 {
    let confidence = (a.weight / a.spatial).min(1.0);
    fit(left / a.weight, confidence).min(mean_fit(a, confidence))
}

/// Rectification of history at a sample: gain of the light, and fit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rectification {
    /// Factor on history's color.
    pub gain: Vec3,
    /// Fit of history after the gain: 0 to 1.
    pub fit: f32,
    /// Fit at the sample's own pixel: 0 to 1.
    pub center_fit: f32,
    /// Whether the sample itself was compared with history; otherwise only its neighbours were.
    pub is_own: bool,
}

/// Rectification of history at a shaded quad of 2x2 pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct QuadRectification {
    /// Factor on history's color.
    pub gain: Vec3,
    /// Fit of history after the gain: 0 to 1.
    pub fit: f32,
    /// Fit at each pixel: 0 to 1.
    pub center_fits: [f32; 4],
    /// Whether a pixel of the quad was compared with history; otherwise only its neighbours were.
    pub is_own: bool,
    /// Disparity of each pixel.
    pub disparities: [f32; 4],
}

/// Four words: gain ([`pack_color`]); fit in 256ths in bits 0 to 8, `is_own` in bit 9, own fits in 16ths from bit 10
/// on; disparities ([`disparity_code`]). Fits of 0 and 1 are exact.
pub fn pack_rectification(r: QuadRectification) -> [u32; 4] {
    let own = |i: usize| ((r.center_fits[i] * 16.0 + 0.5) as u32) << (10 + 5 * i);
    let codes = |i: usize| disparity_code(r.disparities[i]) | disparity_code(r.disparities[i + 1]) << 16;
    let fits = (r.fit * 256.0 + 0.5) as u32 | u32::from(r.is_own) << 9 | own(0) | own(1) | own(2) | own(3);
    [pack_color(r.gain), fits, codes(0), codes(2)]
}

/// Estimate at pixel `i` of a quad.
pub fn unpack_rectification(words: [u32; 4], i: u32) -> Rectification {
    Rectification {
        gain: unpack_color(words[0]),
        fit: (words[1] & 511) as f32 * (1.0 / 256.0),
        center_fit: (words[1] >> (10 + 5 * i) & 31) as f32 * (1.0 / 16.0),
        is_own: words[1] >> 9 & 1 != 0,
    }
}

/// Word for [`has_code`](super::pack::has_code) of pixel `i` of a quad.
#[inline]
pub fn quad_code(words: [u32; 4], i: u32) -> u32 {
    let pair = words[2 + (i >> 1) as usize];
    if i & 1 == 0 { pair << 16 } else { pair & 0xffff_0000 }
}

/// Inputs of [`reconstruct`] for one pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reconstruction {
    /// Candidate: interpolated samples, or the sample at this pixel.
    pub candidate: Vec3,
    /// Its level of detail.
    pub lod: f32,
    /// Smallest and largest color of the samples around the pixel.
    pub range: [Vec3; 2],
    /// History at the pixel.
    pub history: Vec3,
    /// Its level of detail.
    pub history_lod: f32,
    /// Stored sample to keep. Its place is relative to the pixel.
    pub nearest: StoredSample,
    /// Levels of detail that history loses when light doubles ([`lod_loss_per_stop`]).
    pub lod_loss_per_stop: f32,
    /// Gain of relighting.
    pub gain: Vec3,
    /// Degree to which history fits the samples around the pixel, in \[0, 1\].
    pub fit: f32,
    /// Confidence in history, in \[0, 1\]: the frame's trust mask.
    pub trust: f32,
    /// `Smr::accumulate`: share of equally fine history in the output of blurred frames. Planned frames use half of
    /// this share.
    pub accumulate: f32,
}

/// Result of [`reconstruct`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reconstructed {
    /// Color to show.
    pub color: Vec3,
    /// Sample to store. It has the stored sample's disparity, which the caller must replace.
    pub stored: StoredSample,
    /// History's share in `color`.
    pub share: f32,
    /// Whether the stored color is of history's nearest sample, or of history at the position.
    pub keeps_nearest: bool,
    /// That color's share in the stored one; the rest is the candidate's.
    pub stored_share: f32,
}

/// Alpha to show and alpha to store beside a result: blended as its color is, without the gain. `history`: at the
/// position; `nearest`: of its nearest sample.
#[inline]
pub fn result_alpha(r: Reconstructed, candidate: f32, history: f32, nearest: f32) -> Vec2 {
    let old = if r.keeps_nearest { nearest } else { history };
    // A share of 1 gives the alpha bit for bit.
    let shown = candidate * (1.0 - r.share) + history * r.share;
    let stored = candidate * (1.0 - r.stored_share) + old * r.stored_share;
    Vec2::new(shown, stored)
}

/// Levels of detail that history loses when light doubles. `moved`: whether it was read between samples; `means`:
/// whether it stores means of samples.
#[inline]
pub fn lod_loss_per_stop(moved: bool, means: bool) -> f32 {
    if moved {
        LOD_LOSS_PER_STOP[0]
    } else if means {
        0.0
    } else {
        LOD_LOSS_PER_STOP[1]
    }
}

/// Relit color. A gain cannot raise it above the largest of the samples around it by more than a share of their range.
#[inline]
pub fn relit(color: Vec3, gain: Vec3, range: [Vec3; 2]) -> Vec3 {
    let highest = range[1] + (range[1] - range[0]) * OVERSHOOT;
    (color * gain).min(color.max(highest))
}

/// Blends history into the candidate, and chooses the sample to store. Where history prevails, this is the stored
/// sample, which is then not resampled; elsewhere it is the blend. Gain, range and fit have the place of
/// `RectifyHistory` in FSR2 (AMD 2022), which clips history to a box of colors.
#[inline]
pub fn reconstruct(r: &Reconstruction) -> Reconstructed {
    let gain = r.gain;
    let acceptance = r.fit * r.trust;
    let lost_lod = if gain == Vec3::ONE {
        0.0
    } else {
        let mean = (gain.x + gain.y + gain.z) * (1.0 / 3.0);
        (approx::ln_approx(mean) * LOG2_E).abs() * r.lod_loss_per_stop
    };
    let history_lod = r.history_lod + lost_lod;
    let finer = ((r.lod - history_lod) / FINER_WIDTH).clamp(0.0, 1.0);
    let coarser = ((history_lod - r.lod) / COARSER_WIDTH).clamp(0.0, 1.0);
    let share = (finer + (((1.0 - finer) * (1.0 - coarser)) * (r.accumulate * ACCUMULATE))) * acceptance;
    let history = relit(r.history, gain, r.range);
    let color = if share == 1.0 { history } else { r.candidate + (history - r.candidate) * share };
    let lost = 1.0 - finer * acceptance;
    let place = r.nearest.place_px;
    let near = place.x.abs().max(place.y.abs()) <= super::stored_sample::FARTHEST_PX;
    let kept_lod = r.nearest.lod + lost_lod;
    if share >= KEEP_SHARE && near && kept_lod < r.lod {
        let stored = StoredSample {
            color: relit(r.nearest.color, gain, r.range),
            lod: kept_lod + (r.lod - kept_lod) * lost,
            ..r.nearest
        };
        return Reconstructed { color, stored, share, keeps_nearest: true, stored_share: 1.0 };
    }
    let lod = if finer > 0.0 { history_lod + (r.lod - history_lod) * lost } else { r.lod };
    let stored = StoredSample { color, lod, place_px: Vec2::ZERO, ..r.nearest };
    Reconstructed { color, stored, share, keeps_nearest: false, stored_share: share }
}

/// Result of [`accumulate`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Accumulated {
    /// Color to show, and sample to store.
    pub result: Reconstructed,
    /// Noise of that sample.
    pub noise: Noise,
}

/// As [`reconstruct`], for noisy samples: a mean of history and candidate by their numbers of samples. History replaces
/// the candidate only as far as it is finer and its noise is invisible. `past`: noise of the stored sample; `now`:
/// noise of the candidate. History is not relit.
///
/// The mean is stored in the place of the stored sample, so that history is not resampled.
#[inline]
pub fn accumulate(r: &Reconstruction, past: Noise, now: Noise) -> Accumulated {
    let acceptance = r.fit * r.trust;
    let bright = luma(r.history);
    // Samples farther from this pixel count less.
    let now = Noise { samples: now.samples * approx::exp2_approx(-r.lod), variance: now.variance };
    let certain = noise_confidence(past, bright);
    let sharp = noise_confidence(Noise { samples: now.samples, variance: past.variance }, bright);
    let finer = ((r.lod - r.history_lod) / FINER_WIDTH).clamp(0.0, 1.0) * certain;
    let blurred = ((r.history_lod - r.lod) / COARSER_WIDTH).clamp(0.0, 1.0);
    let most = past.samples.min(BLURRED_FRAMES * now.samples);
    let known = Noise { samples: past.samples + (most - past.samples) * blurred, variance: past.variance };
    let alike = (1.0 - finer) * (1.0 - blurred * sharp);
    let share = (finer + alike * history_share(known, now, r.accumulate)) * acceptance;
    let color = if share == 1.0 { r.history } else { r.candidate + (r.history - r.candidate) * share };
    let lod = r.lod + (r.history_lod - r.lod) * share;
    let noise = noise_after(past, now, share, finer * acceptance);
    let place = r.nearest.place_px;
    let near = place.x.abs().max(place.y.abs()) <= super::stored_sample::FARTHEST_PX;
    let keeps_nearest = near && share >= STAY_SHARE;
    let stored = if keeps_nearest {
        StoredSample { color: r.candidate + (r.nearest.color - r.candidate) * share, lod, ..r.nearest }
    } else {
        StoredSample { color, lod, place_px: Vec2::ZERO, ..r.nearest }
    };
    Accumulated { result: Reconstructed { color, stored, share, keeps_nearest, stored_share: share }, noise }
}
