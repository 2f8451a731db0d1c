//#use approx
//#use surface
//#use color
// Twin of src/kernel/smr.rs, which explains the constants.

const QUALITY_WIDTH: f32 = 0.1;
const GATE: vec2f = vec2f(3.0, 6.0);
const RELIGHT: vec2f = vec2f(1.5, 0.5);
const RELIGHT_BLOCKS: vec2f = vec2f(8.0, 0.5);
const RELIT: f32 = 1.0;
const RELIT_BLOCKS: f32 = 0.5;
const CORRECTION: f32 = 0.2;
const CORRECTION_BLOCKS: f32 = 0.1;
const ALIKE_CONTRAST: f32 = 0.5;
const GAIN: vec2f = vec2f(0.2, 5.0);
const LEAST_LOST_LOD: f32 = 0.5 / LOD_STEPS;
const MIDDLE: f32 = 0.5;
const LEAST_BRIGHTNESS: f32 = 0x1p-14;

struct SmrParams {
    accumulate: f32,
    accumulate_tolerance: f32,
    tolerance: f32,
    blocks: bool,
    relight: bool,
    noisy: bool,
}

// As `root_difference`, of a color and of history, which is at least 0.
fn past_difference(x: vec3f, past: vec3f) -> f32 {
    return distance_of_roots(roots(x), past_roots(past));
}

// Contrast of history: `root_difference` of two of its levels.
fn past_contrast(level: vec3f, next_level: vec3f) -> f32 {
    return distance_of_roots(past_roots(level), past_roots(next_level));
}

// Unit of the colors that the gate compares, linear: twice the largest channel of candidate and history.
fn brightness_unit(compared: vec3f, matched: vec3f, exposure: f32) -> f32 {
    let now = max(max(compared.x, compared.y), compared.z);
    let then = max(max(matched.x, matched.y), matched.z);
    return max(max(now, then * exposure), LEAST_BRIGHTNESS) * (1.0f / MIDDLE);
}

struct ReuseWeight {
    finer: f32,
    share: f32,
}

// Reuse weight of history at level of detail `history_lod` for a candidate at `lod`.
fn reuse_weight(lod: f32, history_lod: f32, accumulate: f32, noisy: bool, confidence: vec2f) -> ReuseWeight {
    let finer = clamp((lod - history_lod) * (1.0f / QUALITY_WIDTH), 0.0, 1.0) * confidence.x;
    let coarser = clamp((history_lod - lod) / COARSER_WIDTH, 0.0, 1.0) * confidence.y;
    let alike = (1.0 - finer) * (1.0 - coarser);
    let calm = select(min(lod, 1.0), 1.0, noisy);
    return ReuseWeight(finer, finer + (alike * calm) * accumulate);
}

// Gain of relighting for one channel: observed by predicted color, blended to 1 where light did not change.
fn gain(observed: f32, predicted: f32, changed: f32) -> f32 {
    let ratio = clamp((observed + DARK) / (predicted + DARK), GAIN.x, GAIN.y);
    let share = changed * smooth_step(0.5, 1.0, 10.0 * abs(ratio - 1.0));
    return (1.0 - share) + ratio * share;
}

// The largest gain or the smallest one, whichever is farther from 1 by its logarithm.
fn strongest_gain(gains: vec3f) -> f32 {
    let least = min(min(gains.x, gains.y), gains.z);
    let most = max(max(gains.x, gains.y), gains.z);
    return select(most, least, least * most < 1.0);
}

// Difference at which relighting starts, in units of `root_difference`.
fn relight_from(contrast: f32, blocks: bool, noise: f32) -> f32 {
    let relight = select(RELIGHT, RELIGHT_BLOCKS, blocks);
    return (relight.x + relight.y * contrast) + noise;
}

// Whether history may be relit: only if it is finer than the candidate by more than storage rounds levels of detail.
fn may_relight(finer: f32, noisy: bool) -> bool {
    return finer == 1.0 || noisy;
}

// Whether candidate and history differ by more than contrast explains.
fn is_changed(compared: vec3f, matched: vec3f, level: vec3f, next_level: vec3f) -> bool {
    return past_difference(compared, matched) > relight_from(past_contrast(level, next_level), false, 0.0);
}

