//! Weight sums of wrs against the recurrence in f64: they must not drift over a stretch in which nothing changes.

use super::Found;
use super::events::Event;
use super::pictures::FOVEATION;
use super::rig::View;
use afterimage::kernel::acuity::{candidate_weight, cell_density};
use afterimage::kernel::pack::unpack;

/// Pixels whose weight sums are followed.
#[derive(Default)]
pub struct Witness {
    /// Pixel, weight of its candidates, expected sum.
    followed: Vec<(usize, f64, f64)>,
    frames: u32,
}

/// Weight sums are stored with 16 significant bits: each frame rounds by 2^-16, relative, at most, and its arithmetic
/// in f32 by some 2^-24; the recurrence never widens an error.
const ROUNDING: f64 = 1.0 / (1 << 16) as f64 + 4.0 / (1 << 24) as f64;

impl Witness {
    /// After a frame of a stretch that is quiet or not.
    pub fn step(&mut self, found: &mut Found, is_quiet: bool, event: &Event, view: &View, words: &[[u32; 3]]) {
        if event.begins_quiet {
            found.stretches += 1;
            self.frames = 0;
            let n = words.len();
            self.followed = (0..32).map(|k| follow(k * (n - 1) / 31, view)).collect();
        } else if !is_quiet {
            // In other stretches gaze and picture change without an event.
            self.followed.clear();
        } else {
            // Eqs. 5 and 7 with equal colors.
            for (_, weight, sum) in &mut self.followed {
                *sum = *sum * (*sum / (*sum + *weight)) + *weight;
            }
        }
        self.frames += 1;
        for &(pixel, _, sum) in &self.followed {
            found.drift = found.drift.max(drift(f64::from(unpack(words[pixel]).w_sum), sum, self.frames));
        }
    }
}

fn follow(pixel: usize, view: &View) -> (usize, f64, f64) {
    let geometry = &view.facts.geometry;
    let [width, _] = geometry.size_px();
    let px = [(pixel as u32 % width) as f32, (pixel as u32 / width) as f32];
    let radius_deg = 0.5 * FOVEATION.fovea_deg;
    let gaze_px = match view.facts.gaze {
        afterimage::Gaze::At { px } => px,
        _ => panic!("nothing is lost in a quiet stretch"),
    };
    let e_deg = geometry.eccentricity_deg(px, gaze_px);
    let weight = f64::from(candidate_weight(e_deg, radius_deg, 1.0 / cell_density(radius_deg)));
    (pixel, weight, weight)
}

/// Relative difference, as a share of the largest rounding error of storage after so many frames.
pub fn drift(found: f64, expected: f64, frames: u32) -> f64 {
    (found - expected).abs() / expected / (f64::from(frames) * ROUNDING)
}
