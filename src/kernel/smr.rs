//! One pixel of the scale-matched reservoir (smr): the sharpest sample of a surface point is shown as long as it
//! explains the candidate when low-passed to the candidate's level of detail. `docs/method.md` derives the equations.

use super::approx::{self, smooth_step};
use super::color::{DARK, distance_of_roots, past_roots, roots};
use super::lod::{COARSER_WIDTH, LOD_STEPS};
use crate::notes::{NoNotes, NoteStage, Notes};
use glam::{Vec3, Vec4};
use std::f32::consts::LOG2_E;

/// Levels of detail by which history must be finer than the candidate to replace it fully.
pub const QUALITY_WIDTH: f32 = 0.1;
/// Gate: difference at which the fit starts to fall from 1 (contrast is added to it), and width over which it falls to
/// 0, in units of [`root_difference`](super::color::root_difference).
const GATE: [f32; 2] = [3.0, 6.0];
/// Difference at which relighting starts, in units of [`root_difference`](super::color::root_difference), and the
/// factor on contrast that is added to it.
const RELIGHT: [f32; 2] = [1.5, 0.5];
/// [`RELIGHT`] for point-sampled blocks: higher, because their aliasing must not be mistaken for a change of light.
const RELIGHT_BLOCKS: [f32; 2] = [8.0, 0.5];
/// Relighting is used if it reduces the difference of candidate and history to at most this share. The share is smaller
/// for point-sampled blocks, where a gain that follows aliasing often reduces the difference by chance.
const RELIT: f32 = 1.0;
const RELIT_BLOCKS: f32 = 0.5;
/// Share of the difference between the observed color and the color predicted by finer history that is added to history
/// in each frame. A larger share follows slow changes of light sooner, and lets more of the candidates' aliasing into
/// history.
const CORRECTION: f32 = 0.2;
const CORRECTION_BLOCKS: f32 = 0.1;
/// Share of the contrast that is added to the gate, for history that is not finer than the candidate. For finer history
/// the share is 1.
const ALIKE_CONTRAST: f32 = 0.5;
/// Smallest and largest gain of relighting.
const GAIN: [f32; 2] = [0.2, 5.0];
/// Least levels of detail that a gain costs: half a stored step, which storage rounds up. A smaller gain would cost
/// nothing, and is not used.
const LEAST_LOST_LOD: f32 = 0.5 / LOD_STEPS;
/// Largest channel of compared colors in units of [`brightness_unit`]. At this brightness the units are the ones of the
/// frame, for which the gate's constants were chosen.
const MIDDLE: f32 = 0.5;
/// Least brightness that [`brightness_unit`] follows: the smallest normal half. Darker colors are stored in steps that
/// are large in comparison.
const LEAST_BRIGHTNESS: f32 = 1.0 / 16384.0;

/// Parameters of smr, from `Settings`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SmrParams {
    /// Share of equally coarse history in the output, in \[0, 1).
    pub accumulate: f32,
    /// Tolerance for equally coarse history, as a share of the tolerance for finer history, in (0, 1\]. The share does
    /// not apply to contrast.
    pub accumulate_tolerance: f32,
    /// Factor on the gate's differences.
    pub tolerance: f32,
    /// Whether candidates are point samples of blocks.
    pub blocks: bool,
    /// Whether history follows changes of light.
    pub relight: bool,
    /// Whether candidates are noisy: then history is accumulated in the fovea, too.
    pub noisy: bool,
}

/// As [`root_difference`](super::color::root_difference), of a color and of history, which is at least 0.
#[inline(always)]
pub fn past_difference(x: Vec3, past: Vec3) -> f32 {
    distance_of_roots(roots(x), past_roots(past))
}

/// Contrast of history: [`root_difference`](super::color::root_difference) of two of its levels.
#[inline(always)]
pub fn past_contrast(level: Vec3, next_level: Vec3) -> f32 {
    distance_of_roots(past_roots(level), past_roots(next_level))
}

/// Unit of the colors that the gate compares, linear: twice the largest channel of candidate and history. Colors that
/// are divided by it do not depend on the scale of brightness, so that a frame times a constant is shown as that
/// constant times the frame. `matched` is history before its factor `exposure`.
#[inline(always)]
pub fn brightness_unit(compared: Vec3, matched: Vec3, exposure: f32) -> f32 {
    let largest = compared.max_element().max(matched.max_element() * exposure);
    largest.max(LEAST_BRIGHTNESS) * (1.0 / MIDDLE)
}

