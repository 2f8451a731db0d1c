//! Antialiasing of planned frames whose projection is jittered: a stored texel is the mean of the samples that fell
//! into its pixel, with the mean of their places.
//!
//! A jittered sample shows one point of its pixel, but the pixel should show the mean over its area. Camera motion
//! moves the place of a mean, like that of a sample ([`stored_sample`](super::stored_sample)), and the mean is not
//! resampled. Means of moving history contain few samples: the pixel's area lies elsewhere on the surface in each
//! frame, so that a long mean would blur.

use super::approx::smooth_step;
use super::color::{ROUNDING, clip_to_box, luma, root_difference, roots, to_ycocg};
use super::reconstruction::{
    CONTRAST_ERROR, MOVED_ERROR, Observation, ObservedAround, Reconstructed, Reconstruction, relit,
};
use super::stored_sample::{FARTHEST_PX, StoredSample};
use glam::{Vec2, Vec3};

/// Largest number of samples in a mean: one frame's sample has a weight of at least 1/30. A larger limit flickers less,
/// and is slower to follow changes that the gate does not detect.
pub const MOST_SAMPLES: f32 = 29.0;
/// The number of samples in a mean to which the next one is added is at most this where history lies a quarter of a
/// pixel or more from the pixel's centre. A larger limit blurs motion.
const MOST_PAST_MOVED: f32 = 3.0;
/// Inverse of the distance in pixels from the pixel's centre at which that limit is reached.
const MOVED_PER_PX: f32 = 4.0;
/// The limit is at least this at moving edges of surfaces.
const MOST_PAST_EDGE: f32 = 5.0;
/// Weight of a sample beside a pixel in the pixel's mean, where its own sample has 1.
const BESIDE_WEIGHT: f32 = 0.35;
/// Steps of a stored level of detail. The first 240 codes are means: five runs of eight numbers of samples, and six
/// deviations of each. The following ones are levels above 0.
const CODES_PER_LOD: f32 = 7.0;
/// Codes of a run.
const CODES_PER_RUN: f32 = 48.0;
/// Codes of a number of samples.
const DEVIATIONS: f32 = 6.0;
/// Stored level of detail of a mean of one sample.
pub const ONE_SAMPLE_LOD: f32 = (2.0 * CODES_PER_RUN + 42.0) * (1.0 / CODES_PER_LOD);
/// Code of a level of 0 if there were one.
const COARSE_CODE: f32 = 239.0;
/// Codes a level above 0.
const CODES_PER_COARSE_LOD: f32 = 2.5;
/// A texel of this level or more is coarse.
const COARSE_LOD: f32 = 0.2;
/// Smallest deviation above 0 that is stored, halved.
const DEVIATION_STEP: f32 = 1.25;
/// Added to the expected difference of a single sample.
const SAMPLE_ERROR: f32 = 0.7;
/// Number of samples that a mean counts for after a gain.
const RELIT_SAMPLES: f32 = 3.0;
/// Inverse of the change of a gain from 1 at which that limit is reached.
const RELIT_PER_GAIN: f32 = 10.0;
/// Largest difference between a sample and history that counts.
pub const MOST_DIFFERENCE: f32 = 200.0;
/// Differences between a sample and history, in expected ones, at which history starts to be contradicted, and width
/// over which it loses all its samples.
const CONTRADICTED: [f32; 2] = [3.0, 2.0];
/// Longest run of samples on one side of a mean that is stored. The jitter covers the pixel in thirds, so that three
/// samples on one side of an edge that stays are rare.
const LONGEST_RUN: f32 = 2.0;
/// Largest level of detail of a region with runs: an even pattern visits its pixels every 8 frames.
const MOST_REGULAR_LEVEL: u32 = 2;
/// Least difference of a sample in a run from the mean, in deviations of the mean.
const RUN_ERRORS: f32 = 0.7;
/// Least deviation of a mean with a run, in units of [`root_difference`].
const RUN_DEVIATION: f32 = 2.5;
/// Share of its samples that a mean keeps when a run goes on beyond the longest.
const RUN_KEPT: f32 = 0.5;
/// Least number of samples that it keeps.
const RUN_SAMPLES: f32 = 3.0;
/// Half width of the box of nine samples to which history is clipped at full rate, in standard deviations.
const CLIP_SIGMAS: f32 = 2.0;
/// Share of the clip that is applied, so that a thin feature is not lost at once if a frame misses it.
const CLIP: f32 = 0.5;
/// Cost of a clip: the share of its samples that a mean loses, per clip distance in units of the range from black to
/// white, or of the mean's own brightness if that is larger. A clip by a tenth costs all samples.
const CLIP_COST: f32 = 10.0;
/// Least relative difference of disparity at which a neighbour counts as another, nearer surface.
const NEARER_RELATIVE: f32 = 0.02;
/// Least second difference of disparity, relative to the nearest one, at the edge of a surface.
const EDGE_RELATIVE: f32 = 0.05;
/// Largest difference of motion, in pixels along an axis, at which a pixel outside the fovea takes the
/// history of a nearer surface beside it.
const ALONGSIDE_PX: f32 = 1.0;
/// Largest difference of motion, in pixels along an axis, at which the surfaces around a pixel move together, so that
/// history that mixes them stays in place.
const TOGETHER_PX: f32 = 0.25;

