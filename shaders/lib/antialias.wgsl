//#use stored_sample
//#use reconstruction
//#use approx
//#use color
// Twin of src/kernel/antialias.rs, which explains the constants.

const MOST_SAMPLES: f32 = 29.0;
const MOST_PAST_MOVED: f32 = 3.0;
const MOVED_PER_PX: f32 = 4.0;
const MOST_PAST_EDGE: f32 = 5.0;
const BESIDE_WEIGHT: f32 = 0.35;
const CODES_PER_LOD: f32 = 7.0;
const CODES_PER_RUN: f32 = 48.0;
const DEVIATIONS: f32 = 6.0;
const ONE_SAMPLE_LOD: f32 = (2.0 * CODES_PER_RUN + 42.0) * (1.0f / CODES_PER_LOD);
const COARSE_CODE: f32 = 239.0;
const CODES_PER_COARSE_LOD: f32 = 2.5;
const COARSE_LOD: f32 = 0.2;
const DEVIATION_STEP: f32 = 1.25;
const SAMPLE_ERROR: f32 = 0.7;
const RELIT_SAMPLES: f32 = 3.0;
const RELIT_PER_GAIN: f32 = 10.0;
const MOST_DIFFERENCE: f32 = 200.0;
const CONTRADICTED: vec2f = vec2f(3.0, 2.0);
const LONGEST_RUN: f32 = 2.0;
const MOST_REGULAR_LEVEL: u32 = 2u;
const RUN_ERRORS: f32 = 0.7;
const RUN_DEVIATION: f32 = 2.5;
const RUN_KEPT: f32 = 0.5;
const RUN_SAMPLES: f32 = 3.0;
const CLIP_SIGMAS: f32 = 2.0;
const CLIP: f32 = 0.5;
const CLIP_COST: f32 = 10.0;
const NEARER_RELATIVE: f32 = 0.02;
const EDGE_RELATIVE: f32 = 0.05;
const ALONGSIDE_PX: f32 = 1.0;
const TOGETHER_PX: f32 = 0.25;
// A negative `lod`: empty.
struct Mean {
    lod: f32,
    samples: f32,
    deviation: f32,
    run: f32,
}

// Level of detail of a stored one.
fn mean_lod(stored: f32) -> f32 {
    let code = floor(stored * CODES_PER_LOD + 0.5);
    return select(max(code - COARSE_CODE, 0.0) * (1.0f / CODES_PER_COARSE_LOD), -1.0, stored < 0.0);
}

// Level, number of samples, deviation and run of a stored level of detail, which is a multiple of 1/7.
fn mean_of(stored: f32) -> Mean {
    let lod = mean_lod(stored);
    if lod != 0.0 {
        return Mean(lod, 1.0, 0.0, 0.0);
    }
    let whole = floor(stored * CODES_PER_LOD + 0.5);
    // 0.125 keeps quotients away from integers.
    let run = floor((whole + 0.125) * (1.0f / CODES_PER_RUN));
    let code = whole - run * CODES_PER_RUN;
    let number = floor((code + 0.125) * (1.0f / DEVIATIONS));
    return Mean(0.0, samples_of(7.0 - number), deviation_of(code - number * DEVIATIONS), run - LONGEST_RUN);
}

// Two draws in [0, 1) from the low bytes of random bits.
fn byte_draws(word: u32) -> vec2f {
    return (vec2f(f32(word & 255u), f32((word >> 8u) & 255u)) + 0.5) * (1.0f / 256.0);
}

// Number of samples of a step, 0 to 7.
fn samples_of(number: f32) -> f32 {
    return 1.0 + 0.5 * (number * (number + 1.0));
}

// Deviation of a step, 0 to 5.
fn deviation_of(number: f32) -> f32 {
    return DEVIATION_STEP * (number * (number + 1.0));
}

// Largest step whose triangular number, step (step + 1) / 2, is at most `v`.
fn step_below(v: f32) -> f32 {
    return floor(sqrt(v * 8.0 + 1.0) * 0.5 - 0.5);
}