/// Weight of history, without regard to its fit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReuseWeight {
    /// Degree to which history is finer than the candidate, in \[0, 1\].
    pub finer: f32,
    /// History's share in the output, if it fits: 1 where it is finer, `accumulate` where equally fine, 0 where it is
    /// coarser. Without noise, equally fine history has a share of 0 in the fovea.
    pub share: f32,
}

/// Reuse weight of history at level of detail `history_lod` for a candidate at `lod`. `confidence`: noise confidence of
/// history and of the candidate, in \[0, 1\], 1 without noise. With low confidence, finer history counts as equally
/// fine, and coarser history can be accumulated into a noisy candidate.
#[inline]
pub fn reuse_weight(lod: f32, history_lod: f32, accumulate: f32, noisy: bool, confidence: [f32; 2]) -> ReuseWeight {
    let finer = ((lod - history_lod) * (1.0 / QUALITY_WIDTH)).clamp(0.0, 1.0) * confidence[0];
    let coarser = ((history_lod - lod) / COARSER_WIDTH).clamp(0.0, 1.0) * confidence[1];
    let alike = (1.0 - finer) * (1.0 - coarser);
    let calm = if noisy { 1.0 } else { lod.min(1.0) };
    ReuseWeight { finer, share: finer + (alike * calm) * accumulate }
}

/// Gain of relighting for one color channel: the ratio of the observed color to the one that history predicts, blended
/// to 1 where light did not change (`changed` in \[0, 1\]) and for ratios within a few percent of 1.
#[inline(always)]
pub fn gain(observed: f32, predicted: f32, changed: f32) -> f32 {
    let ratio = ((observed + DARK) / (predicted + DARK)).clamp(GAIN[0], GAIN[1]);
    let share = changed * smooth_step(0.5, 1.0, 10.0 * (ratio - 1.0).abs());
    // A share of 1 gives the ratio bit for bit. Mesa rewrites 1 + (ratio - 1) * share into this form, too.
    (1.0 - share) + ratio * share
}

/// The largest gain or the smallest one, whichever is farther from 1 by its logarithm.
#[inline(always)]
pub fn strongest_gain(gains: Vec3) -> f32 {
    let (least, most) = (gains.min_element(), gains.max_element());
    if least * most < 1.0 { least } else { most }
}

/// Difference at which relighting starts, in units of [`root_difference`](super::color::root_difference). `noise`:
/// difference that noise alone can cause.
#[inline]
pub fn relight_from(contrast: f32, blocks: bool, noise: f32) -> f32 {
    let relight = if blocks { RELIGHT_BLOCKS } else { RELIGHT };
    (relight[0] + relight[1] * contrast) + noise
}

/// Whether history may be relit: only if it is finer than the candidate by more than storage rounds levels of detail.
/// Equally coarse history was delivered as coarse as the candidate. Low-passed once more it differs from the candidate
/// even if nothing changed, and a gain of this difference would grow from frame to frame. Means of
/// noisy candidates have no such limit. `finer`: of [`ReuseWeight`].
#[inline(always)]
pub fn may_relight(finer: f32, noisy: bool) -> bool {
    finer == 1.0 || noisy
}

/// Whether candidate and history differ by more than contrast explains. Relighting needs the candidate's neighbours
/// only in this case.
#[inline(always)]
pub fn is_changed(compared: Vec3, matched: Vec3, level: Vec3, next_level: Vec3) -> bool {
    past_difference(compared, matched) > relight_from(past_contrast(level, next_level), false, 0.0)
}

