//! One pixel of the scale-matched reservoir (smr): the best sample of a surface point is shown while, low-passed to the
//! candidate's level of detail, it explains the candidate.

use glam::Vec3;

/// Tunables of the method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SmrParams {
    /// Levels of detail by which history must be sharper to count fully as the better sample.
    pub quality_width: f32,
    /// Share of equally coarse history in what is shown.
    pub accumulate: f32,
    /// Tolerance of accumulation, as a share of that of reuse.
    pub accumulate_tolerance: f32,
    /// Difference at which relighting sets in.
    pub relight_from: f32,
    /// The same, for each unit of local contrast.
    pub relight_contrast: f32,
    /// Difference up to which history is trusted wholly.
    pub gate_from: f32,
    /// Difference from which it is not trusted at all.
    pub gate_to: f32,
    /// What one unit of local contrast adds to both.
    pub gate_contrast: f32,
}

impl Default for SmrParams {
    fn default() -> Self {
        Self {
            quality_width: 0.1,
            accumulate: 0.85,
            accumulate_tolerance: 0.5,
            relight_from: 1.5,
            relight_contrast: 0.5,
            gate_from: 3.0,
            gate_to: 9.0,
            gate_contrast: 1.0,
        }
    }
}

/// 0 up to `from`, 1 from `to` on, a smooth step between.
#[inline]
pub fn smooth_step(from: f32, to: f32, x: f32) -> f32 {
    let t = ((x - from) / (to - from)).clamp(0.0, 1.0);
    (t * t) * (3.0 - 2.0 * t)
}

/// Difference of two linear colours, about 100 between black and white: Euclidean in gamma 2, with half the weight on chroma.
#[inline]
pub fn difference(x: Vec3, y: Vec3) -> f32 {
    let root = |v: Vec3| Vec3::new(v.x.max(0.0).sqrt(), v.y.max(0.0).sqrt(), v.z.max(0.0).sqrt());
    let d = root(x) - root(y);
    let luma = 0.25 * (d.x + d.z) + 0.5 * d.y;
    let orange = 0.5 * (d.x - d.z);
    let green = 0.5 * d.y - 0.25 * (d.x + d.z);
    100.0 * (luma * luma + 0.5 * (orange * orange + green * green)).sqrt()
}

/// What is known of a pixel before the decision.
#[derive(Clone, Copy, Debug)]
pub struct Evidence {
    /// The candidate.
    pub candidate: Vec3,
    /// What of it is compared.
    pub seen: Vec3,
    /// Its level of detail.
    pub lod: f32,
    /// History at full sharpness.
    pub history: Vec3,
    /// Level of detail it was shaded at.
    pub history_lod: f32,
    /// History at the candidate's level of detail.
    pub matched: Vec3,
    /// History one level coarser.
    pub coarser: Vec3,
}

/// How far history is wanted, before it is known whether it fits: 1 if it is sharper, a share if it is as good, 0 if coarser.
#[inline]
pub fn wanted(lod: f32, history_lod: f32, p: &SmrParams) -> (f32, f32) {
    let sharper = ((lod - history_lod) / p.quality_width).clamp(0.0, 1.0);
    let coarser = ((history_lod - lod) / 0.25).clamp(0.0, 1.0);
    (sharper, sharper + (1.0 - sharper) * p.accumulate * lod.min(1.0) * (1.0 - coarser))
}

/// The shown colour and its level of detail. `candidate_coarser` is the candidate one level coarser.
#[inline]
pub fn decide(e: &Evidence, candidate_coarser: Vec3, p: &SmrParams) -> (Vec3, f32, f32) {
    let (sharper, want) = wanted(e.lod, e.history_lod, p);
    let mut contrast = difference(e.matched, e.coarser);
    let mut d = difference(e.seen, e.matched);
    let mut gain = Vec3::ONE;
    let threshold = p.relight_from + p.relight_contrast * contrast;
    let changed = smooth_step(threshold, 2.0 * threshold, d);
    if changed > 0.0 {
        let ratio = ((candidate_coarser + 0.002) / (e.coarser + 0.002)).clamp(Vec3::splat(0.2), Vec3::splat(5.0));
        let away = (ratio - Vec3::ONE).abs();
        let amount = |a: f32| changed * smooth_step(0.05, 0.15, a);
        let k = Vec3::ONE + (ratio - Vec3::ONE) * Vec3::new(amount(away.x), amount(away.y), amount(away.z));
        let relit = difference(e.seen, k * e.matched);
        if relit < d {
            d = relit;
            gain = k;
            contrast *= ((k.x + k.y + k.z) * (1.0 / 3.0)).sqrt();
        }
    }
    let tolerance = p.accumulate_tolerance + (1.0 - p.accumulate_tolerance) * sharper;
    let low = tolerance * (p.gate_from + p.gate_contrast * contrast);
    let high = tolerance * (p.gate_to + p.gate_contrast * contrast);
    let share = (1.0 - smooth_step(low, high, d)) * want;
    let shown = e.candidate * (1.0 - share) + (gain * e.history) * share;
    let lod = if sharper > 0.0 {
        (e.history_lod + (e.lod - e.history_lod) * (1.0 - sharper * share / want)).min(e.lod)
    } else {
        e.lod
    };
    (shown, lod, share)
}
