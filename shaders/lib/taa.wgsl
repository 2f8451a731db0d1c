//#use color
// Twin of src/kernel/taa.rs, which explains the constants.

const LIMIT: f32 = 16.0;
const SETTLED: f32 = 2.0;
const JITTER: f32 = 1.0 / 9.0;
const SPREAD: f32 = 0.6;
const BOX_SIGMAS: vec2f = vec2f(2.0, 5.0);
const MAX_ROOT: f32 = 256.0;
const NO_CONFIDENCE_LOD: f32 = 8.0;

// Luma of the square roots of a linear color: Y of `to_ycocg`, at most that of the largest half.
fn root_luma(c: vec3f) -> f32 {
    return min(to_ycocg(c).x, MAX_ROOT);
}

// Confidence of a stored level of detail, in samples at the pixel.
fn confidence_of(lod: f32) -> f32 {
    let root = max(NO_CONFIDENCE_LOD - lod, 0.0) * 0.5;
    return root * root;
}

// Level of detail to store for a confidence.
fn lod_of(confidence: f32) -> f32 {
    return max(NO_CONFIDENCE_LOD - 2.0 * sqrt(confidence), 0.0);
}

// Largest confidence of history read at `fraction` (each in [0, 1)) between texels.
fn confidence_limit(fraction: vec2f, spread: f32) -> f32 {
    let x = 4.0 * (fraction.x * (1.0 - fraction.x));
    let y = 4.0 * (fraction.y * (1.0 - fraction.y));
    return 1.0 / (max(x, y) * spread + (1.0f / LIMIT));
}

// Degree to which history of a confidence is settled, in [0, 1].
fn settled(confidence: f32) -> f32 {
    return clamp((confidence - SETTLED) * (1.0f / SETTLED), 0.0, 1.0);
}

// Largest confidence of settled history, by the difference between its mean and the mean of the samples around it.
fn agreeing(sum: f32, squares: f32, past: f32, count: f32) -> f32 {
    let inverse = 1.0 / max(count, 1.0);
    let variance = (squares * count - sum * sum) * (inverse * inverse);
    let off = (sum - past) * inverse;
    return (max(variance, 0.0) * JITTER + (ROUNDING * ROUNDING)) * LIMIT / (off * off + (ROUNDING * ROUNDING));
}

// Share of the candidate in a mean with history of a confidence; at least `1 - trust`.
fn candidate_share(confidence: f32, trusted: f32) -> f32 {
    return max(1.0 / (confidence + 1.0), 1.0 - trusted);
}

// Half width of a clipping box in standard deviations.
fn box_sigmas(moving: f32, still: f32, confidence: f32) -> f32 {
    return moving + (still - moving) * settled(confidence);
}

// Output color: the candidate with a share of `alpha`, and clipped history with the rest.
fn blend_clipped(candidate: vec3f, history: vec3f, sum: vec3f, squares: vec3f, alpha: f32, confidence: f32) -> vec3f {
    let mean = sum * (1.0f / 9.0f);
    let variance = (squares * 9.0 - sum * sum) * (1.0f / 81.0f);
    let sigmas = box_sigmas(BOX_SIGMAS.x, BOX_SIGMAS.y, confidence);
    let extent = roots(variance) * sigmas + vec3f(ROUNDING);
    let clipped = roots_of_ycocg(clip_to_box(to_ycocg(history), mean, extent));
    let shown = clipped + (roots(candidate) - clipped) * alpha;
    return shown * shown;
}
