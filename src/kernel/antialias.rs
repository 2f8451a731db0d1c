//! Antialiasing of sparse frames whose projection is jittered: a stored texel is the mean of the samples that fell into
//! its pixel, with the mean of their places.
//!
//! A jittered sample shows one point of its pixel, and what a pixel should show is the mean over its area. Moving the
//! camera moves the place of a mean, as it moves that of a sample ([`kept`](super::kept)), and the mean is not
//! resampled. Means of history that moved are short: each frame's samples fall into a box that lies elsewhere, which
//! widens what the mean stands for.

use super::kept::{FARTHEST_PX, Kept};
use super::matched::{root_difference, roots};
use super::sparse::{Light, Reconstructed, Reconstruction, relit};
use super::taa::{ROUNDING, clip_to_box, to_ycocg};
use glam::{Vec2, Vec3};

/// Largest number of samples in a mean: one frame's samples weigh at least a 31st. More is calmer and follows changes
/// that no gate sees later.
pub const MOST_SAMPLES: f32 = 31.0;
/// Largest number of samples of history in a mean.
const MOST_PAST: f32 = MOST_SAMPLES - 1.0;
/// The same where history lies a quarter of a pixel and more beside the pixel's centre: more blurs motion.
const MOST_PAST_MOVED: f32 = 3.0;
/// Inverse of the distance in pixels from the pixel's centre at which that limit is reached.
const MOVED_PER_PX: f32 = 4.0;
/// Codes of a level of detail: 31 of means, of 31 samples down to one, then levels above 0.
const CODES_PER_LOD: f32 = 7.0;
/// Code of one sample.
const ONE_SAMPLE: f32 = 30.0;
/// Codes a level above 0.
const CODES_PER_COARSE_LOD: f32 = 5.0;
/// Level from which on a texel is coarse.
const COARSE_LOD: f32 = 0.1;
/// Half width of the box of nine samples to which history is clipped at full rate, in standard deviations.
const BOX_SIGMAS: f32 = 2.0;
/// Share of the clip that is applied: a thin feature that a frame misses is not lost at once.
const CLIP: f32 = 0.5;
/// Share of its samples that a mean loses for a clip by the range from black to white, or by its own brightness where
/// that is more: a tenth of it costs all.
const CLIP_COST: f32 = 10.0;
/// Relative difference of disparity from which on a neighbour is another, nearer surface.
const NEARER_RELATIVE: f32 = 0.02;
/// Largest difference of motion, in pixels along an axis, at which a nearer surface stands for a pixel of a lattice of
/// step 2 and more.
const ALONGSIDE_PX: f32 = 1.0;
/// Largest difference of motion, in pixels along an axis, at which the surfaces around a pixel move as one:
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

/// Whether a neighbour of a pixel stands for it, so that silhouettes are means of both surfaces and move with the
/// nearer one. `full_rate`: whether the pixel has a sample in every frame; others keep their own surface where that
/// moves otherwise.
#[inline]
pub fn stands_before(own: f32, neighbour: f32, own_motion: Vec2, motion: Vec2, full_rate: bool) -> bool {
    let difference = motion - own_motion;
    let alongside = difference.x.abs().max(difference.y.abs()) <= ALONGSIDE_PX;
    neighbour > own * (1.0 + NEARER_RELATIVE) && neighbour > own && (full_rate || alongside)
}

/// Whether the surfaces around a pixel move as one: its own, the nearest, and the farthest. History may then be of any
/// of them. If it had to be of one, it would be rejected whenever the jitter, or a position between texels, has the
/// pixel on the other side of a silhouette, and edges would never be means.
#[inline]
pub fn move_together(own: Vec2, nearest: Vec2, farthest: Vec2) -> bool {
    let apart = |a: Vec2, b: Vec2| (a.x - b.x).abs().max((a.y - b.y).abs());
    apart(own, nearest).max(apart(own, farthest)).max(apart(nearest, farthest)) <= TOGETHER_PX
}