// Level of detail to store for a mean; the inverse of `mean_of`.
fn stored_lod(m: Mean, draws: vec2f) -> f32 {
    if m.lod < 0.0 {
        return -1.0;
    }
    if m.lod > COARSE_LOD {
        return (COARSE_CODE + max(m.lod * CODES_PER_COARSE_LOD, 1.0)) * (1.0f / CODES_PER_LOD);
    }
    let samples = clamp(m.samples, 1.0, MOST_SAMPLES);
    let number = min(step_below(samples - 1.0), 6.0);
    let fewer = samples_of(number);
    let is_more = samples - fewer > (samples_of(number + 1.0) - fewer) * draws.x;
    let deviation = min(m.deviation, deviation_of(5.0));
    let steps = min(step_below(deviation * (0.5f / DEVIATION_STEP)), 4.0);
    let low = deviation_of(steps);
    let high = deviation_of(steps + 1.0);
    let is_higher = deviation * deviation - low * low > (high * high - low * low) * draws.y;
    let code = (7.0 - select(number, number + 1.0, is_more)) * DEVIATIONS + select(steps, steps + 1.0, is_higher);
    return ((m.run + LONGEST_RUN) * CODES_PER_RUN + code) * (1.0f / CODES_PER_LOD);
}

// Whether a pixel takes the history of a neighbour's nearer surface, so that silhouettes are means of both surfaces and
// move with the nearer one.
fn is_in_front(own: f32, neighbour: f32, own_motion: vec2f, motion: vec2f, full_rate: bool) -> bool {
    let difference = motion - own_motion;
    let alongside = max(abs(difference.x), abs(difference.y)) <= ALONGSIDE_PX;
    return neighbour > own * (1.0 + NEARER_RELATIVE) && neighbour > own && (full_rate || alongside);
}

// Whether the surfaces around a pixel move together: its own, the nearest, and the farthest.
fn move_together(own: vec2f, nearest: vec2f, farthest: vec2f) -> bool {
    let apart = max(max(abs(own - nearest), abs(own - farthest)), abs(nearest - farthest));
    return max(apart.x, apart.y) <= TOGETHER_PX;
}

// Whether a stored disparity belongs to a surface with a disparity from `farthest` to `nearest`.
fn is_of_surfaces(stored: f32, farthest: f32, nearest: f32) -> bool {
    let far = farthest * (1.0 - NEARER_RELATIVE);
    return stored >= far && stored * (1.0 - NEARER_RELATIVE) <= nearest;
}

// Whether a pixel's surface is narrower than two pixels along the line through two opposite neighbours: both show
// farther surfaces.
fn is_thin(own: f32, a: f32, b: f32) -> bool {
    return min(a, b) >= 0.0 && max(a, b) < own * (1.0 - NEARER_RELATIVE);
}

// Whether a silhouette crosses the line through two opposite neighbours of a pixel: their disparities and its own are
// not those of a plane, or one is unknown.
fn is_silhouette(own: f32, a: f32, b: f32) -> bool {
    return min(a, b) < 0.0 || abs((a + b) - 2.0 * own) > own * NEARER_RELATIVE;
}

// Whether the edge of a surface crosses that line: as `is_silhouette`, but only for larger differences, which are
// relative to the nearest of the three.
fn is_edge(own: f32, a: f32, b: f32) -> bool {
    return min(a, b) < 0.0 || abs((a + b) - 2.0 * own) > max(max(own, a), b) * EDGE_RELATIVE;
}

struct Near {
    sum: vec3f,
    squares: vec3f,
    count: f32,
    change: vec3f,
    weight: f32,
}

// The sums after one more sample.
fn add_near(n: Near, c: vec3f, own: vec3f, away_px: vec2f) -> Near {
    let v = to_ycocg(c);
    let weight = max(1.0 - abs(away_px.x), 0.0) * max(1.0 - abs(away_px.y), 0.0);
    return Near(n.sum + v, n.squares + v * v, n.count + 1.0, n.change + (c - own) * weight, n.weight + weight);
}

// Whether samples at a place in their pixels tell the color at the pixels' centres.
fn surrounds_centre(place_px: vec2f) -> bool {
    return max(abs(place_px.x), abs(place_px.y)) <= 0.5;
}

// Change from a pixel's own sample to the color at its centre, where `surrounds_centre` is true.
fn centred_change(near: Near) -> vec3f {
    return near.change * (1.0 / near.weight);
}

