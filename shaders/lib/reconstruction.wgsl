//#use color
//#use depth
//#use lod
//#use stored_sample
//#use noise
//#use approx
// Twin of src/kernel/reconstruction.rs, which documents the functions.

const LIGHT_RELATIVE: f32 = 0.1;
const STILL_ERROR: f32 = 0.3;
const MOVED_ERROR: f32 = 0.6;
const CONTRAST_ERROR: f32 = 0.375;
const GATE_ERROR: f32 = 0.7;
const RELIGHT_ERRORS: f32 = 2.5;
const PLAIN_DEVIATION: f32 = 8.0;
const AGREE_ERRORS: f32 = 4.0;
const AGREE_ERROR: f32 = 0.8;
const FIT_ERRORS: vec2f = vec2f(2.0, 4.0);
const SAMPLE_GAIN: vec2f = vec2f(0.2, 5.0);
const LOD_LOSS_PER_STOP: vec2f = vec2f(4.0, 1.0);
const MOST_DEVIATION: f32 = 63.75;
const DEVIATION_STEPS: f32 = 4.0;
const FINER_WIDTH: f32 = 0.25;
const OVERSHOOT: f32 = 0.25;
const ACCUMULATE: f32 = 0.5;
const KEEP_SHARE: f32 = 0.9;
const MEAN_ERRORS: f32 = 3.0;
const BLURRED_FRAMES: f32 = 8.0;
const STAY_SHARE: f32 = 0.5;
const AGREED: vec2f = vec2f(0.6, 6.0);
const AGAINST: vec2f = vec2f(0.5, 0.25);
const RELIT_ERRORS: f32 = 0.8;
const BLOCK_ERRORS: f32 = 0.7;
const BLOCK_QUADS: u32 = 16u;
const BLOCK_MAJORITY: f32 = 0.6;
const BLOCK_LEAST: f32 = 24.0;
const BLOCK_SHARED: f32 = 0.0625;

// `error` is negative without history or without a usable sample.
struct Observation {
    sampled: vec3f,
    history: vec3f,
    error: f32,
    confidence: f32,
    deviation: f32,
}

// No comparison.
fn no_observation() -> Observation {
    return Observation(vec3f(0.0), vec3f(0.0), -1.0, 0.0, 0.0);
}

// Observation in two words: history's color; expected error as a half, confidence and deviation.
fn pack_observation(o: Observation) -> vec2u {
    return vec2u(pack_color(o.history), half_bits(o.error) | (pack_known(o.confidence, o.deviation) << 16u));
}

// Inverse of `pack_observation`, with the sample's color.
fn unpack_observation(words: vec2u, sampled: vec3f) -> Observation {
    let known = words.y >> 16u;
    let error = half_value(words.y);
    return Observation(sampled, unpack_color(words.x), error, known_confidence(known), known_deviation(known));
}

// Whether packed words are a comparison.
fn is_observed(words: vec2u) -> bool {
    return half_value(words.y) >= 0.0;
}

// Confidence and deviation of an observation, in sixteen bits.
fn pack_known(confidence: f32, deviation: f32) -> u32 {
    return u32(confidence * 255.0 + 0.5) | (u32(min(deviation, MOST_DEVIATION) * DEVIATION_STEPS + 0.5) << 8u);
}

// Confidence of `pack_known`.
fn known_confidence(word: u32) -> f32 {
    return f32(word & 255u) * (1.0f / 255.0);
}

// Deviation of `pack_known`.
fn known_deviation(word: u32) -> f32 {
    return f32((word >> 8u) & 255u) * (1.0f / DEVIATION_STEPS);
}

// Expected difference between a sample and history of level of detail `lod` with local contrast `contrast`.
fn expected_error(lod: f32, contrast: f32, moved: bool) -> f32 {
    let coarse = clamp(lod, 0.0, 1.0);
    let by_motion = select(0.0, CONTRAST_ERROR, moved);
    return select(STILL_ERROR, MOVED_ERROR, moved) + contrast * (by_motion + CONTRAST_ERROR * coarse);
}