/// Whether a stored disparity is that of surfaces that had disparities from `farthest` to `nearest`.
#[inline]
pub fn is_of_surfaces(stored: f32, farthest: f32, nearest: f32) -> bool {
    let far = farthest * (1.0 - NEARER_RELATIVE);
    stored >= far && stored * (1.0 - NEARER_RELATIVE) <= nearest
}

/// Marks the observation of a sample that may show another surface than the one that depth gives for its pixel. It
/// stands in place of the expected error.
pub const DOUBTFUL: f32 = -2.0;

/// Whether a pixel's sample at `place_px` may show the surface of a neighbouring pixel instead of its own. It may if
/// the neighbour's disparity differs and the sample lies on the neighbour's side of the pixel's centre. `offset`: -1, 0
/// or 1 along each axis. Depth is that of pixel centres, so that it does not say which surface a sample shows. Kept
/// under the wrong depth, a sample stays as a dot where the silhouette moves away.
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

/// The sums with one sample more.
#[inline]
pub fn add_near(n: Near, color: Vec3) -> Near {
    let v = to_ycocg(color);
    Near { sum: n.sum + v, squares: n.squares + v * v, count: n.count + 1.0 }
}

/// How history is clipped to the samples around a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clip {
    /// Change of the square roots of RGB.
    pub change: Vec3,
    /// Share of its samples that the mean keeps.
    pub kept: f32,
}

/// Clip of history to the distribution of the samples around; `near` has at least one.
#[inline]
pub fn clip(near: Near, history: Vec3) -> Clip {
    let inverse = 1.0 / near.count;
    let variance = (near.squares * near.count - near.sum * near.sum) * (inverse * inverse);
    let past = to_ycocg(history);
    let inside = clip_to_box(past, near.sum * inverse, roots(variance) * BOX_SIGMAS + Vec3::splat(ROUNDING));
    let by = (inside - past) * CLIP;
    let distance = by.x.abs().max(by.y.abs()).max(by.z.abs());
    let outer = by.x - by.z;
    let change = Vec3::new(outer + by.y, by.x + by.z, outer - by.y);
    Clip { change, kept: 1.0 - (distance * CLIP_COST / past.x.max(1.0)).min(1.0) }
}

/// A color after a clip; the color itself, bit for bit, without a change.
#[inline]
pub fn clipped(color: Vec3, change: Vec3) -> Vec3 {
    if change == Vec3::ZERO {
        return color;
    }
    let v = (roots(color) + change).max(Vec3::ZERO);
    v * v
}

/// Expected difference of one sample from history around it: by the model, or by the scatter of the samples' own
/// differences, where that is more. `scatter`: squared [`root_difference`]s of samples and history, times weights.
#[inline]
pub fn scattered_error(l: Light, scatter: f32) -> f32 {
    let inverse = 1.0 / l.weight;
    let mean = root_difference(l.sampled * inverse, l.history * inverse);
    let variance = (scatter * inverse - mean * mean).max(0.0);
    (l.error * inverse).max(variance.sqrt())
}

/// Result of [`average`] and [`kept_mean`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Averaged {
    /// Color to show, and texel to store.
    pub result: Reconstructed,
    /// Number of samples in it.
    pub samples: f32,
}

/// Mean of history and of the pixel's own sample, whose place in the pixel is `place_px`. `samples`: number in the
/// texel of history to keep; `kept`: share of them that a clip leaves.
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
    let next = Kept {
        color: r.candidate + (old - r.candidate) * share,
        lod: 0.0,
        place_px: place_px + (old_px - place_px) * share,
        ..r.nearest
    };
    Averaged { result: Reconstructed { color, kept: next, share }, samples: count + 1.0 }
}

/// Number of samples of a texel that a pixel without an own sample stores: those of the kept one, as far as history
/// fits. `result`: of [`reconstruct`](super::sparse::reconstruct).
#[inline]
pub fn kept_mean(r: &Reconstruction, result: Reconstructed, samples: f32) -> Averaged {
    let is_kept = result.kept.lod < COARSE_LOD && r.nearest.lod <= 0.0;
    let left = 1.0 + (samples - 1.0) * (r.fit * r.trust);
    Averaged { result, samples: if is_kept { left } else { 1.0 } }
}
