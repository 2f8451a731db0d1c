//! Ghosting: the share of a pixel's old color that remains in the output after a change, and its duration.

use super::{NO_PAST, Tracked};
use afterimage::Image;
use glam::Vec3;

/// Number of frames after a change in which ghosting is measured.
pub const GHOST_FRAMES: usize = 32;

/// Threshold of a change, on a scale of 1: distance of a channel from the range of the 3x3 pixels around its previous
/// position. It is above the effect of resampling and noise.
const CHANGE: f32 = 0.1;

/// Last change of the color of a pixel's surface.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Ghost {
    /// sRGB-encoded color before the change.
    pub old: [f32; 3],
    /// Frames since the change, 0 for the first frame with the new color. [`GHOST_FRAMES`] or more: no recent change.
    pub age: u8,
}

/// No recent change.
const NONE: Ghost = Ghost { old: [0.0; 3], age: GHOST_FRAMES as u8 };

/// Tracks color changes of surfaces in the full-rate frames.
#[derive(Clone, Debug, Default)]
pub(super) struct Ghosts {
    previous: Option<(Image<[f32; 3]>, Image<Ghost>)>,
}

impl Ghosts {
    /// Processes the next full-rate frame, sRGB-encoded. Returns the last change of every pixel.
    pub fn advance(&mut self, encoded: &Image<[f32; 3]>, tracked: &Tracked) -> Image<Ghost> {
        let ghosts = match &self.previous {
            None => Image::filled(encoded.size(), NONE),
            Some((before, ghosts)) => Image::from_fn_parallel(encoded.size(), |[x, y]| {
                let (x, y) = (x as usize, y as usize);
                let from = tracked.fetched.at(x, y);
                if from == NO_PAST {
                    return NONE;
                }
                if leaves(encoded.at(x, y), before, from as usize) {
                    return Ghost { old: before.pixels()[from as usize], age: 0 };
                }
                if tracked.past.at(x, y) == NO_PAST {
                    return NONE;
                }
                let ghost = ghosts.pixels()[from as usize];
                Ghost { age: ghost.age.saturating_add(1), ..ghost }
            }),
        };
        self.previous = Some((encoded.clone(), ghosts.clone()));
        ghosts
    }
}

/// Whether a color is outside of the range of the 3x3 pixels around pixel `index` by more than [`CHANGE`].
fn leaves(color: [f32; 3], before: &Image<[f32; 3]>, index: usize) -> bool {
    let (width, height) = (before.width(), before.height());
    let (x, y) = (index % width, index / width);
    let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    for y in y.saturating_sub(1)..(y + 2).min(height) {
        for x in x.saturating_sub(1)..(x + 2).min(width) {
            let c = Vec3::from(before.at(x, y));
            (low, high) = (low.min(c), high.max(c));
        }
    }
    let color = Vec3::from(color);
    (low - color).max(color - high).max_element() > CHANGE
}

/// Accumulator of the share of the old color in a method's output, by frames since the change.
#[derive(Clone, Copy, Debug)]
pub(super) struct GhostShares {
    /// For each age, the sums of (output - new) . (old - new) and |old - new|^2.
    sums: [(f64, f64); GHOST_FRAMES],
}

impl Default for GhostShares {
    fn default() -> Self {
        Self { sums: [(0.0, 0.0); GHOST_FRAMES] }
    }
}

impl GhostShares {
    pub fn add(&mut self, ghost: Ghost, new: Vec3, output: Vec3) {
        if let Some((along, whole)) = self.sums.get_mut(usize::from(ghost.age)) {
            let old = Vec3::from(ghost.old) - new;
            *along += f64::from((output - new).dot(old));
            *whole += f64::from(old.length_squared());
        }
    }

    pub fn merge(&mut self, other: &Self) {
        for (sums, more) in self.sums.iter_mut().zip(&other.sums) {
            sums.0 += more.0;
            sums.1 += more.1;
        }
    }

    /// Least-squares share of the old color in the output, for each age that occurred: 1 is all, 0 is none.
    fn shares(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.sums.iter().enumerate().filter(|(_, s)| s.1 > 0.0).map(|(age, s)| (age, s.0 / s.1))
    }

    /// Ghost energy in frames: sum of the squared shares over all ages. An output that keeps the old color for n frames
    /// has an energy of n. `None` if nothing changed.
    pub fn energy(&self) -> Option<f64> {
        self.shares().next()?;
        Some(self.shares().map(|(_, share)| share.max(0.0).powi(2)).sum())
    }

    /// Number of frames until the share falls to half of its value in the first frame; `None` if it does not, or if the
    /// first frame has no ghosting.
    pub fn half_frames(&self) -> Option<u32> {
        let first = self.shares().next().filter(|&(age, share)| age == 0 && share > 0.0)?.1;
        self.shares().find(|&(_, share)| share <= 0.5 * first).map(|(age, _)| age as u32)
    }
}
