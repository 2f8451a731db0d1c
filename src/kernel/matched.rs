//! One pixel of the scale-matched reservoir (smr): the best sample of a surface point is shown while, low-passed to the
//! candidate's level of detail, it explains the candidate. `docs/method.md` derives it.

use glam::{Vec3, Vec4};

/// Levels of detail by which history must be finer to count wholly as the better sample.
pub const QUALITY_WIDTH: f32 = 0.1;
/// Levels of detail by which history may be coarser and still be accumulated.
pub(super) const COARSER_WIDTH: f32 = 0.25;
/// Difference up to which history is believed, which grows with contrast, and over how much more it ceases to be, in
/// [`root_difference`]'s units.
const GATE: [f32; 2] = [3.0, 6.0];
/// Difference at which relighting sets in, and what a unit of contrast adds to it.
const RELIGHT: [f32; 2] = [1.5, 0.5];
/// The same for point-sampled blocks, whose aliasing is no change of light.
const RELIGHT_BLOCKS: [f32; 2] = [12.0, 2.0];
/// Gains of relighting.
const GAIN: [f32; 2] = [0.2, 5.0];
/// Keeps ratios of dark colors finite.
pub(super) const DARK: f32 = 0.002;
/// Motion of neighbours that counts as the same: this many pixels, and this share of their length.
const COHERENT: [f32; 2] = [0.5, 0.1];

/// Tunables.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SmrParams {
    /// Share of equally coarse history in what is shown, in \[0, 1).
    pub accumulate: f32,
    /// Tolerance of accumulation as a share of that of reuse, in (0, 1\].
    pub accumulate_tolerance: f32,
    /// Factor on the gate's differences.
    pub tolerance: f32,
    /// Candidates are point samples of blocks.
    pub blocks: bool,
    /// Follow changes of light.
    pub relight: bool,
    /// Candidates are noisy: equally fine history is accumulated where the eye looks, too.
    pub noisy: bool,
}

/// 0 up to `from`, 1 from `width` above it on, smooth between.
#[inline]
pub fn smooth_step(from: f32, width: f32, x: f32) -> f32 {
    let t = ((x - from) / width).clamp(0.0, 1.0);
    (t * t) * (3.0 - 2.0 * t)
}

/// Difference of two linear colors, 100 between black and white: Euclidean in YCoCg of square roots, chroma with half the
/// weight. Exactly 0 for equal colors; no cube roots.
#[inline]
pub fn root_difference(x: Vec3, y: Vec3) -> f32 {
    let d = roots(x) - roots(y);
    let outer = 0.25 * (d.x + d.z);
    let inner = 0.5 * d.y;
    let luma = outer + inner;
    let orange = 0.5 * (d.x - d.z);
    let green = inner - outer;
    let chroma = orange * orange + green * green;
    100.0 * (luma * luma + 0.5 * chroma).sqrt()
}

/// Square roots of a color's channels; of negative ones 0.
#[inline]
pub fn roots(c: Vec3) -> Vec3 {
    Vec3::new(c.x.max(0.0).sqrt(), c.y.max(0.0).sqrt(), c.z.max(0.0).sqrt())
}

/// Whether two motion vectors (pixels) are of one surface. A pixel that moves like neither neighbour of its block of 2x2 lies on a
/// moving silhouette, where renderers mix the vectors of both sides: such a vector leads nowhere.
#[inline]
pub fn moves_alike(own: [f32; 2], other: [f32; 2]) -> bool {
    let within = COHERENT[0] + COHERENT[1] * (own[0].abs() + own[1].abs());
    (other[0] - own[0]).abs() <= within && (other[1] - own[1]).abs() <= within
}

/// Weight of history before it is known whether it fits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReuseWeight {
    /// 1 if history is finer than the candidate, 0 if not, in \[0, 1\].
    pub finer: f32,
    /// Its share in what is shown, if it fits: 1 where finer, `accumulate` where alike, 0 where coarser, and in the fovea unless it is
    /// noisy.
    pub share: f32,
}

/// Reuse weight of history at `history_lod` for a candidate at `lod` (levels of detail). `confidence`: of history and of the
/// candidate, in \[0, 1\], 1 without noise. A noisy finer history is worth no more than an equally coarse one, and a coarser history is
/// better than noise.
#[inline]
pub fn reuse_weight(lod: f32, history_lod: f32, accumulate: f32, noisy: bool, confidence: [f32; 2]) -> ReuseWeight {
    let finer = ((lod - history_lod) / QUALITY_WIDTH).clamp(0.0, 1.0) * confidence[0];
    let coarser = ((history_lod - lod) / COARSER_WIDTH).clamp(0.0, 1.0) * confidence[1];
    let alike = (1.0 - finer) * (1.0 - coarser);
    let calm = if noisy { 1.0 } else { lod.min(1.0) };
    ReuseWeight { finer, share: finer + (alike * calm) * accumulate }
}

/// A color channel's gain under changed light: the ratio of candidate and history at a coarse level, as far as light `changed`
/// (0 to 1) and by no less than a few percent.
#[inline]
pub fn gain(candidate: f32, history: f32, changed: f32) -> f32 {
    let ratio = ((candidate + DARK) / (history + DARK)).clamp(GAIN[0], GAIN[1]);
    let share = changed * smooth_step(0.05, 0.1, (ratio - 1.0).abs());
    // So that a share of 1 gives the ratio bit for bit. Mesa computes 1 + (ratio - 1) * share thus, too.
    (1.0 - share) + ratio * share
}