struct Evidence {
    candidate: vec3f,
    unit: f32,
    compared: vec3f,
    compared_coarser: vec3f,
    observed: vec3f,
    lod: f32,
    history: vec3f,
    history_lod: f32,
    resampled: bool,
    matched: vec3f,
    level: vec3f,
    next_level: vec3f,
    matched_coarser: vec3f,
    predicted: vec3f,
    trust: f32,
    noise: f32,
    confidence: vec2f,
}

struct Matched {
    color: vec3f,
    lod: f32,
    share: f32,
    fit: f32,
}

// Blends history into the candidate by its reuse weight and its fit, the degree to which it explains the candidate.
fn decide(e: Evidence, p: SmrParams) -> Matched {
    let reuse = reuse_weight(e.lod, e.history_lod, p.accumulate, p.noisy, e.confidence);
    var contrast = past_contrast(e.level, e.next_level);
    var d = past_difference(e.compared, e.matched);
    var k = vec3f(1.0);
    var lost_lod = 0.0;
    if p.relight {
        let low = relight_from(contrast, p.blocks, e.noise);
        let share = select(0.0, 1.0, may_relight(reuse.finer, p.noisy));
        let changed = smooth_step(low, low, past_difference(e.observed, e.predicted)) * share;
        let gains = vec3f(
            gain(e.observed.x, e.predicted.x, changed),
            gain(e.observed.y, e.predicted.y, changed),
            gain(e.observed.z, e.predicted.z, changed),
        );
        let unlit = past_difference(e.compared_coarser, e.matched_coarser);
        let relit = past_difference(e.compared_coarser, gains * e.matched_coarser);
        let strongest = strongest_gain(gains);
        let doublings = abs(ln_approx(strongest) * LOG2_E);
        let costs = select(doublings, LEAST_LOST_LOD, p.noisy) >= LEAST_LOST_LOD;
        if relit < unlit * select(RELIT, RELIT_BLOCKS, p.blocks) && costs {
            d = relit;
            k = gains;
            contrast *= sqrt(strongest);
            lost_lod = select(doublings, 0.0, p.noisy);
        }
    }
    let width = p.accumulate_tolerance + (1.0 - p.accumulate_tolerance) * reuse.finer;
    let slack = contrast * (ALIKE_CONTRAST + (1.0 - ALIKE_CONTRAST) * reuse.finer);
    let scale = select(1.0, 4.0, p.blocks);
    let keep = p.tolerance * (width * (GATE.x * scale) + slack);
    let fit = 1.0 - smooth_step(keep + e.noise, (p.tolerance * (GATE.y * scale)) * width, d);
    let acceptance = fit * e.trust;
    let share = acceptance * reuse.share;
    let correction = select(CORRECTION, CORRECTION_BLOCKS, p.blocks);
    let finer = select(0.0, reuse.finer, e.resampled && !p.noisy);
    let missed = (e.observed - k * e.predicted) * (correction * e.unit);
    let history = max(missed * finer + k * e.history, vec3f(0.0));
    let shown = select(e.candidate + (history - e.candidate) * share, history, share == 1.0);
    var lod = e.lod;
    if reuse.finer > 0.0 {
        lod = min((e.history_lod + (e.lod - e.history_lod) * (1.0 - reuse.finer * acceptance)) + lost_lod, e.lod);
    } else if p.noisy {
        lod = e.lod + max(e.history_lod - e.lod, 0.0) * share;
    }
    return Matched(shown, lod, share, fit);
}

// Mean of four texels of the mip chain: color times coverage, and coverage.
fn mip_mean(a: vec4f, b: vec4f, c: vec4f, d: vec4f) -> vec4f {
    return (a + b + c + d) * 0.25;
}

// Bilinear interpolation of the color of four texels of the mip chain, weighted by coverage.
fn mip_bilinear(top_left: vec4f, top_right: vec4f, bottom_left: vec4f, bottom_right: vec4f, fraction: vec2f) -> vec3f {
    let t = top_left + (top_right - top_left) * fraction.x;
    let b = bottom_left + (bottom_right - bottom_left) * fraction.x;
    let v = t + (b - t) * fraction.y;
    return v.xyz * (1.0 / max(v.w, 1e-3));
}