struct Clip {
    change: vec3f,
    kept: f32,
}

// Clip of history to the distribution of the samples around it; `near` must contain at least one sample.
fn clip(near: Near, history: vec3f) -> Clip {
    let inverse = 1.0 / near.count;
    let variance = (near.squares * near.count - near.sum * near.sum) * (inverse * inverse);
    let past = to_ycocg(history);
    let inside = clip_to_box(past, near.sum * inverse, roots(variance) * CLIP_SIGMAS + ROUNDING);
    let by = (inside - past) * CLIP;
    let moved = max(max(abs(by.x), abs(by.y)), abs(by.z));
    let outer = by.x - by.z;
    let change = vec3f(outer + by.y, by.x + by.z, outer - by.y);
    return Clip(change, 1.0 - min(moved * CLIP_COST / max(past.x, 1.0), 1.0));
}

// A color after a clip.
fn clipped(c: vec3f, change: vec3f) -> vec3f {
    if all(change == vec3f(0.0)) {
        return c;
    }
    let v = max(roots(c) + change, vec3f(0.0));
    return v * v;
}

// Adds the squared difference of a sample and history, times its weight, to a sum for `scattered_error`.
fn add_scatter(scatter: f32, o: Observation, weight: f32) -> f32 {
    let difference = min(root_difference(o.sampled, o.history), 1e6);
    return scatter + (difference * difference) * weight;
}

// Expected difference of one sample from history around it: the larger of the model's value and the standard deviation
// of the samples' differences.
fn scattered_error(a: ObservedAround, scatter: f32) -> f32 {
    let inverse = 1.0 / a.weight;
    let mean = root_difference(a.sampled * inverse, a.history * inverse);
    let variance = max(scatter * inverse - mean * mean, 0.0);
    return max(a.error * inverse, sqrt(variance));
}

// Expected difference between a sample and the mean at its pixel: the deviation of the samples in the mean, to which
// the local contrast adds one imagined sample.
fn expected_mean_error(past: Mean, contrast: f32, moved: bool) -> f32 {
    let prior = min(contrast, MOST_DIFFERENCE) * CONTRAST_ERROR;
    let own = past.deviation * past.deviation;
    let variance = (own * (past.samples - 1.0) + prior * prior) / past.samples;
    return (MOVED_ERROR + sqrt(select(max(variance, own), variance, moved))) + prior * clamp(past.lod, 0.0, 1.0);
}

// A mean whose run counts only where an even pattern visits the pixel.
fn with_regular_run(past: Mean, level: u32) -> Mean {
    return Mean(past.lod, past.samples, past.deviation, select(past.run, 0.0, level > MOST_REGULAR_LEVEL));
}

// Run of samples on one side of a mean, with one more; one near the mean ends it.
fn next_run(past: Mean, is_brighter: bool, difference: f32) -> f32 {
    let side = select(-1.0, 1.0, is_brighter);
    let is_near = past.deviation < RUN_DEVIATION || difference < past.deviation * RUN_ERRORS;
    let longer = clamp(past.run + side, -LONGEST_RUN, LONGEST_RUN);
    return select(select(side, longer, past.run * side > 0.0), 0.0, is_near);
}

// Number of samples that a mean of `count` keeps.
fn count_in_run(count: f32, past: Mean, next: f32) -> f32 {
    let goes_on = abs(past.run) == LONGEST_RUN && past.run == next;
    return select(count, min(count, max(count * RUN_KEPT, RUN_SAMPLES)), goes_on);
}

// Number of samples that a mean counts for after a gain: an estimate, which the next samples must correct.
fn relit_samples(samples: f32, gains: vec3f) -> f32 {
    let by = abs(gains - 1.0);
    let changed = min(max(max(by.x, by.y), by.z) * RELIT_PER_GAIN, 1.0);
    return samples * (1.0 - changed) + min(samples, RELIT_SAMPLES) * changed;
}

// Share of its samples that a mean keeps when `difference`, of a sample of its pixel, contradicts it.
fn kept_samples(error: f32, difference: f32) -> f32 {
    let errors = difference / (min(error, MOST_DIFFERENCE) + SAMPLE_ERROR);
    return 1.0 - smooth_step(CONTRADICTED.x, CONTRADICTED.y, errors);
}