/// A stored texel. Empty texels stay empty.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mean {
    /// Level of detail; negative: empty.
    pub lod: f32,
    /// Number of samples, 1 to [`MOST_SAMPLES`]; 1 for coarse texels.
    pub samples: f32,
    /// Standard deviation of the samples, in units of [`root_difference`]; 0 for coarse texels.
    pub deviation: f32,
    /// Run of samples on one side of the mean: -2 to 2, below 0 if they were darker.
    pub run: f32,
}

impl Mean {
    /// A mean of one sample.
    pub const ONE: Self = Self { lod: 0.0, samples: 1.0, deviation: 0.0, run: 0.0 };
}

/// Level of detail of a stored one.
#[inline]
pub fn mean_lod(stored_lod: f32) -> f32 {
    let code = (stored_lod * CODES_PER_LOD + 0.5).floor();
    if stored_lod < 0.0 { -1.0 } else { (code - COARSE_CODE).max(0.0) * (1.0 / CODES_PER_COARSE_LOD) }
}

/// Level, number of samples, deviation and run of a stored level of detail, which is a multiple of 1/7.
#[inline]
pub fn mean_of(stored_lod: f32) -> Mean {
    let lod = mean_lod(stored_lod);
    if lod != 0.0 {
        return Mean { lod, ..Mean::ONE };
    }
    let code = (stored_lod * CODES_PER_LOD + 0.5).floor();
    // 0.125 keeps quotients away from integers.
    let run = ((code + 0.125) * (1.0 / CODES_PER_RUN)).floor();
    let code = code - run * CODES_PER_RUN;
    let number = ((code + 0.125) * (1.0 / DEVIATIONS)).floor();
    let step = code - number * DEVIATIONS;
    Mean { lod: 0.0, samples: samples_of(7.0 - number), deviation: deviation_of(step), run: run - LONGEST_RUN }
}

/// Two draws in \[0, 1) from the low bytes of random bits.
#[inline]
pub fn byte_draws(bits: u32) -> [f32; 2] {
    [((bits & 255) as f32 + 0.5) * (1.0 / 256.0), ((bits >> 8 & 255) as f32 + 0.5) * (1.0 / 256.0)]
}

/// Number of samples of a step, 0 to 7.
#[inline]
fn samples_of(step: f32) -> f32 {
    1.0 + 0.5 * (step * (step + 1.0))
}

/// Deviation of a step, 0 to 5.
#[inline]
fn deviation_of(step: f32) -> f32 {
    DEVIATION_STEP * (step * (step + 1.0))
}

/// Largest step whose triangular number, step (step + 1) / 2, is at most `v`.
#[inline]
fn step_below(v: f32) -> f32 {
    ((v * 8.0 + 1.0).sqrt() * 0.5 - 0.5).floor()
}