/// Difference at which relighting sets in, `noise` being what noise alone makes.
#[inline]
pub fn relight_from(contrast: f32, blocks: bool, noise: f32) -> f32 {
    let relight = if blocks { RELIGHT_BLOCKS } else { RELIGHT };
    (relight[0] + relight[1] * contrast) + noise
}

/// Whether candidate and history differ by more than detail explains: only then is it of interest what surrounds the candidate.
#[inline]
pub fn is_changed(compared: Vec3, matched: Vec3, level: Vec3, next_level: Vec3, blocks: bool) -> bool {
    root_difference(compared, matched) > relight_from(root_difference(level, next_level), blocks, 0.0)
}

/// What is known of a pixel before the decision.
#[derive(Clone, Copy, Debug)]
pub struct Evidence {
    /// The candidate.
    pub candidate: Vec3,
    /// What of it is compared: itself, or a mean of its surroundings where it is a point sample.
    pub compared: Vec3,
    /// The candidate one level coarser; of no interest unless [`is_changed`].
    pub compared_coarser: Vec3,
    /// Its level of detail.
    pub lod: f32,
    /// History at full sharpness.
    pub history: Vec3,
    /// Level of detail it was shaded at.
    pub history_lod: f32,
    /// History at the level of `compared`.
    pub matched: Vec3,
    /// History at the whole level at or below that.
    pub level: Vec3,
    /// History at the next whole level.
    pub next_level: Vec3,
    /// How far history may be believed, in \[0, 1\].
    pub trust: f32,
    /// Difference of `compared` and `matched` that noise alone makes; 0 for candidates without noise.
    pub noise: f32,
    /// How far history and the candidate are free of noise, in \[0, 1\].
    pub confidence: [f32; 2],
}

/// What was decided.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Matched {
    /// What is shown and stored.
    pub color: Vec3,
    /// Its level of detail.
    pub lod: f32,
    /// History's share in it.
    pub share: f32,
    /// How well history explains the candidate, in \[0, 1\].
    pub fit: f32,
}

/// Blends history into the candidate by its reuse weight and by how well it explains the candidate; relit if only the light changed.
#[inline]
pub fn decide(e: &Evidence, p: &SmrParams) -> Matched {
    let reuse = reuse_weight(e.lod, e.history_lod, p.accumulate, p.noisy, e.confidence);
    // Detail below the candidate's scale: where it is strong, resampling and aliasing alone make differences.
    let mut contrast = root_difference(e.level, e.next_level);
    let mut d = root_difference(e.compared, e.matched);
    let mut k = Vec3::ONE;
    if p.relight {
        let from = relight_from(contrast, p.blocks, e.noise);
        let changed = smooth_step(from, from, d);
        let (c, h) = (e.compared_coarser, e.next_level);
        let gains = Vec3::new(gain(c.x, h.x, changed), gain(c.y, h.y, changed), gain(c.z, h.z, changed));
        let relit = root_difference(e.compared, gains * e.matched);
        if relit < d {
            d = relit;
            k = gains;
            contrast *= ((gains.x + gains.y + gains.z) * (1.0 / 3.0)).sqrt();
        }
    }
    let tolerance = p.tolerance * (p.accumulate_tolerance + (1.0 - p.accumulate_tolerance) * reuse.finer);
    let scale = if p.blocks { 4.0 } else { 1.0 };
    let fit = 1.0 - smooth_step(tolerance * (GATE[0] * scale + contrast) + e.noise, tolerance * (GATE[1] * scale), d);
    let believed = fit * e.trust;
    let share = believed * reuse.share;
    let history = k * e.history;
    // A share of 1 gives the history bit for bit, and one of 0 the candidate.
    let color = if share == 1.0 { history } else { e.candidate + (history - e.candidate) * share };
    let lod = if reuse.finer > 0.0 {
        (e.history_lod + (e.lod - e.history_lod) * (1.0 - reuse.finer * believed)).min(e.lod)
    } else if p.noisy {
        e.lod + (e.history_lod - e.lod).max(0.0) * share
    } else {
        e.lod
    };
    Matched { color, lod, share, fit }
}

/// Mean of four texels of the chain of coarser levels: colors times coverage, and coverage.
#[inline]
pub fn mip_mean(a: Vec4, b: Vec4, c: Vec4, d: Vec4) -> Vec4 {
    (a + b + c + d) * 0.25
}

/// Color between four texels of the chain, rows first. Black where nothing is covered.
#[inline]
pub fn mip_bilinear(top: [Vec4; 2], bottom: [Vec4; 2], fraction: [f32; 2]) -> Vec3 {
    let t = top[0] + (top[1] - top[0]) * fraction[0];
    let b = bottom[0] + (bottom[1] - bottom[0]) * fraction[0];
    let v = t + (b - t) * fraction[1];
    let inverse = 1.0 / v.w.max(1e-3);
    Vec3::new(v.x * inverse, v.y * inverse, v.z * inverse)
}
