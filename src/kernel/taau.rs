//! One pixel of temporal upsampling, the baseline on planned frames: samples of this frame are weighted by their true
//! distance from the pixel, history by the weight that it has accumulated, after a clip to the distribution of the
//! samples around. The structure is that of FidelityFX Super Resolution 2 (AMD 2022, `ffx_fsr2_upsample.h`,
//! `ffx_fsr2_accumulate.h`), without locks, reactive masks and dilated motion vectors.

use super::color::{ROUNDING, clip_to_box, roots, roots_of_ycocg, to_ycocg};
use super::taa::{box_sigmas, settled};
use crate::notes::{NoNotes, NoteStage, Notes};
use glam::{Vec2, Vec3};

/// Weight of interpolation between samples where history has no confidence, relative to a sample at the pixel. A larger
/// weight flickers less until a pixel's first sample arrives, and blurs the pixel afterwards.
const TAIL: f32 = 0.02;
/// Share of [`TAIL`] that remains where history is confident. It lets a pixel leave outdated history even in frames
/// without a sample of its own.
const LEAST_TAIL: f32 = 0.02;
/// Confidence at which the weight of interpolation has fallen to [`LEAST_TAIL`] times [`TAIL`]: half a sample at the
/// pixel.
const TAIL_UNTIL: f32 = 0.5;
/// Least sum of weights of usable samples.
pub const LEAST_SAMPLE_WEIGHT: f32 = 1e-5;
/// Inverse confidence of history midway between texels. Larger than that of taa, because samples are added at their
/// true positions.
pub const UPSAMPLED_SPREAD: f32 = 1.0;
/// Increase of squared distances where history is settled. A sample then counts up to 0.85 pixels away, so that the
/// mean is closer to a mean over the pixel's area. This is possible because history has already filled the pixels
/// without a sample nearby.
const NARROWING: f32 = 0.4;
/// Half width of the clipping box in standard deviations of nine samples, around history that moves and around settled
/// history. Wider boxes keep thin detail; narrower ones follow changes. Settled history needs a wider box: it agrees
/// with the samples on average, but is a mean of earlier ones.
const UPSAMPLED_BOX_SIGMAS: [f32; 2] = [1.5, 5.0];
/// Share of the clip where no sample is near. Distant samples are weak evidence about a pixel's own detail.
const LEAST_CLIP: f32 = 0.1;
/// Cost of a clip: the share of its confidence that history loses, per clip distance in units of the range from black
/// to white, or of history's own brightness if that is larger. A clip by a tenth costs all confidence.
const CLIP_COST: f32 = 10.0;

/// Weight of a sample at a squared distance, in units of the kernel's reach: the main lobe of Lanczos 2, as FSR2
/// approximates it. 1 at the sample, 0 from a distance of 1 on, so that samples on texels stay sharp.
#[inline]
pub fn lobe(squared: f32) -> f32 {
    let b = 1.0 - 0.25 * squared;
    ((1.0 - squared).max(0.0) * b) * (b * b)
}

/// Weight of interpolation between samples, for history of a confidence.
#[inline]
pub fn tail(confidence: f32) -> f32 {
    let unknown = (1.0 - confidence * (1.0 / TAIL_UNTIL)).clamp(0.0, 1.0);
    (unknown * (1.0 - LEAST_TAIL) + LEAST_TAIL) * TAIL
}

/// Factor on squared distances of a pixel's own samples, for history of a confidence.
#[inline]
pub fn narrowing(confidence: f32) -> f32 {
    settled(confidence) * NARROWING + 1.0
}

/// Two weights of a sample: its weight as one of the pixel's own samples, and the sum of this weight and its weight for
/// interpolation.
#[inline]
pub fn sample_weights(offset_px: Vec2, tail: f32, narrowing: f32) -> Vec2 {
    let px2 = offset_px.x * offset_px.x + offset_px.y * offset_px.y;
    let own = lobe(px2 * narrowing);
    Vec2::new(own, own + lobe(px2) * tail)
}

/// Sums over the nine samples around a pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SamplesAround {
    /// Differences from the nearest sample's color times weights.
    pub difference: Vec3,
    /// Sums of the two weights of [`sample_weights`].
    pub weights: Vec2,
    /// Colors in YCoCg.
    pub sum: Vec3,
    /// Squares of these.
    pub squares: Vec3,
    /// Number of samples.
    pub count: f32,
}

/// The sums after one more sample. `centre`: color of the nearest sample.
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

/// Color of the samples at the pixel. A single sample keeps its color bit for bit.
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
    accumulate_noted(a, centre, history, confidence, trust, &mut NoNotes)
}

/// The same, with notes.
#[inline]
pub(crate) fn accumulate_noted(
    a: SamplesAround,
    centre: Vec3,
    history: Vec3,
    confidence: f32,
    trust: f32,
    notes: &mut impl Notes,
) -> Accumulated {
    let inverse = 1.0 / a.count;
    let variance = (a.squares * a.count - a.sum * a.sum) * (inverse * inverse);
    let past = to_ycocg(history);
    let sigmas = box_sigmas(UPSAMPLED_BOX_SIGMAS[0], UPSAMPLED_BOX_SIGMAS[1], confidence);
    let extent = roots(variance) * sigmas + Vec3::splat(ROUNDING);
    let inside = clip_to_box(past, a.sum * inverse, extent);
    let strength = a.weights.x.min(1.0) * (1.0 - LEAST_CLIP) + LEAST_CLIP;
    let clip = inside - past;
    let moved = clip.x.abs().max(clip.y.abs()).max(clip.z.abs());
    let kept = 1.0 - (moved * CLIP_COST / past.x.max(1.0)).min(1.0) * strength;
    let clipped = roots_of_ycocg(past + clip * strength);
    notes.note(NoteStage::Comparison, "mean of the samples around", a.sum * inverse, "YCoCg of square roots");
    notes.note(NoteStage::Comparison, "box of history around it", extent, "half widths, YCoCg of square roots");
    notes.note(NoteStage::Comparison, "share of the clip", strength, "");
    notes.note(NoteStage::Comparison, "history after the clip", clipped * clipped, "linear light");
    let share = (a.weights.y / (confidence * kept + a.weights.y)).max(1.0 - trust);
    let shown = clipped + (roots(upsampled(a, centre)) - clipped) * share;
    Accumulated { color: shown * shown, confidence: a.weights.y / share, share, kept }
}