/// Level of detail to store for a mean; the inverse of [`mean_of`]. Number and deviation are rounded stochastically by
/// `draws`, each in \[0, 1): their means over the frames stay, and stored values stay as they are.
#[inline]
pub fn stored_lod(m: Mean, draws: [f32; 2]) -> f32 {
    if m.lod < 0.0 {
        return -1.0;
    }
    if m.lod > COARSE_LOD {
        return (COARSE_CODE + (m.lod * CODES_PER_COARSE_LOD).max(1.0)) * (1.0 / CODES_PER_LOD);
    }
    let samples = m.samples.clamp(1.0, MOST_SAMPLES);
    let step = step_below(samples - 1.0).min(6.0);
    let [low, high] = [samples_of(step), samples_of(step + 1.0)];
    let number = if samples - low > (high - low) * draws[0] { step + 1.0 } else { step };
    let deviation = m.deviation.min(deviation_of(5.0));
    let step = step_below(deviation * (0.5 / DEVIATION_STEP)).min(4.0);
    let [low, high] = [deviation_of(step), deviation_of(step + 1.0)];
    let is_higher = deviation * deviation - low * low > (high * high - low * low) * draws[1];
    let step = if is_higher { step + 1.0 } else { step };
    ((m.run + LONGEST_RUN) * CODES_PER_RUN + ((7.0 - number) * DEVIATIONS + step)) * (1.0 / CODES_PER_LOD)
}

/// Whether a pixel takes the history of a neighbour's nearer surface, so that silhouettes are means of both surfaces
/// and move with the nearer one. `full_rate`: whether the pixel has a sample in every frame. Other pixels keep their
/// own surface if it moves differently.
#[inline]
pub fn is_in_front(own: f32, neighbour: f32, own_motion: Vec2, motion: Vec2, full_rate: bool) -> bool {
    let difference = motion - own_motion;
    let alongside = difference.x.abs().max(difference.y.abs()) <= ALONGSIDE_PX;
    neighbour > own * (1.0 + NEARER_RELATIVE) && neighbour > own && (full_rate || alongside)
}

/// Whether the surfaces around a pixel move together: its own, the nearest, and the farthest. History may then show any
/// of them. If it had to show one of them, it would be rejected whenever the jitter, or a position between texels, puts
/// the pixel on the other side of a silhouette, and edges would never become means.
#[inline]
pub fn move_together(own: Vec2, nearest: Vec2, farthest: Vec2) -> bool {
    let apart = |a: Vec2, b: Vec2| (a.x - b.x).abs().max((a.y - b.y).abs());
    apart(own, nearest).max(apart(own, farthest)).max(apart(nearest, farthest)) <= TOGETHER_PX
}

/// Whether a stored disparity belongs to a surface with a disparity from `farthest` to `nearest`.
#[inline]
pub fn is_of_surfaces(stored: f32, farthest: f32, nearest: f32) -> bool {
    let far = farthest * (1.0 - NEARER_RELATIVE);
    stored >= far && stored * (1.0 - NEARER_RELATIVE) <= nearest
}

/// Whether a pixel's surface is narrower than two pixels along the line through two opposite neighbours: both show
/// farther surfaces. The jitter of a later frame may miss it, so that the pixel's history is stored as the farther
/// surface's.
#[inline]
pub fn is_thin(own: f32, a: f32, b: f32) -> bool {
    a.min(b) >= 0.0 && a.max(b) < own * (1.0 - NEARER_RELATIVE)
}

/// Whether a silhouette crosses the line through two opposite neighbours of a pixel: their disparities and its own are
/// not those of a plane, or one is unknown. Where surfaces move together, history is then the mean of several, and
/// differs from a sample, which shows one of them, although nothing changed.
#[inline]
pub fn is_silhouette(own: f32, a: f32, b: f32) -> bool {
    a.min(b) < 0.0 || ((a + b) - 2.0 * own).abs() > own * NEARER_RELATIVE
}

/// Whether the edge of a surface crosses that line: as [`is_silhouette`], but only for larger differences, which are
/// relative to the nearest of the three.
#[inline]
pub fn is_edge(own: f32, a: f32, b: f32) -> bool {
    a.min(b) < 0.0 || ((a + b) - 2.0 * own).abs() > own.max(a).max(b) * EDGE_RELATIVE
}

