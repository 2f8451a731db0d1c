//! One pixel of temporal antialiasing, the gaze-unaware baseline: exponential mean along the motion, with history
//! clipped to the color distribution of the candidate's neighbourhood (Salvi 2016, "An excursion in temporal
//! supersampling"; Karis 2014).

use super::matched::roots;
use glam::Vec3;

/// Weight of the candidate where history lies exactly on a texel, and midway between texels: higher there, because each
/// resampling blurs.
const ALPHA: [f32; 2] = [0.1, 0.4];
/// Half width of the clipping box in standard deviations. A foveated neighbourhood is smooth, so that narrower boxes
/// would clip the detail of earlier frames.
const BOX_SIGMAS: f32 = 2.0;

/// YCoCg of the square roots of a linear color.
#[inline]
pub fn to_ycocg(c: Vec3) -> Vec3 {
    let r = roots(c);
    let outer = 0.25 * (r.x + r.z);
    let inner = 0.5 * r.y;
    Vec3::new(outer + inner, 0.5 * (r.x - r.z), inner - outer)
}

/// Square roots of RGB from YCoCg, at least 0.
#[inline]
pub fn roots_of_ycocg(y: Vec3) -> Vec3 {
    let outer = y.x - y.z;
    Vec3::new((outer + y.y).max(0.0), (y.x + y.z).max(0.0), (outer - y.y).max(0.0))
}

/// Clips `history` along the line to `mean` to the box of half width `extent` around `mean`.
#[inline]
pub fn clip_to_box(history: Vec3, mean: Vec3, extent: Vec3) -> Vec3 {
    let d = history - mean;
    let x = extent.x / d.x.abs().max(1e-6);
    let y = extent.y / d.y.abs().max(1e-6);
    let z = extent.z / d.z.abs().max(1e-6);
    let inside = x.min(y).min(z);
    if inside < 1.0 { mean + d * inside } else { history }
}

/// Weight of the candidate, for history resampled at `fraction` (each in \[0, 1)) between texels; at least `1 - trust`.
#[inline]
pub fn candidate_share(fraction: [f32; 2], trust: f32) -> f32 {
    let x = 4.0 * (fraction[0] * (1.0 - fraction[0]));
    let y = 4.0 * (fraction[1] * (1.0 - fraction[1]));
    let resampled = ALPHA[0] + (ALPHA[1] - ALPHA[0]) * x.max(y);
    resampled.max(1.0 - trust)
}

/// Output color: candidate blended with clipped history. `sum` and `squares`: sums over the 3x3 neighbourhood in YCoCg
/// of colors and of their squares.
#[inline]
pub fn blend_clipped(candidate: Vec3, history: Vec3, sum: Vec3, squares: Vec3, alpha: f32) -> Vec3 {
    let mean = sum * (1.0 / 9.0);
    let variance = (squares * 9.0 - sum * sum) * (1.0 / 81.0);
    let clipped = roots_of_ycocg(clip_to_box(to_ycocg(history), mean, roots(variance) * BOX_SIGMAS));
    let shown = clipped + (roots(candidate) - clipped) * alpha;
    shown * shown
}