// Confidence in a difference from history at level of detail `lod`, in [0, 1].
fn lod_confidence(lod: f32) -> f32 {
    return 1.0 - clamp(lod, 0.0, 1.0);
}

// As `lod_confidence`, for noisy samples at a luma.
fn noisy_lod_confidence(lod: f32, past: Noise, around: f32) -> f32 {
    return max(lod_confidence(lod), noise_visibility(past, around));
}

// Gain for one channel, limited.
fn ratio(observed: f32, predicted: f32) -> f32 {
    return clamp((observed + DARK) / (predicted + DARK), SAMPLE_GAIN.x, SAMPLE_GAIN.y);
}

// Per-channel ratios of two colors, limited.
fn ratios(observed: vec3f, predicted: vec3f) -> vec3f {
    return vec3f(ratio(observed.x, predicted.x), ratio(observed.y, predicted.y), ratio(observed.z, predicted.z));
}

// Weight of a neighbour's observation in a sample's estimate: smaller if it contradicts the sample's own gain, as at
// the edge of a shadow.
fn agreement(own: Observation, other: Observation, spatial: f32) -> f32 {
    let difference = root_difference(other.sampled, ratios(own.sampled, own.history) * other.history);
    let errors = min(difference, 1e6) / (AGREE_ERRORS * (own.error + other.error) + AGREE_ERROR);
    return (spatial * other.confidence) / (1.0 + errors * errors);
}

struct ObservedAround {
    sampled: vec3f,
    history: vec3f,
    error: f32,
    deviation: f32,
    weight: f32,
    squared: f32,
    spatial: f32,
    known: f32,
}

// Adds an observation of `weight`.
fn add_observation(a: ObservedAround, o: Observation, weight: f32, spatial: f32) -> ObservedAround {
    return ObservedAround(
        a.sampled + o.sampled * weight,
        a.history + o.history * weight,
        a.error + o.error * weight,
        a.deviation + o.deviation * weight,
        a.weight + weight,
        a.squared + weight * weight,
        a.spatial + spatial,
        a.known + spatial * o.confidence,
    );
}