/// Sums over the samples around a pixel of full rate.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Near {
    /// Colors in YCoCg of the square roots.
    pub sum: Vec3,
    /// Squares of these.
    pub squares: Vec3,
    /// Number of samples.
    pub count: f32,
    /// Differences of the colors from the pixel's own sample, times their bilinear weights at the pixel's centre.
    pub change: Vec3,
    /// Sum of these weights.
    pub weight: f32,
}

/// The sums after one more sample. `own`: the pixel's sample; `away_px`: from the pixel's centre to the added one.
#[inline]
pub fn add_near(n: Near, color: Vec3, own: Vec3, away_px: Vec2) -> Near {
    let v = to_ycocg(color);
    let weight = (1.0 - away_px.x.abs()).max(0.0) * (1.0 - away_px.y.abs()).max(0.0);
    Near {
        sum: n.sum + v,
        squares: n.squares + v * v,
        count: n.count + 1.0,
        change: n.change + (color - own) * weight,
        weight: n.weight + weight,
    }
}

/// Whether samples at a place in their pixels tell the color at the pixels' centres. Jitter that antialiases is at most
/// half a pixel.
#[inline]
pub fn surrounds_centre(place_px: Vec2) -> bool {
    place_px.x.abs().max(place_px.y.abs()) <= 0.5
}

/// Change from a pixel's own sample to the color at its centre, where [`surrounds_centre`] is true. Samples that equal
/// the own one change nothing, bit for bit.
#[inline]
pub fn centred_change(near: Near) -> Vec3 {
    near.change * (1.0 / near.weight)
}

/// Clip of history to the samples around a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clip {
    /// Change of the square roots of RGB.
    pub change: Vec3,
    /// Share of its samples that the mean keeps.
    pub kept: f32,
}

/// Clip of history to the distribution of the samples around it; `near` must contain at least one sample. Variance
/// clipping (Salvi 2016, "An excursion in temporal supersampling").
#[inline]
pub fn clip(near: Near, history: Vec3) -> Clip {
    let inverse = 1.0 / near.count;
    let variance = (near.squares * near.count - near.sum * near.sum) * (inverse * inverse);
    let past = to_ycocg(history);
    let inside = clip_to_box(past, near.sum * inverse, roots(variance) * CLIP_SIGMAS + Vec3::splat(ROUNDING));
    let by = (inside - past) * CLIP;
    let moved = by.x.abs().max(by.y.abs()).max(by.z.abs());
    let outer = by.x - by.z;
    let change = Vec3::new(outer + by.y, by.x + by.z, outer - by.y);
    Clip { change, kept: 1.0 - (moved * CLIP_COST / past.x.max(1.0)).min(1.0) }
}

/// A color after a clip. A clip without a change returns the color bit for bit.
#[inline]
pub fn clipped(color: Vec3, change: Vec3) -> Vec3 {
    if change == Vec3::ZERO {
        return color;
    }
    let v = (roots(color) + change).max(Vec3::ZERO);
    v * v
}

/// Adds the squared difference of a sample and history, times its weight, to a sum for [`scattered_error`].
#[inline(always)]
pub fn add_scatter(scatter: f32, o: Observation, weight: f32) -> f32 {
    let difference = root_difference(o.sampled, o.history).min(1e6);
    scatter + (difference * difference) * weight
}

/// Expected difference of one sample from history around it: the larger of the model's value and the standard deviation
/// of the samples' differences. `scatter`: squared [`root_difference`]s of samples and history, times weights.
#[inline]
pub fn scattered_error(a: ObservedAround, scatter: f32) -> f32 {
    let inverse = 1.0 / a.weight;
    let mean = root_difference(a.sampled * inverse, a.history * inverse);
    let variance = (scatter * inverse - mean * mean).max(0.0);
    (a.error * inverse).max(variance.sqrt())
}

/// Expected difference between a sample and the mean at its pixel: the deviation of the samples in the mean, to which
/// the local contrast adds one imagined sample. A still mean has at least its own deviation; in one that moves it may
/// come from the motion. As [`expected_error`](super::reconstruction::expected_error).
#[inline]
pub fn expected_mean_error(past: Mean, contrast: f32, moved: bool) -> f32 {
    // The limit keeps compilers from merging factors.
    let prior = contrast.min(MOST_DIFFERENCE) * CONTRAST_ERROR;
    let others = past.samples - 1.0;
    let own = past.deviation * past.deviation;
    let variance = (own * others + prior * prior) / past.samples;
    let variance = if moved { variance } else { variance.max(own) };
    (MOVED_ERROR + variance.sqrt()) + prior * past.lod.clamp(0.0, 1.0)
}