/// Inputs of [`decide`] for one pixel. Colors are linear; those that are compared, corrected by or relit by, from
/// `compared` to `observed` and from `matched` to `predicted`, are divided by `unit`.
#[derive(Clone, Copy, Debug)]
pub struct Evidence {
    /// The candidate.
    pub candidate: Vec3,
    /// [`brightness_unit`] of candidate and history.
    pub unit: f32,
    /// Color that is compared with history: the candidate, or a mean of its neighbourhood where it is a point sample or
    /// noisy.
    pub compared: Vec3,
    /// Candidate at the level of detail of `matched_coarser`; used only where [`is_changed`].
    pub compared_coarser: Vec3,
    /// Color by which history is corrected and relit: the candidate, or a mean of its neighbourhood where it is noisy.
    pub observed: Vec3,
    /// Level of detail of the candidate.
    pub lod: f32,
    /// History at full sharpness.
    pub history: Vec3,
    /// Level of detail that history was shaded at.
    pub history_lod: f32,
    /// Whether history was read between texels.
    pub resampled: bool,
    /// History at the level of detail of `compared`.
    pub matched: Vec3,
    /// History at the whole level of detail that is equal to or finer than the level of `compared`.
    pub level: Vec3,
    /// History at the next coarser whole level after `level`.
    pub next_level: Vec3,
    /// History at the place and level of detail of `compared_coarser`.
    pub matched_coarser: Vec3,
    /// History at the place and level of detail of `observed`, with the same low-pass filter. With two different
    /// filters, every edge would produce a gain. Gains are stored with history, so rings would grow at edges from frame
    /// to frame.
    pub predicted: Vec3,
    /// Confidence in history, in \[0, 1\]: the frame's trust mask.
    pub trust: f32,
    /// Difference of `compared` and `matched` that noise alone can cause, in units of
    /// [`root_difference`](super::color::root_difference); 0 for candidates without noise.
    pub noise: f32,
    /// Noise confidence of history and of the candidate, in \[0, 1\]; 1 without noise.
    pub confidence: [f32; 2],
}

/// Result of [`decide`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Matched {
    /// Output color; it is also stored.
    pub color: Vec3,
    /// Level of detail of `color`; negative: there is none.
    pub lod: f32,
    /// History's share in `color`.
    pub share: f32,
    /// Degree to which history explains the candidate, in \[0, 1\].
    pub fit: f32,
}

/// Blends history into the candidate by its reuse weight and its fit, the degree to which it explains the candidate.
/// History is relit if only the light changed.
#[inline(always)]
pub fn decide(e: &Evidence, p: &SmrParams) -> Matched {
    decide_noted(e, p, &mut NoNotes)
}

/// The same, with notes.
#[inline(always)]
pub(crate) fn decide_noted(e: &Evidence, p: &SmrParams, notes: &mut impl Notes) -> Matched {
    let reuse = reuse_weight(e.lod, e.history_lod, p.accumulate, p.noisy, e.confidence);
    e.note(reuse, notes);
    // Contrast of detail finer than the candidate. Where it is high, resampling and aliasing alone cause differences.
    let mut contrast = past_contrast(e.level, e.next_level);
    let mut d = past_difference(e.compared, e.matched);
    let mut k = Vec3::ONE;
    let mut lost_lod = 0.0;
    if p.relight {
        let from = relight_from(contrast, p.blocks, e.noise);
        let share = if may_relight(reuse.finer, p.noisy) { 1.0 } else { 0.0 };
        let changed = smooth_step(from, from, past_difference(e.observed, e.predicted)) * share;
        let (c, h) = (e.observed, e.predicted);
        let gains = Vec3::new(gain(c.x, h.x, changed), gain(c.y, h.y, changed), gain(c.z, h.z, changed));
        // History after the gain agrees by construction with the colors from which the gain was computed. The gain is
        // therefore judged by other colors.
        let unlit = past_difference(e.compared_coarser, e.matched_coarser);
        let relit = past_difference(e.compared_coarser, gains * e.matched_coarser);
        // Levels of detail that history loses. A gain multiplies history's errors, too, and its product is stored, so
        // that wrong gains would multiply from frame to frame. A sample that pays for each of them gets few before the
        // candidate replaces it.
        let strongest = strongest_gain(gains);
        let doublings = (approx::ln_approx(strongest) * LOG2_E).abs();
        let helps = relit < unlit * (if p.blocks { RELIT_BLOCKS } else { RELIT });
        notes.note(NoteStage::Light, "difference at which relighting starts", from, OF_DIFFERENCE);
        notes.note(NoteStage::Light, "change of light", changed, "");
        notes.note(NoteStage::Light, "gains", gains, "");
        notes.note(NoteStage::Light, "coarser difference without and with gains", [unlit, relit], OF_DIFFERENCE);
        if helps && (p.noisy || doublings >= LEAST_LOST_LOD) {
            d = relit;
            k = gains;
            contrast *= strongest.sqrt();
            lost_lod = if p.noisy { 0.0 } else { doublings };
        }
    }
    let width = p.accumulate_tolerance + (1.0 - p.accumulate_tolerance) * reuse.finer;
    let slack = contrast * (ALIKE_CONTRAST + (1.0 - ALIKE_CONTRAST) * reuse.finer);
    let scale = if p.blocks { 4.0 } else { 1.0 };
    let keep = p.tolerance * (width * (GATE[0] * scale) + slack);
    let fit = 1.0 - smooth_step(keep + e.noise, (p.tolerance * (GATE[1] * scale)) * width, d);
    let acceptance = fit * e.trust;
    let share = acceptance * reuse.share;
    notes.note(NoteStage::Light, "gains that are used", k, "");
    notes.note(NoteStage::Light, "levels of detail that they cost", lost_lod, "log2 px");
    notes.note(NoteStage::Comparison, "difference", d, OF_DIFFERENCE);
    notes.note(NoteStage::Comparison, "contrast of history", contrast, OF_DIFFERENCE);
    notes.note(NoteStage::Comparison, "difference up to which history fits", keep + e.noise, OF_DIFFERENCE);
    notes.note(NoteStage::Decision, "fit", fit, "");
    notes.note(NoteStage::Decision, "history's share if it fits", reuse.share, "");
    let correction = if p.blocks { CORRECTION_BLOCKS } else { CORRECTION };
    // History that was not resampled is not corrected, because it is unchanged since it was stored. History of noisy
    // frames is not corrected either, because accumulation averages the noise.
    let finer = if e.resampled && !p.noisy { reuse.finer } else { 0.0 };
    // The constant is multiplied with the first factor, because shader compilers order such products this way.
    let missed = (e.observed - k * e.predicted) * (correction * e.unit);
    let history = (missed * finer + k * e.history).max(Vec3::ZERO);
    notes.note(NoteStage::Decision, "history after gains and correction", history, "linear light");
    // A share of 1 gives history bit for bit, a share of 0 the candidate.
    let color = if share == 1.0 { history } else { e.candidate + (history - e.candidate) * share };
    let lod = if reuse.finer > 0.0 {
        ((e.history_lod + (e.lod - e.history_lod) * (1.0 - reuse.finer * acceptance)) + lost_lod).min(e.lod)
    } else if p.noisy {
        e.lod + (e.history_lod - e.lod).max(0.0) * share
    } else {
        e.lod
    };
    Matched { color, lod, share, fit }
}

