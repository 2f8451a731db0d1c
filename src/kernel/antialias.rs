//! Antialiasing of sparse frames whose projection is jittered: a stored texel is the mean of the samples that fell into
//! its pixel, with the mean of their places.
//!
//! A jittered sample shows one point of its pixel, but the pixel should show the mean over its area. Camera motion
//! moves the place of a mean, like that of a sample ([`stored_sample`](super::stored_sample)), and the mean is not
//! resampled. Means of moving history contain few samples: the pixel's area lies elsewhere on the surface in each
//! frame, so that a long mean would blur.

use super::smr::{root_difference, roots};
use super::sparse_smr::{ObservedAround, Reconstructed, Reconstruction, relit};
use super::stored_sample::{FARTHEST_PX, StoredSample};
use super::taa::{ROUNDING, clip_to_box, to_ycocg};
use glam::{Vec2, Vec3};

/// Largest number of samples in a mean: one frame's sample has a weight of at least 1/31. A larger limit flickers less,
/// and is slower to follow changes that the gate does not detect.
pub const MOST_SAMPLES: f32 = 31.0;
/// Largest number of samples of history in a mean.
const MOST_PAST: f32 = MOST_SAMPLES - 1.0;
/// The same limit where history lies a quarter of a pixel or more from the pixel's centre. A larger limit blurs motion.
const MOST_PAST_MOVED: f32 = 3.0;
/// Inverse of the distance in pixels from the pixel's centre at which that limit is reached.
const MOVED_PER_PX: f32 = 4.0;
/// Steps of a stored level of detail. The first 31 codes are means of 31 samples down to one; the following ones are
/// levels above 0.
const CODES_PER_LOD: f32 = 7.0;
/// Code of a mean of one sample.
const ONE_SAMPLE: f32 = 30.0;
/// Codes a level above 0.
const CODES_PER_COARSE_LOD: f32 = 5.0;
/// A texel of this level or more is coarse.
const COARSE_LOD: f32 = 0.1;
/// Half width of the box of nine samples to which history is clipped at full rate, in standard deviations.
const BOX_SIGMAS: f32 = 2.0;
/// Share of the clip that is applied, so that a thin feature is not lost at once if a frame misses it.
const CLIP: f32 = 0.5;
/// Cost of a clip: the share of its samples that a mean loses, per clip distance in units of the range from black to
/// white, or of the mean's own brightness if that is larger. A clip by a tenth costs all samples.
const CLIP_COST: f32 = 10.0;
/// Least relative difference of disparity at which a neighbour counts as another, nearer surface.
const NEARER_RELATIVE: f32 = 0.02;
/// Largest difference of motion, in pixels along an axis, at which a pixel of a lattice of step 2 and more takes the
/// history of a nearer surface beside it.
const ALONGSIDE_PX: f32 = 1.0;
/// Largest difference of motion, in pixels along an axis, at which the surfaces around a pixel move together, so that
/// history that mixes them stays in place.
const TOGETHER_PX: f32 = 0.25;

/// A stored texel: its level of detail, at least 0, and the number of samples in it. Empty texels stay empty.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mean {
    /// Level of detail; negative: empty.
    pub lod: f32,
    /// Number of samples, 1 to [`MOST_SAMPLES`]; 1 for coarse texels.
    pub samples: f32,
}

/// Level and number of samples of a stored level of detail, which is a multiple of 1/7.
#[inline]
pub fn mean_of(stored_lod: f32) -> Mean {
    let code = (stored_lod * CODES_PER_LOD + 0.5).floor();
    let coarse = code > ONE_SAMPLE;
    Mean {
        lod: if stored_lod < 0.0 {
            -1.0
        } else if coarse {
            (code - ONE_SAMPLE) * (1.0 / CODES_PER_COARSE_LOD)
        } else {
            0.0
        },
        samples: if coarse || stored_lod < 0.0 { 1.0 } else { ONE_SAMPLE + 1.0 - code },
    }
}

/// Level of detail to store for a mean; the inverse of [`mean_of`].
#[inline]
pub fn stored_lod(m: Mean) -> f32 {
    let code = if m.lod > COARSE_LOD {
        ONE_SAMPLE + m.lod * CODES_PER_COARSE_LOD
    } else {
        ONE_SAMPLE + 1.0 - m.samples.clamp(1.0, MOST_SAMPLES)
    };
    if m.lod < 0.0 { -1.0 } else { code * (1.0 / CODES_PER_LOD) }
}