/// A mean whose run counts only where an even pattern visits the pixel. Elsewhere samples are added when history lacks
/// something, at places in the pixel that may be on one side by chance. `level`: log2 of the pattern's block edge.
#[inline]
pub fn with_regular_run(past: Mean, level: u32) -> Mean {
    Mean { run: if level > MOST_REGULAR_LEVEL { 0.0 } else { past.run }, ..past }
}

/// Run of samples on one side of a mean, with one more; one near the mean ends it. `difference`: between sample and
/// history.
#[inline]
pub fn next_run(past: Mean, is_brighter: bool, difference: f32) -> f32 {
    let side = if is_brighter { 1.0 } else { -1.0 };
    if past.deviation < RUN_DEVIATION || difference < past.deviation * RUN_ERRORS {
        0.0
    } else if past.run * side > 0.0 {
        (past.run + side).clamp(-LONGEST_RUN, LONGEST_RUN)
    } else {
        side
    }
}

/// Number of samples that a mean of `count` keeps. At an edge that passes slowly, as that of a turning shadow, a mean
/// gets samples of both sides, and its deviation then tolerates either side. A run of samples on one side says that the
/// edge has passed. `next`: of [`next_run`].
#[inline]
pub fn count_in_run(count: f32, past: Mean, next: f32) -> f32 {
    let goes_on = past.run.abs() == LONGEST_RUN && past.run == next;
    if goes_on { count.min((count * RUN_KEPT).max(RUN_SAMPLES)) } else { count }
}

/// Number of samples that a mean counts for after a gain: an estimate, which the next samples must correct.
#[inline]
pub fn relit_samples(samples: f32, gain: Vec3) -> f32 {
    let changed = ((gain - Vec3::ONE).abs().max_element() * RELIT_PER_GAIN).min(1.0);
    // Not as `samples + (...) * changed`, which compilers rewrite.
    samples * (1.0 - changed) + samples.min(RELIT_SAMPLES) * changed
}

/// Share of its samples that a mean keeps when `difference`, of a sample of its pixel, contradicts it. `error`: of
/// [`expected_mean_error`].
#[inline]
pub fn kept_samples(error: f32, difference: f32) -> f32 {
    // The limit keeps compilers from merging sums.
    1.0 - smooth_step(CONTRADICTED[0], CONTRADICTED[1], difference / (error.min(MOST_DIFFERENCE) + SAMPLE_ERROR))
}

/// Result of [`average`], [`average_beside`] and [`stored_mean`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Averaged {
    /// Color to show, and texel to store.
    pub result: Reconstructed,
    /// Samples in the texel. Its level is that of the texel in `result`.
    pub mean: Mean,
}

/// Largest number of samples that a mean counts for when a sample is added to it. `place_px`: where history lies.
#[inline]
fn most_samples(place_px: Vec2, at_edge: bool) -> f32 {
    let away = place_px.x.abs().max(place_px.y.abs());
    let most = MOST_SAMPLES + (MOST_PAST_MOVED - MOST_SAMPLES) * (away * MOVED_PER_PX).min(1.0);
    if at_edge { most.max(MOST_PAST_EDGE) } else { most }
}

/// Mean of history, with the weight `share`, and of a sample at `place_px` in the pixel.
#[inline]
fn added(r: &Reconstruction, place_px: Vec2, share: f32) -> Reconstructed {
    let past_px = r.nearest.place_px;
    let history = relit(r.history, r.gain, r.range);
    let near = past_px.x.abs().max(past_px.y.abs()) <= FARTHEST_PX;
    let old = if near { relit(r.nearest.color, r.gain, r.range) } else { history };
    let old_px = if near { past_px } else { Vec2::ZERO };
    let color = r.candidate + (history - r.candidate) * share;
    let stored = StoredSample {
        color: r.candidate + (old - r.candidate) * share,
        lod: 0.0,
        place_px: place_px + (old_px - place_px) * share,
        ..r.nearest
    };
    Reconstructed { color, stored, share, keeps_nearest: near, stored_share: share }
}

