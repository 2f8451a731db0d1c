//#use pack
//#use sanitize
//#use approx
//#use color
//#use surface
// Twin of src/kernel/noise.rs, which explains the constants.

const NOISY_LEVELS: f32 = 3.0;
const COMPARED_CANDIDATES: f32 = 64.0;
const SIGMAS: f32 = 3.0;
const CONFIDENCE_FALLOFF: vec2f = vec2f(0.5, 1.0);
const BORROWED_SAMPLES: f32 = 16.0;
const COARSER_FRAMES: f32 = 4.0;
const MAX_ERROR: f32 = 255.0;
const MAX_SAMPLES: f32 = 32768.0;
const UNKNOWN: f32 = -1.0;
const LEAST_SPREAD: f32 = 1e-30;

struct Noise {
    samples: f32,
    variance: f32,
}

// Noise of a candidate from the frame's input: standard error of its luma, linear, and number of samples.
fn candidate_noise(input: vec2f) -> Noise {
    let error = min(positive(input.x), MAX_ERROR);
    let samples = clamp(positive(input.y), 1.0, MAX_SAMPLES);
    return Noise(samples, min((error * error) * samples, MAX_HALF));
}

// `x` if it is positive, infinity included, else 0.
fn positive(x: f32) -> f32 {
    return select(0.0, x, bitcast<u32>(x) <= 0x7f800000u);
}

// Packs a noise into one word of two halves: samples low, variance high.
fn pack_noise(n: Noise) -> u32 {
    return half_bits(n.samples) | (half_bits(n.variance) << 16u);
}

// Unpacks a noise.
fn unpack_noise(word: u32) -> Noise {
    return Noise(half_value(word & 0x7fffu), half_value((word >> 16u) & 0x7fffu));
}

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

// Share of an equally coarse history in the mean of history and candidate, by numbers of samples; at most `most`.
fn history_share(history: Noise, candidate: Noise, most: f32) -> f32 {
    return min(history.samples / (history.samples + candidate.samples), most);
}

// Pooled variance of one sample's luma, from history and from the candidate's neighbourhood.
fn pooled_variance(history: Noise, candidate: Noise) -> f32 {
    let all_samples = history.samples + candidate.samples;
    return (history.samples * history.variance + candidate.samples * candidate.variance) / all_samples;
}

// Derivative of `root_difference` by linear luma, at a luma: that of 100 times its square root, limited for dark
// colors.
fn root_slope(around: f32) -> f32 {
    return 50.0 / sqrt(max(around, 0.0) + DARK);
}

// Largest difference of the compared means of candidates and of history that noise alone explains: three standard
// deviations at a luma, in units of `root_difference`.
fn noise_difference(history: Noise, candidate: Noise, around: f32, inverse_unit: f32) -> f32 {
    let sample_variance = pooled_variance(history, candidate);
    let inverse_samples = 1.0 / candidate.samples + 1.0 / max(history.samples, 1.0);
    let deviations = sqrt((sample_variance * (SIGMAS * SIGMAS / COMPARED_CANDIDATES)) * inverse_samples);
    return root_slope(around) * (deviations * inverse_unit);
}

// Degree to which the noise of a color at a luma is visible, in [0, 1].
fn noise_visibility(history: Noise, around: f32) -> f32 {
    let error = root_slope(around) * sqrt(history.variance / max(history.samples, 1.0));
    return smooth_step(CONFIDENCE_FALLOFF.x, CONFIDENCE_FALLOFF.y, error);
}

// Noise confidence of a color at a luma, in [0, 1]: 1 where its standard error is invisible.
fn noise_confidence(history: Noise, around: f32) -> f32 {
    return 1.0 - noise_visibility(history, around);
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

// Expected difference, due to noise, of a sample and of history at its pixel: the standard deviation at a luma, in
// units of `root_difference`.
fn expected_noise(history: Noise, candidate: Noise, around: f32) -> f32 {
    let inverse_samples = 1.0 / candidate.samples + 1.0 / max(history.samples, 1.0);
    return root_slope(around) * sqrt(pooled_variance(history, candidate) * inverse_samples);
}

// Reduction of the squared error, due to noise, that one more sample is expected to bring, in squared root differences.
fn noise_need(history: Noise, around: f32) -> f32 {
    let samples = max(history.samples, 1.0);
    let slope = root_slope(around);
    return (slope * slope) * (history.variance / (samples * (samples + 1.0)));
}

// Weight of a sample of `samples` paths at a squared distance in pixels, in a mean of samples around a pixel: that of
// its paths, less with distance.
fn noisy_share(samples: f32, px2: f32) -> f32 {
    return samples / sqrt(max(px2, 1.0));
}

// Share that the mean of the samples around a pixel has in its own noisy sample, if its history is a mean of `past`
// samples.
fn borrowed(past: f32, own: Noise, around: f32) -> f32 {
    return (BORROWED_SAMPLES / (BORROWED_SAMPLES + past)) * noise_visibility(own, around);
}

struct NoiseSum {
    weight: f32,
    spread: f32,
    variance: f32,
}

// The sums after one more color.
fn add_noise(sum: NoiseSum, n: Noise, weight: f32) -> NoiseSum {
    return NoiseSum(sum.weight + weight, sum.spread + (weight * weight) / n.samples, sum.variance + n.variance * weight);
}

// Noise of the mean.
fn mean_noise(sum: NoiseSum) -> Noise {
    let samples = (sum.weight * sum.weight) / max(sum.spread, LEAST_SPREAD);
    return Noise(clamp(samples, 1.0, MAX_SAMPLES), sum.variance * (1.0 / max(sum.weight, LEAST_SPREAD)));
}

// Noise of the output color.
fn noise_after(history: Noise, candidate: Noise, share: f32, finer: f32) -> Noise {
    let together = candidate.samples / max(1.0 - share, 1.0 / MAX_SAMPLES);
    let samples = clamp(together + (history.samples - together) * finer, 1.0, MAX_SAMPLES);
    let variance = candidate.variance + (history.variance - candidate.variance) * share;
    return Noise(samples, clamp(variance, 0.0, MAX_HALF));
}

// Stored noise scaled to this frame's exposure; `ratio` is this frame's exposure divided by the previous frame's.
fn expose_noise(stored: Noise, ratio: f32) -> Noise {
    return Noise(stored.samples, min(stored.variance * ratio * ratio, MAX_HALF));
}
