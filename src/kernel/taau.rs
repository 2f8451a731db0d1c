//! One pixel of temporal upsampling, the baseline on sparse frames: samples of this frame are weighted by their true
//! distance from the pixel, history by the weight that it has accumulated, after a clip to the distribution of the
//! samples around. The structure is that of FidelityFX Super Resolution 2 (AMD 2022, `ffx_fsr2_upsample.h`,
//! `ffx_fsr2_accumulate.h`), without locks, reactive masks and dilated motion vectors.

use super::matched::roots;
use super::taa::{ROUNDING, box_sigmas, clip_to_box, roots_of_ycocg, settled, to_ycocg};
use glam::{Vec2, Vec3};

/// Weight of interpolation between samples where history knows nothing, relative to a sample at the pixel. More
/// flickers less until a pixel's first sample arrives, and blurs it afterwards.
const TAIL: f32 = 0.02;
/// The least share of that weight, where history is confident: with it a pixel leaves outdated history between its
/// samples, too.
const LEAST_TAIL: f32 = 0.02;
/// Confidence from which on interpolation has that share: half a sample at the pixel.
const TAIL_UNTIL: f32 = 0.5;
/// Least sum of weights of usable samples.
pub const LEAST_SAMPLE_WEIGHT: f32 = 1e-5;
/// Inverse confidence of history midway between texels. More than that of taa: samples are put where they belong.
pub const UPSAMPLED_SPREAD: f32 = 1.0;
/// Squared distances count by so much more where history is settled: a sample then counts up to 0.85 pixels away, and
/// the mean is nearer to one over the pixel. History has filled the pixels that no sample is near.
const NARROWING: f32 = 0.4;
/// Half width of the clipping box in standard deviations of nine samples, around history that moves and around settled
/// history. More keeps thin detail, less follows changes. Settled history agrees with the samples, and is the mean of
/// others than this frame's.
const UPSAMPLED_BOX_SIGMAS: [f32; 2] = [1.5, 5.0];
/// Share of the clip where no sample is near. Samples at a distance say little of a pixel's own detail.
const LEAST_CLIP: f32 = 0.1;
/// Share of its confidence that history loses for a clip by the range from black to white, or by the history's own
/// brightness where that is more: a tenth of it costs all.
const CLIP_COST: f32 = 10.0;

/// Weight of a sample at a squared distance, in units of the kernel's reach: the main lobe of Lanczos 2, as FSR2
/// approximates it. 1 at the sample, 0 from a distance of 1 on, so that samples on texels stay sharp.
#[inline]
pub fn lobe(squared: f32) -> f32 {
    let b = 1.0 - 0.25 * squared;
    ((1.0 - squared).max(0.0) * b) * (b * b)
}

/// Weight of interpolation between samples, for history of some confidence.
#[inline]
pub fn tail(confidence: f32) -> f32 {
    let unknown = (1.0 - confidence * (1.0 / TAIL_UNTIL)).clamp(0.0, 1.0);
    (unknown * (1.0 - LEAST_TAIL) + LEAST_TAIL) * TAIL
}

/// Factor on squared distances of a pixel's own samples, for history of some confidence.
#[inline]
pub fn narrowing(confidence: f32) -> f32 {
    settled(confidence) * NARROWING + 1.0
}

/// Weights of a sample: as one of the pixel's own, and together with interpolation from lattices of larger steps.
#[inline]
pub fn sample_weights(offset_px: Vec2, level: u32, tail: f32, narrowing: f32) -> Vec2 {
    let px2 = offset_px.x * offset_px.x + offset_px.y * offset_px.y;
    let inverse_step = f32::from_bits((127 - level) << 23);
    let own = lobe(px2 * narrowing);
    Vec2::new(own, own + lobe(px2 * (inverse_step * inverse_step)) * tail)
}

/// Sums over the nine samples around a pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SamplesAround {
    /// Differences from the nearest sample's color times weights.
    pub difference: Vec3,
    /// Weights: of [`sample_weights`].
    pub weights: Vec2,
    /// Colors in YCoCg.
    pub sum: Vec3,
    /// Squares of these.
    pub squares: Vec3,
    /// Number of samples.
    pub count: f32,
}

/// The sums with one sample more. `centre`: color of the nearest sample.
#[inline]
pub fn add_around(a: SamplesAround, centre: Vec3, color: Vec3, weights: Vec2) -> SamplesAround {
    let v = to_ycocg(color);
    SamplesAround {
        difference: a.difference + (color - centre) * weights.y,
        weights: a.weights + weights,
        sum: a.sum + v,
        squares: a.squares + v * v,
        count: a.count + 1.0,
    }
}

/// Color of the samples at the pixel. A sample that is alone has its color, bit for bit.
#[inline]
pub fn upsampled(a: SamplesAround, centre: Vec3) -> Vec3 {
    centre + a.difference * (1.0 / a.weights.y)
}

/// Result of [`accumulate`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Accumulated {
    /// Output color; it is also stored.
    pub color: Vec3,
    /// Confidence to store.
    pub confidence: f32,
    /// Share of this frame's samples.
    pub share: f32,
    /// Share of its confidence that history kept after the clip.
    pub kept: f32,
}

/// Blends this frame's samples with history, which is clipped to their distribution. `trust`: confidence in history by
/// the frame's mask, in \[0, 1\].
#[inline]
pub fn accumulate(a: SamplesAround, centre: Vec3, history: Vec3, confidence: f32, trust: f32) -> Accumulated {
    let inverse = 1.0 / a.count;
    let variance = (a.squares * a.count - a.sum * a.sum) * (inverse * inverse);
    let past = to_ycocg(history);
    let sigmas = box_sigmas(UPSAMPLED_BOX_SIGMAS[0], UPSAMPLED_BOX_SIGMAS[1], confidence);
    let extent = roots(variance) * sigmas + Vec3::splat(ROUNDING);
    let inside = clip_to_box(past, a.sum * inverse, extent);
    let strength = a.weights.x.min(1.0) * (1.0 - LEAST_CLIP) + LEAST_CLIP;
    let clip = inside - past;
    let distance = clip.x.abs().max(clip.y.abs()).max(clip.z.abs());
    let kept = 1.0 - (distance * CLIP_COST / past.x.max(1.0)).min(1.0) * strength;
    let clipped = roots_of_ycocg(past + clip * strength);
    let share = (a.weights.y / (confidence * kept + a.weights.y)).max(1.0 - trust);
    let shown = clipped + (roots(upsampled(a, centre)) - clipped) * share;
    Accumulated { color: shown * shown, confidence: a.weights.y / share, share, kept }
}