/// Whether a pixel takes the history of a neighbour's nearer surface, so that silhouettes are means of both surfaces
/// and move with the nearer one. `full_rate`: whether the pixel has a sample in every frame. Other pixels keep their
/// own surface if it moves differently.
#[inline]
pub fn stands_before(own: f32, neighbour: f32, own_motion: Vec2, motion: Vec2, full_rate: bool) -> bool {
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
/// farther surfaces. The jitter of a later frame may miss it, so that the pixel's history is stored as that of the
/// farther surface.
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

/// Marks the observation of a sample that may show a surface other than the one at its pixel's depth. It is stored in
/// place of the expected error.
pub const DOUBTFUL: f32 = -2.0;

/// Whether a pixel's sample at `place_px` may show the surface of a neighbouring pixel instead of its own. It may if
/// the neighbour's disparity differs and the sample lies on the neighbour's side of the pixel's centre. `offset`: -1, 0
/// or 1 along each axis. Depth is given at pixel centres, so it does not tell which surface a sample shows. A sample
/// stored with the wrong depth would stay behind as a dot when the silhouette moves away.
#[inline]
pub fn may_show(own: f32, neighbour: f32, place_px: Vec2, offset: Vec2) -> bool {
    let nearer = neighbour > own * (1.0 + NEARER_RELATIVE);
    let farther = neighbour >= 0.0 && neighbour < own * (1.0 - NEARER_RELATIVE);
    let toward = place_px * offset;
    (nearer || farther) && (toward.x > 0.0 || offset.x == 0.0) && (toward.y > 0.0 || offset.y == 0.0)
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
}

/// The sums after one more sample.
#[inline]
pub fn add_near(n: Near, color: Vec3) -> Near {
    let v = to_ycocg(color);
    Near { sum: n.sum + v, squares: n.squares + v * v, count: n.count + 1.0 }
}

/// Clip of history to the samples around a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clip {
    /// Change of the square roots of RGB.
    pub change: Vec3,
    /// Share of its samples that the mean keeps.
    pub kept: f32,
}

/// Clip of history to the distribution of the samples around it; `near` must contain at least one sample.
#[inline]
pub fn clip(near: Near, history: Vec3) -> Clip {
    let inverse = 1.0 / near.count;
    let variance = (near.squares * near.count - near.sum * near.sum) * (inverse * inverse);
    let past = to_ycocg(history);
    let inside = clip_to_box(past, near.sum * inverse, roots(variance) * BOX_SIGMAS + Vec3::splat(ROUNDING));
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

/// Expected difference of one sample from history around it: the larger of the model's value and the standard deviation
/// of the samples' differences. `scatter`: squared [`root_difference`]s of samples and history, times weights.
#[inline]
pub fn scattered_error(a: ObservedAround, scatter: f32) -> f32 {
    let inverse = 1.0 / a.weight;
    let mean = root_difference(a.sampled * inverse, a.history * inverse);
    let variance = (scatter * inverse - mean * mean).max(0.0);
    (a.error * inverse).max(variance.sqrt())
}

/// Result of [`average`] and [`stored_mean`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Averaged {
    /// Color to show, and texel to store.
    pub result: Reconstructed,
    /// Number of samples in the texel.
    pub samples: f32,
}

/// Mean of history and of the pixel's own sample, whose place in the pixel is `place_px`. `samples`: number of samples
/// in the texel of history to keep; `kept`: share of them that remains after a clip.
#[inline]
pub fn average(r: &Reconstruction, samples: f32, place_px: Vec2, kept: f32) -> Averaged {
    let acceptance = (r.fit * r.trust) * kept;
    let past_px = r.nearest.place_px;
    let away = past_px.x.abs().max(past_px.y.abs());
    let most = MOST_PAST + (MOST_PAST_MOVED - MOST_PAST) * (away * MOVED_PER_PX).min(1.0);
    let count = if r.nearest.lod > 0.0 { 0.0 } else { samples.min(most) * acceptance };
    let share = count / (count + 1.0);
    let history = relit(r.history, r.gain, r.range);
    let near = away <= FARTHEST_PX;
    let old = if near { relit(r.nearest.color, r.gain, r.range) } else { history };
    let old_px = if near { past_px } else { Vec2::ZERO };
    let color = r.candidate + (history - r.candidate) * share;
    let next = StoredSample {
        color: r.candidate + (old - r.candidate) * share,
        lod: 0.0,
        place_px: place_px + (old_px - place_px) * share,
        ..r.nearest
    };
    Averaged { result: Reconstructed { color, stored: next, share }, samples: count + 1.0 }
}

/// Number of samples in the texel that is stored for a pixel without a sample of its own. This is the number in the
/// stored texel, reduced where history does not fit. `result`: of [`reconstruct`](super::sparse_smr::reconstruct).
#[inline]
pub fn stored_mean(r: &Reconstruction, result: Reconstructed, samples: f32) -> Averaged {
    let is_kept = result.stored.lod < COARSE_LOD && r.nearest.lod <= 0.0;
    let share = r.fit * r.trust;
    // Compilers rewrite `1.0 + (samples - 1.0) * share` as this sum, which rounds in another way.
    let left = samples * share + (1.0 - share);
    Averaged { result, samples: if is_kept { left } else { 1.0 } }
}
