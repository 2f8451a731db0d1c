//#use lod
//#use noise
// Twin of src/kernel/mip_noise.rs, which explains the constants.

const NOISY_LEVELS: f32 = 3.0;
const COMPARED_CANDIDATES: f32 = 64.0;
const SIGMAS: f32 = 3.0;
const COARSER_FRAMES: f32 = 4.0;
const UNKNOWN: f32 = -1.0;

// Texel of level 0 of the candidates' mip chain: color, and variance of the pixel's luma.
fn candidate_texel(c: vec3f, usable: bool, n: Noise) -> vec4f {
    return select(vec4f(0.0, 0.0, 0.0, UNKNOWN), vec4f(c, n.variance / n.samples), usable);
}

// Mean of four texels of the candidates' mip chain, without unusable ones.
fn candidate_mean(a: vec4f, b: vec4f, c: vec4f, d: vec4f) -> vec4f {
    let w = select(vec4f(0.0), vec4f(1.0), vec4f(a.w, b.w, c.w, d.w) >= vec4f(0.0));
    let weight = ((w.x + w.y) + w.z) + w.w;
    let sum = ((a * w.x + b * w.y) + c * w.z) + d * w.w;
    return select(sum * (1.0 / max(weight, 1.0)), vec4f(0.0, 0.0, 0.0, UNKNOWN), weight == 0.0);
}

// Bilinear interpolation of color and variance of four texels of the candidates' mip chain, without unusable ones.
fn candidate_bilinear(
    top_left: vec4f,
    top_right: vec4f,
    bottom_left: vec4f,
    bottom_right: vec4f,
    fraction: vec2f,
) -> vec4f {
    let f = vec2f(1.0) - fraction;
    let shares = vec4f(f.x * f.y, fraction.x * f.y, f.x * fraction.y, fraction.x * fraction.y);
    let is_known = vec4f(top_left.w, top_right.w, bottom_left.w, bottom_right.w) >= vec4f(0.0);
    let w = select(vec4f(0.0), shares, is_known);
    let sum = ((top_left * w.x + top_right * w.y) + bottom_left * w.z) + bottom_right * w.w;
    return sum * (1.0 / max(((w.x + w.y) + w.z) + w.w, 1e-3));
}

// Largest difference of the compared means of candidates and of history that noise alone explains: three standard
// deviations at a luma, in units of `root_difference`.
fn noise_difference(history: Noise, candidate: Noise, around: f32, inverse_unit: f32) -> f32 {
    let sample_variance = pooled_variance(history, candidate);
    let inverse_samples = 1.0 / candidate.samples + 1.0 / max(history.samples, 1.0);
    let deviations = sqrt((sample_variance * (SIGMAS * SIGMAS / COMPARED_CANDIDATES)) * inverse_samples);
    return root_slope(around) * (deviations * inverse_unit);
}

// Noise of a history that is coarser than the candidate by `levels` of detail, with its number of samples limited to a
// few frames: such history is blurred, and new samples should soon outweigh it.
fn discount_coarser(history: Noise, candidate: Noise, levels: f32) -> Noise {
    let limited = min(history.samples, COARSER_FRAMES * candidate.samples);
    let t = clamp(levels / COARSER_WIDTH, 0.0, 1.0);
    return Noise(history.samples + (limited - history.samples) * t, history.variance);
}

// Largest difference of a candidate and a sample of equal noise that noise alone explains: three standard deviations at
// a luma, in units of `root_difference`.
fn sample_difference(candidate: Noise, around: f32) -> f32 {
    return root_slope(around) * sqrt(candidate.variance * ((2.0 * SIGMAS * SIGMAS) / candidate.samples));
}