struct Averaged {
    result: Reconstructed,
    mean: Mean,
}

// Largest number of samples that a mean counts for when a sample is added to it.
fn most_samples(place_px: vec2f, at_edge: bool) -> f32 {
    let away = max(abs(place_px.x), abs(place_px.y));
    let most = MOST_SAMPLES + (MOST_PAST_MOVED - MOST_SAMPLES) * min(away * MOVED_PER_PX, 1.0);
    return select(most, max(most, MOST_PAST_EDGE), at_edge);
}

// Mean of history, with the weight `share`, and of a sample at `place_px` in the pixel.
fn added(r: Reconstruction, place_px: vec2f, share: f32) -> Reconstructed {
    let past_px = r.nearest.place_px;
    let history = relit(r.history, r.gains, r.lowest, r.highest);
    let near = max(abs(past_px.x), abs(past_px.y)) <= FARTHEST_PX;
    var old = history;
    if near {
        old = relit(r.nearest.color, r.gains, r.lowest, r.highest);
    }
    let old_px = select(vec2f(0.0), past_px, near);
    let shown = r.candidate + (history - r.candidate) * share;
    let next = r.candidate + (old - r.candidate) * share;
    let next_px = place_px + (old_px - place_px) * share;
    let stored = StoredSample(next, 0.0, r.nearest.disparity, next_px);
    return Reconstructed(shown, stored, share, near, share);
}

// Mean of history and of the pixel's own sample, whose place in the pixel is `place_px`.
fn average(
    r: Reconstruction,
    past: Mean,
    place_px: vec2f,
    at_edge: bool,
    kept: f32,
    difference: f32,
    change: vec3f,
    is_centred: bool,
) -> Averaged {
    let acceptance = (r.fit * r.trust) * kept;
    let most = most_samples(r.nearest.place_px, at_edge);
    let accepted = select(min(relit_samples(past.samples, r.gains), most) * acceptance, 0.0, r.nearest.lod > 0.0);
    let run = next_run(past, luma(r.candidate) > luma(r.history), difference);
    let count = count_in_run(accepted, past, run);
    let share = count / (count + 1.0);
    let variance = (past.deviation * past.deviation + (difference * difference) * (1.0 - share)) * share;
    var sample = r;
    var sample_px = place_px;
    if is_centred {
        let moved = centred(r.candidate, place_px, change, count + 1.0);
        sample.candidate = moved.color;
        sample_px = moved.place_px;
    }
    return Averaged(added(sample, sample_px, share), Mean(0.0, count + 1.0, sqrt(variance), run));
}

struct Placed {
    color: vec3f,
    place_px: vec2f,
}

// The sample of a pixel of the fovea to add to a mean, which has `samples` with it: moved by a share of 1/n towards the
// color at the pixel's centre.
fn centred(c: vec3f, place_px: vec2f, change: vec3f, samples: f32) -> Placed {
    let share = 1.0 / samples;
    return Placed(c + change * share, place_px - place_px * share);
}

// At a moving edge, mean of history and of the candidate, a sample of the same surface beside the pixel: as if it were
// the pixel's own at `place_px`, with a smaller weight.
fn average_beside(r: Reconstruction, past: Mean, place_px: vec2f) -> Averaged {
    let acceptance = r.fit * r.trust;
    let samples = relit_samples(past.samples, r.gains);
    let count = min(samples, most_samples(r.nearest.place_px, true)) * acceptance;
    let share = count / (count + BESIDE_WEIGHT);
    let mean = Mean(0.0, samples * acceptance + (1.0 - acceptance), past.deviation, past.run);
    return Averaged(added(r, place_px, share), mean);
}

// The texel that is stored for a pixel without a sample of its own: history's, with fewer samples where it does not
// fit.
fn stored_mean(r: Reconstruction, result: Reconstructed, past: Mean) -> Averaged {
    let is_kept = result.stored.lod < COARSE_LOD && r.nearest.lod <= 0.0;
    let share = r.fit * r.trust;
    let left = relit_samples(past.samples, r.gains) * share + (1.0 - share);
    if !is_kept {
        return Averaged(result, Mean(0.0, 1.0, 0.0, 0.0));
    }
    return Averaged(result, Mean(past.lod, left, past.deviation, past.run));
}