/// Mean of history and of the pixel's own sample, whose place in the pixel is `place_px`. `past`: the texel of history
/// to keep; `at_edge`: whether the pixel is at a moving edge ([`is_edge`]) outside the fovea; `kept`: share of its
/// samples that remains after a clip; `difference`: of sample and history; `change`: [`centred_change`] of a pixel of
/// the fovea.
#[inline]
pub fn average(
    r: &Reconstruction,
    past: Mean,
    place_px: Vec2,
    at_edge: bool,
    kept: f32,
    difference: f32,
    change: Option<Vec3>,
) -> Averaged {
    let acceptance = (r.fit * r.trust) * kept;
    let most = most_samples(r.nearest.place_px, at_edge);
    let count = if r.nearest.lod > 0.0 { 0.0 } else { relit_samples(past.samples, r.gain).min(most) * acceptance };
    let run = next_run(past, luma(r.candidate) > luma(r.history), difference);
    let count = count_in_run(count, past, run);
    let share = count / (count + 1.0);
    // Welford 1962: the variance after one more sample.
    let variance = (past.deviation * past.deviation + (difference * difference) * (1.0 - share)) * share;
    let mean = Mean { lod: 0.0, samples: count + 1.0, deviation: variance.sqrt(), run };
    let Some(change) = change else { return Averaged { result: added(r, place_px, share), mean } };
    let sample = centred(r.candidate, place_px, change, mean.samples);
    let r = Reconstruction { candidate: sample.color, ..*r };
    Averaged { result: added(&r, sample.place_px, share), mean }
}

/// A sample, and its place in its pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placed {
    /// Color, linear RGB.
    pub color: Vec3,
    /// Offset from the pixel's centre.
    pub place_px: Vec2,
}

/// The sample of a pixel of the fovea to add to a mean, which has `samples` with it: moved by a share of 1/n towards
/// the color at the pixel's centre. A jittered sample shows one point of its pixel; until a mean of several
/// antialiases, the samples around do. A long mean is sharper without them. `change`: [`centred_change`].
#[inline]
pub fn centred(color: Vec3, place_px: Vec2, change: Vec3, samples: f32) -> Placed {
    let share = 1.0 / samples;
    Placed { color: color + change * share, place_px: place_px - place_px * share }
}

/// At a moving edge, mean of history and of the candidate, a sample of the same surface beside the pixel: as if it were
/// the pixel's own at `place_px`, with a smaller weight. Depth says in every frame which surface the pixel's jittered
/// point shows. A mean that waits for the pixel's own samples follows a moving edge too late. The sample is not
/// counted, because it shows another place. History must not be coarse.
#[inline]
pub fn average_beside(r: &Reconstruction, past: Mean, place_px: Vec2) -> Averaged {
    let acceptance = r.fit * r.trust;
    let samples = relit_samples(past.samples, r.gain);
    let count = samples.min(most_samples(r.nearest.place_px, true)) * acceptance;
    let share = count / (count + BESIDE_WEIGHT);
    let mean = Mean { lod: 0.0, samples: samples * acceptance + (1.0 - acceptance), ..past };
    Averaged { result: added(r, place_px, share), mean }
}

/// The texel that is stored for a pixel without a sample of its own: history's, with fewer samples where it does not
/// fit. `result`: of [`reconstruct`](super::reconstruction::reconstruct).
#[inline]
pub fn stored_mean(r: &Reconstruction, result: Reconstructed, past: Mean) -> Averaged {
    let is_kept = result.stored.lod < COARSE_LOD && r.nearest.lod <= 0.0;
    let share = r.fit * r.trust;
    // Compilers rewrite `1.0 + (samples - 1.0) * share` as this sum, which rounds in another way.
    let left = relit_samples(past.samples, r.gain) * share + (1.0 - share);
    let mean = if is_kept { Mean { samples: left, ..past } } else { Mean::ONE };
    Averaged { result, mean }
}