// Sums over no observation.
fn none_around() -> ObservedAround {
    return ObservedAround(vec3f(0.0), vec3f(0.0), 0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
}

// Sums over the observations of both.
fn add_around(a: ObservedAround, b: ObservedAround) -> ObservedAround {
    return ObservedAround(
        a.sampled + b.sampled,
        a.history + b.history,
        a.error + b.error,
        a.deviation + b.deviation,
        a.weight + b.weight,
        a.squared + b.squared,
        a.spatial + b.spatial,
        a.known + b.known,
    );
}

// Mean of the observations at the pixels of a quad, from their sums with weights of 1, and from the sum of their
// confidences; none without any.
fn mean_observation(a: ObservedAround, confidence: f32) -> Observation {
    let inverse = 1.0 / max(a.weight, 1.0);
    let error = select(a.error * inverse, -1.0, a.weight == 0.0);
    return Observation(a.sampled * inverse, a.history * inverse, error, confidence * inverse, a.deviation * inverse);
}

// Weight by position of a quad around another one. `distance2` and `least`: squared distances in quads, its own and the
// smallest of those around.
fn spatial_weight(distance2: f32, least: f32) -> f32 {
    return 1.0 / (1.0 + distance2 / least);
}

// Weight of an observation around a quad with the observation `own`, from its weight by position.
fn neighbour_weight(own: Observation, other: Observation, spatial: f32) -> f32 {
    var weight = spatial * other.confidence;
    if own.error >= 0.0 {
        weight = agreement(own, other, spatial);
    }
    return weight;
}

// Expected difference of one sample from history around it.
fn mean_error(a: ObservedAround) -> f32 {
    return a.error * (1.0 / a.weight);
}

// Degree to which the samples around agree on a gain, in [0, 1].
fn agreed(a: ObservedAround) -> f32 {
    return clamp((a.weight - a.known * AGREED.x) * (AGREED.y / max(a.known, 1e-6)), 0.0, 1.0);
}

// Degree to which the jitter cannot explain a mean difference, in [0, 1].
fn not_jitter(a: ObservedAround, difference: f32) -> f32 {
    let beyond = (a.deviation - PLAIN_DEVIATION * a.weight) * (1.0 / a.weight);
    return select(1.0, smooth_step(FIT_ERRORS.x, FIT_ERRORS.y, difference / max(beyond, 1e-3)), beyond > 0.0);
}

// Gain of the light around a sample: the ratio of the means of samples and of history at the same pixels, blended to 1
// where chance explains the difference of the means, or where other samples contradict it (`agreed`).
fn relight(a: ObservedAround, error: f32) -> vec3f {
    if a.weight < 1e-6 {
        return vec3f(1.0);
    }
    let inverse = 1.0 / a.weight;
    let sampled = a.sampled * inverse;
    let history = a.history * inverse;
    let difference = root_difference(sampled, history);
    // The standard error of a weighted mean.
    let start = (error * (sqrt(a.squared) * inverse)) * RELIGHT_ERRORS;
    let changed = (smooth_step(start, start, difference) * not_jitter(a, difference)) * agreed(a);
    // A share of 1 gives the ratio bit for bit.
    return ratios(sampled, history) * changed + (1.0 - changed);
}

// Weight of an observation in the sums for `block_gain`: its confidence, divided by its largest channel above white.
fn block_weight(o: Observation) -> f32 {
    let largest = max(o.sampled, o.history);
    return o.confidence / max(max(largest.x, largest.y), max(largest.z, 1.0));
}

// Gain of the light in a block of quads, from all comparisons in it. Errors that its samples have alike do not fall
// with their number.
fn block_gain(a: ObservedAround, error: f32) -> vec3f {
    var block = a;
    block.squared += BLOCK_SHARED * (a.weight * a.weight);
    return relight(block, error);
}

// Difference between a sample and history after a gain, in expected errors.
fn errors_left(o: Observation, gains: vec3f) -> f32 {
    return root_difference(o.sampled, gains * o.history) / (o.error + GATE_ERROR);
}

// Vote of a sample on the gain of its block: its confidence if the gain brings history nearer to the sample, and 1.
fn block_vote(o: Observation, gains: vec3f) -> vec2f {
    let is_nearer = errors_left(o, gains) < errors_left(o, vec3f(1.0));
    return vec2f(select(0.0, o.confidence, is_nearer), 1.0);
}

// Whether most samples of a block are for its gain, and whether there are enough.
fn has_majority(votes: vec2f) -> bool {
    return votes.y >= BLOCK_LEAST && votes.x >= votes.y * BLOCK_MAJORITY;
}

// Degree to which history fits the samples, in [0, 1], from the mean of `errors_left`.
fn fit(errors: f32, confidence: f32) -> f32 {
    return 1.0 - confidence * smooth_step(FIT_ERRORS.x, FIT_ERRORS.y, errors);
}

// Whether a gain is used: whether it leaves less than the errors `without` it. Both are sums of `errors_left`.
fn gain_helps(left: f32, without: f32, is_of_block: bool) -> bool {
    return left <= without * select(RELIT_ERRORS, BLOCK_ERRORS, is_of_block);
}

// Degree to which history after a gain fits at a sample's own pixel, in [0, 1].
fn center_fit(own: Observation, gains: vec3f) -> f32 {
    return fit(errors_left(own, gains), own.confidence);
}

// Vote of another sample on whether history fits, for `fit_by_votes`: its weight if it contradicts history, and its
// weight.
fn vote(o: Observation, errors: f32, spatial: f32) -> vec2f {
    let weight = spatial * o.confidence;
    return vec2f(smooth_step(FIT_ERRORS.x, FIT_ERRORS.y, errors) * weight, weight);
}

// Fit of history around a sample by the majority of the other samples, in [0, 1].
fn fit_by_votes(a: ObservedAround, votes: vec2f, own: f32) -> f32 {
    let against = smooth_step(AGAINST.x, AGAINST.y, votes.x / max(votes.y, 1e-6));
    return max(1.0 - min(a.known / a.spatial, 1.0) * against, own);
}

// Degree to which history fits around a sample, in [0, 1].
fn fit_around(a: ObservedAround, left: f32, by_others: f32) -> f32 {
    let by_own = fit(left / a.weight, min(a.weight / a.spatial, 1.0));
    let share = agreed(a);
    return by_own * share + by_others * (1.0 - share);
}

// As `fit`, for noisy samples, from the difference of the means of samples and of history.
fn mean_fit(a: ObservedAround, confidence: f32) -> f32 {
    let inverse = 1.0 / a.weight;
    let start = ((a.error * inverse) * (sqrt(a.squared) * inverse)) * MEAN_ERRORS;
    return 1.0 - confidence * smooth_step(start, start, root_difference(a.sampled * inverse, a.history * inverse));
}

// As `fit_around`, for noisy samples.
fn noisy_fit_around(a: ObservedAround, left: f32) -> f32 {
    let confidence = min(a.weight / a.spatial, 1.0);
    return min(fit(left / a.weight, confidence), mean_fit(a, confidence));
}

struct Rectification {
    gains: vec3f,
    fit: f32,
    center_fit: f32,
    is_own: bool,
}

struct QuadRectification {
    gains: vec3f,
    fit: f32,
    center_fits: vec4f,
    is_own: bool,
    disparities: vec4f,
}

// Four words: gain (`pack_color`); fit in 256ths in bits 0 to 8, `is_own` in bit 9, own fits in 16ths from bit 10 on;
// disparities (`disparity_code`).
fn pack_rectification(r: QuadRectification) -> vec4u {
    let own = vec4u(r.center_fits * 16.0 + 0.5) << vec4u(10u, 15u, 20u, 25u);
    let fits = u32(0.5 + r.fit * 256.0) | select(0u, 512u, r.is_own) | own.x | own.y | own.z | own.w;
    let first = disparity_code(r.disparities.x) | (disparity_code(r.disparities.y) << 16u);
    let second = disparity_code(r.disparities.z) | (disparity_code(r.disparities.w) << 16u);
    return vec4u(pack_color(r.gains), fits, first, second);
}

// Estimate at pixel `i` of a quad.
fn unpack_rectification(words: vec4u, i: u32) -> Rectification {
    return Rectification(
        unpack_color(words.x),
        f32(words.y & 511u) * (1.0f / 256.0),
        f32((words.y >> (10u + 5u * i)) & 31u) * (1.0f / 16.0),
        ((words.y >> 9u) & 1u) != 0u,
    );
}

// Word for `has_code` of pixel `i` of a quad.
fn quad_code(words: vec4u, i: u32) -> u32 {
    let pair = select(words.z, words.w, i >= 2u);
    return select(pair & 0xffff0000u, pair << 16u, (i & 1u) == 0u);
}

struct Reconstruction {
    candidate: vec3f,
    lod: f32,
    lowest: vec3f,
    highest: vec3f,
    history: vec3f,
    history_lod: f32,
    nearest: StoredSample,
    lod_loss_per_stop: f32,
    gains: vec3f,
    fit: f32,
    trust: f32,
    accumulate: f32,
}

struct Reconstructed {
    color: vec3f,
    stored: StoredSample,
    share: f32,
    keeps_nearest: bool,
    stored_share: f32,
}

// Alpha to show and alpha to store beside a result: blended as its color is, without the gain.
fn result_alpha(r: Reconstructed, candidate: f32, history: f32, nearest: f32) -> vec2f {
    let old = select(history, nearest, r.keeps_nearest);
    // A share of 1 gives the alpha bit for bit.
    let shown = candidate * (1.0 - r.share) + history * r.share;
    let stored = candidate * (1.0 - r.stored_share) + old * r.stored_share;
    return vec2f(shown, stored);
}

// Levels of detail that history loses when light doubles.
fn lod_loss_per_stop(moved: bool, means: bool) -> f32 {
    return select(select(LOD_LOSS_PER_STOP.y, 0.0, means), LOD_LOSS_PER_STOP.x, moved);
}

// Relit color.
fn relit(c: vec3f, gains: vec3f, lowest: vec3f, highest: vec3f) -> vec3f {
    return min(c * gains, max(c, highest + (highest - lowest) * OVERSHOOT));
}

// Blends history into the candidate, and chooses the sample to store.
fn reconstruct(r: Reconstruction) -> Reconstructed {
    let acceptance = r.fit * r.trust;
    var lost_lod = 0.0;
    if any(r.gains != vec3f(1.0)) {
        let mean = (r.gains.x + r.gains.y + r.gains.z) * (1.0f / 3.0f);
        lost_lod = abs(ln_approx(mean) * LOG2_E) * r.lod_loss_per_stop;
    }
    let history_lod = r.history_lod + lost_lod;
    let finer = clamp((r.lod - history_lod) / FINER_WIDTH, 0.0, 1.0);
    let coarser = clamp((history_lod - r.lod) / COARSER_WIDTH, 0.0, 1.0);
    let share = (finer + (((1.0 - finer) * (1.0 - coarser)) * (r.accumulate * ACCUMULATE))) * acceptance;
    let history = relit(r.history, r.gains, r.lowest, r.highest);
    var shown = history;
    if share != 1.0 {
        shown = r.candidate + (history - r.candidate) * share;
    }
    let lost = 1.0 - finer * acceptance;
    let near = max(abs(r.nearest.place_px.x), abs(r.nearest.place_px.y)) <= FARTHEST_PX;
    let kept_lod = r.nearest.lod + lost_lod;
    if share >= KEEP_SHARE && near && kept_lod < r.lod {
        let kept_color = relit(r.nearest.color, r.gains, r.lowest, r.highest);
        let lod = kept_lod + (r.lod - kept_lod) * lost;
        let kept = StoredSample(kept_color, lod, r.nearest.disparity, r.nearest.place_px);
        return Reconstructed(shown, kept, share, true, 1.0);
    }
    let lod = select(r.lod, history_lod + (r.lod - history_lod) * lost, finer > 0.0);
    return Reconstructed(shown, StoredSample(shown, lod, r.nearest.disparity, vec2f(0.0)), share, false, share);
}

struct Accumulated {
    result: Reconstructed,
    noise: Noise,
}

// As `reconstruct`, for noisy samples: a mean of history and candidate by their numbers of samples.
fn accumulate(r: Reconstruction, past: Noise, candidate: Noise) -> Accumulated {
    let acceptance = r.fit * r.trust;
    let bright = luma(r.history);
    // Samples farther from this pixel count less.
    let now = Noise(candidate.samples * exp2_approx(-r.lod), candidate.variance);
    let certain = noise_confidence(past, bright);
    let sharp = noise_confidence(Noise(now.samples, past.variance), bright);
    let finer = clamp((r.lod - r.history_lod) / FINER_WIDTH, 0.0, 1.0) * certain;
    let blurred = clamp((r.history_lod - r.lod) / COARSER_WIDTH, 0.0, 1.0);
    let most = min(past.samples, BLURRED_FRAMES * now.samples);
    let known = Noise(past.samples + (most - past.samples) * blurred, past.variance);
    let alike = (1.0 - finer) * (1.0 - blurred * sharp);
    let share = (finer + alike * history_share(known, now, r.accumulate)) * acceptance;
    var shown = r.history;
    if share != 1.0 {
        shown = r.candidate + (r.history - r.candidate) * share;
    }
    let lod = r.lod + (r.history_lod - r.lod) * share;
    let noise = noise_after(past, now, share, finer * acceptance);
    let near = max(abs(r.nearest.place_px.x), abs(r.nearest.place_px.y)) <= FARTHEST_PX;
    if near && share >= STAY_SHARE {
        let kept = r.candidate + (r.nearest.color - r.candidate) * share;
        let next = StoredSample(kept, lod, r.nearest.disparity, r.nearest.place_px);
        return Accumulated(Reconstructed(shown, next, share, true, share), noise);
    }
    let next = StoredSample(shown, lod, r.nearest.disparity, vec2f(0.0));
    return Accumulated(Reconstructed(shown, next, share, false, share), noise);
}