/// Unit of [`root_difference`](super::color::root_difference) in notes.
const OF_DIFFERENCE: &str = "100 from black to white";

impl Evidence {
    #[inline(always)]
    fn note(&self, reuse: ReuseWeight, notes: &mut impl Notes) {
        const OF_BRIGHTNESS: &str = "units of brightness";
        let mut compared = |name, value: Vec3, unit| notes.note(NoteStage::Comparison, name, value, unit);
        compared("candidate that is compared", self.compared, OF_BRIGHTNESS);
        compared("history at its scale", self.matched, OF_BRIGHTNESS);
        compared("candidate, coarser", self.compared_coarser, "units of brightness; black unless light changed");
        compared("history at that scale", self.matched_coarser, OF_BRIGHTNESS);
        let unit = "linear light; the compared colors are divided by it";
        notes.note(NoteStage::Comparison, "unit of brightness", self.unit, unit);
        notes.note(NoteStage::Comparison, "history is finer", reuse.finer, "");
        notes.note(NoteStage::Comparison, "difference that noise explains", self.noise, OF_DIFFERENCE);
    }
}

/// Mean of four texels of the mip chain: color times coverage, and coverage.
#[inline]
pub fn mip_mean(a: Vec4, b: Vec4, c: Vec4, d: Vec4) -> Vec4 {
    (a + b + c + d) * 0.25
}

/// Bilinear interpolation of the color of four texels of the mip chain, weighted by coverage. Black where nothing is
/// covered.
#[inline]
pub fn mip_bilinear(top: [Vec4; 2], bottom: [Vec4; 2], fraction: [f32; 2]) -> Vec3 {
    let t = top[0] + (top[1] - top[0]) * fraction[0];
    let b = bottom[0] + (bottom[1] - bottom[0]) * fraction[0];
    let v = t + (b - t) * fraction[1];
    let inverse = 1.0 / v.w.max(1e-3);
    Vec3::new(v.x * inverse, v.y * inverse, v.z * inverse)
}
