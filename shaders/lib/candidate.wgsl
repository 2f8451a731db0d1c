//#use approx
//#use color
//#use noise
//#use pack
//#use sanitize
//#use reconstruction
// Twin of src/kernel/candidate.rs, which documents the functions.

const SAMPLE_RELATIVE: f32 = 0.05;
const OTHER_SURFACE: f32 = 1e-3;
const BY_NEIGHBOURS: f32 = 1e-3;
const NO_PX2: f32 = 1e30;
const BESIDE_PX2: f32 = 2.0;

// `codes_between` of the samples that are interpolated for a pixel.
fn sample_codes(disparity_now: f32) -> vec2u {
    return codes_between(disparity_now, 1.0f - SAMPLE_RELATIVE, 1.0f / (1.0f - SAMPLE_RELATIVE));
}

// Weight of a sample at a squared distance in pixels from a pixel: 1 for the pixel's own.
fn distance_weight(px2: f32) -> f32 {
    return 1.0 / max(px2, 1.0);
}

// Weight of a sample at a squared distance in pixels. `same`: whether it shows the pixel's surface.
fn sample_weight(px2: f32, same: bool) -> f32 {
    return distance_weight(px2) * select(OTHER_SURFACE, 1.0, same);
}

// Level of detail in log2 pixels of a candidate at distance `px` from the nearest sample of a pattern of level
// `coarsest`: 0 at the sample's own pixel.
fn candidate_level(px: f32, coarsest: f32) -> f32 {
    return min(ln_approx(1.0 + 2.0 * px) * LOG2_E, coarsest);
}

// Sums over the samples around a pixel. `known`: weights of gains and fits; `beside`: color of the nearest sample of
// the pixel's surface.
struct SampleSums {
    color: vec3f,
    alpha: f32,
    weight: f32,
    gains: vec3f,
    fit: f32,
    known: f32,
    lowest: vec3f,
    highest: vec3f,
    beside: vec3f,
    nearest_px2: f32,
}

// Sums over no sample.
fn no_samples() -> SampleSums {
    let zero = vec3f(0.0);
    return SampleSums(zero, 0.0, 0.0, zero, 0.0, 0.0, vec3f(MAX_HALF), zero, zero, NO_PX2);
}

// Adds a sample at a squared distance in pixels, with its `sample_weight` and the rectification at it.
fn add_sample(s: SampleSums, c: vec3f, alpha: f32, r: Rectification, weight: f32, px2: f32, same: bool) -> SampleSums {
    let known = weight * select(BY_NEIGHBOURS, 1.0, r.is_own);
    let is_nearer = same && px2 < s.nearest_px2;
    return SampleSums(
        s.color + c * weight,
        s.alpha + alpha * weight,
        s.weight + weight,
        s.gains + r.gains * known,
        s.fit + r.fit * known,
        s.known + known,
        min(s.lowest, c),
        max(s.highest, c),
        select(s.beside, c, is_nearer),
        select(s.nearest_px2, px2, is_nearer),
    );
}

// Whether a sample shows the pixel's surface.
fn has_surface(s: SampleSums) -> bool {
    return s.nearest_px2 < NO_PX2;
}

// Whether a sample of the pixel's surface is beside the pixel.
fn is_beside(s: SampleSums) -> bool {
    return s.nearest_px2 <= BESIDE_PX2;
}

struct SampleMean {
    color: vec3f,
    alpha: f32,
    lod: f32,
    gains: vec3f,
    fit: f32,
}

// Mean of at least one sample, of a pattern of level `coarsest`.
fn sample_mean(s: SampleSums, coarsest: f32) -> SampleMean {
    let inverse = 1.0 / s.weight;
    let known = 1.0 / s.known;
    let lod = select(coarsest + 1.0, candidate_level(sqrt(s.nearest_px2), coarsest), has_surface(s));
    return SampleMean(s.color * inverse, s.alpha * inverse, lod, s.gains * known, s.fit * known);
}

// Sums over the noisy samples around a pixel: colors and variances of one sample, times weights; and weights.
struct NoisySums {
    sum: vec4f,
    weight: f32,
}

// Adds a noisy sample at a squared distance in pixels.
fn add_noisy(s: NoisySums, c: vec3f, n: Noise, px2: f32) -> NoisySums {
    let weight = noisy_share(n.samples, px2);
    return NoisySums(s.sum + vec4f(c, n.variance) * weight, s.weight + weight);
}

// Mean color, and mean variance of one sample.
fn noisy_mean(s: NoisySums) -> vec4f {
    return s.sum * (1.0 / s.weight);
}

struct Borrowed {
    color: vec3f,
    noise: Noise,
}

// The noisy sample of a pixel whose history is a mean of `past` samples, with its share of the mean `around` it.
fn borrow_around(c: vec3f, n: Noise, around: vec4f, past: f32) -> Borrowed {
    let share = borrowed(past, Noise(n.samples, around.w), luma(around.xyz));
    let variance = n.variance + (around.w - n.variance) * share;
    return Borrowed(c + (around.xyz - c) * share, Noise(n.samples, variance));
}
