//! One pixel of temporal antialiasing, the gaze-unaware baseline: a mean along the motion, with history clipped to the
//! color distribution of the candidate's neighbourhood (Salvi 2016, "An excursion in temporal supersampling"; Karis
//! 2014). Confidence is the number of samples that history counts for; resampling and bias limit it.

use super::color::{ROUNDING, clip_to_box, roots, roots_of_ycocg, to_ycocg};
use crate::notes::{NoNotes, NoteStage, Notes};
use glam::Vec3;

/// Largest confidence of history, in samples at the pixel: a mean of 16 jittered samples has a quarter of the error of
/// one. With a larger limit, the steps of the mean would be too small for colors of 14 bits.
const LIMIT: f32 = 16.0;
/// Confidence above which history is settled: it has hardly moved, and must agree with the samples around it. At twice
/// this confidence it is fully settled.
pub const SETTLED: f32 = 2.0;
/// Largest squared difference between the mean of the samples and the mean of history that jitter explains, in
/// variances of the samples. A jitter of up to half a pixel moves all samples alike, and the mean of 3x3 samples by
/// about a third of their deviation. A larger value follows changes of light later; a smaller one mistakes jitter for a
/// change of light.
const JITTER: f32 = 1.0 / 9.0;
/// Inverse confidence of history midway between texels: each resampling blurs, and a candidate aliases.
pub const SPREAD: f32 = 0.6;
/// Half width of the clipping box in standard deviations, around history that moves and around settled history. A
/// foveated neighbourhood is smooth, so that narrower boxes would clip the detail of earlier frames; wider ones keep
/// outdated history. Settled history needs a wider box: it agrees with its neighbourhood on average, but is a mean of
/// earlier samples.
const BOX_SIGMAS: [f32; 2] = [2.0, 5.0];
/// Largest square root of a half.
const MAX_ROOT: f32 = 256.0;
/// Level of detail that is stored for a confidence of 0. Confidence is stored as a level of detail, so that it falls
/// where history is enlarged.
const NO_CONFIDENCE_LOD: f32 = 8.0;

/// Luma of the square roots of a linear color: Y of [`to_ycocg`], at most that of the largest half.
#[inline]
pub fn root_luma(c: Vec3) -> f32 {
    // The limit keeps compilers from merging the sum with others.
    to_ycocg(c).x.min(MAX_ROOT)
}

/// Confidence of a stored level of detail, in samples at the pixel.
#[inline]
pub fn confidence_of(lod: f32) -> f32 {
    let root = (NO_CONFIDENCE_LOD - lod).max(0.0) * 0.5;
    root * root
}

/// Level of detail to store for a confidence.
#[inline]
pub fn lod_of(confidence: f32) -> f32 {
    (NO_CONFIDENCE_LOD - 2.0 * confidence.sqrt()).max(0.0)
}

/// Largest confidence of history read at `fraction` (each in \[0, 1)) between texels. In each frame, linear
/// interpolation spreads a pixel by a variance of f (1 - f), and a mean over n frames accumulates about n of these.
/// Limiting n limits the blur. `spread`: inverse of the confidence midway between texels; a larger spread blurs less,
/// and averages less.
#[inline]
pub fn confidence_limit(fraction: [f32; 2], spread: f32) -> f32 {
    let x = 4.0 * (fraction[0] * (1.0 - fraction[0]));
    let y = 4.0 * (fraction[1] * (1.0 - fraction[1]));
    1.0 / (x.max(y) * spread + 1.0 / LIMIT)
}

/// Degree to which history of a confidence is settled, in \[0, 1\].
#[inline]
pub fn settled(confidence: f32) -> f32 {
    ((confidence - SETTLED) * (1.0 / SETTLED)).clamp(0.0, 1.0)
}

/// Largest confidence of settled history, by the difference between its mean and the mean of the samples around it. The
/// confidence falls with the squared difference. It is `LIMIT` or more where jitter explains the difference. `sum`,
/// `squares`: sums of the lumas of `count` samples, and of their squares; `past`: sum of history's lumas at the same
/// pixels.
#[inline]
pub fn agreeing(sum: f32, squares: f32, past: f32, count: f32) -> f32 {
    let inverse = 1.0 / count.max(1.0);
    let variance = (squares * count - sum * sum) * (inverse * inverse);
    let off = (sum - past) * inverse;
    (variance.max(0.0) * JITTER + ROUNDING * ROUNDING) * LIMIT / (off * off + ROUNDING * ROUNDING)
}

/// Share of the candidate in a mean with history of a confidence; at least `1 - trust`.
#[inline]
pub fn candidate_share(confidence: f32, trust: f32) -> f32 {
    (1.0 / (confidence + 1.0)).max(1.0 - trust)
}

/// Half width of a clipping box in standard deviations.
#[inline]
pub fn box_sigmas(moving: f32, still: f32, confidence: f32) -> f32 {
    moving + (still - moving) * settled(confidence)
}

/// Output color: the candidate with a share of `alpha`, and clipped history with the rest. `sum` and `squares`: sums
/// over the 3x3 neighbourhood in YCoCg of colors and of their squares.
#[inline]
pub fn blend_clipped(candidate: Vec3, history: Vec3, sum: Vec3, squares: Vec3, alpha: f32, confidence: f32) -> Vec3 {
    blend_clipped_noted(candidate, history, sum, squares, alpha, confidence, &mut NoNotes)
}

/// The same, with notes.
#[inline]
pub(crate) fn blend_clipped_noted(
    candidate: Vec3,
    history: Vec3,
    sum: Vec3,
    squares: Vec3,
    alpha: f32,
    confidence: f32,
    notes: &mut impl Notes,
) -> Vec3 {
    let mean = sum * (1.0 / 9.0);
    let variance = (squares * 9.0 - sum * sum) * (1.0 / 81.0);
    let sigmas = box_sigmas(BOX_SIGMAS[0], BOX_SIGMAS[1], confidence);
    let extent = roots(variance) * sigmas + Vec3::splat(ROUNDING);
    let clipped = roots_of_ycocg(clip_to_box(to_ycocg(history), mean, extent));
    notes.note(NoteStage::Comparison, "mean of the colors around", mean, "YCoCg of square roots");
    notes.note(NoteStage::Comparison, "box of history around it", extent, "half widths, YCoCg of square roots");
    notes.note(NoteStage::Comparison, "history in the box", clipped * clipped, "linear light");
    let shown = clipped + (roots(candidate) - clipped) * alpha;
    shown * shown
}
