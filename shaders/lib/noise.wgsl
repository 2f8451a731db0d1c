//#use pack
//#use sanitize
//#use approx
//#use color
// Twin of src/kernel/noise.rs, which explains the constants.

const CONFIDENCE_FALLOFF: vec2f = vec2f(0.5, 1.0);
const BORROWED_SAMPLES: f32 = 16.0;
const MAX_ERROR: f32 = 255.0;
const MAX_SAMPLES: f32 = 32768.0;
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

// Share of an equally coarse history in the mean of history and candidate, by numbers of samples; at most `most`.
fn history_share(history: Noise, candidate: Noise, most: f32) -> f32 {
    return min(history.samples / (history.samples + candidate.samples), most);
}

// Pooled variance of one sample's luma, from history and from the candidate's neighbourhood.
fn pooled_variance(history: Noise, candidate: Noise) -> f32 {
    let all_samples = history.samples + candidate.samples;
    return (history.samples * history.variance + candidate.samples * candidate.variance) / all_samples;
}

// Derivative of `root_difference` by linear luma, at a luma: 50 over its square root, limited for dark colors.
fn root_slope(around: f32) -> f32 {
    return 50.0 / sqrt(max(around, 0.0) + DARK);
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

// Weight of a sample of `samples` paths at a squared distance in pixels, in a mean of samples around a pixel: its
// number of paths, less with distance.
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
