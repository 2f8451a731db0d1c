//! Samples as dense as the eye's cells.

use afterimage::kernel::acuity::{candidate_weight, cell_density};
use afterimage::{Image, ViewGeometry};

/// The pattern: every pixel of the fovea, outside it a share of the pixels that falls as the density of retinal cells, another set
/// every frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Acuity {
    /// Radius in degrees of what is sampled in full.
    pub fovea_deg: f32,
    /// Smallest share of pixels, so that the far periphery is still looked at: 0 to 1.
    pub least: f32,
    /// Exponent of the cells' relative density: 1 follows the cells, less thins out more slowly.
    pub falloff: f32,
}

impl Default for Acuity {
    fn default() -> Self {
        // With these it takes as many samples as regions of 32, 16 and 8, at a smaller error (docs/path-tracing.md).
        Self { fovea_deg: 1.0, least: 0.02, falloff: 1.0 }
    }
}

impl Acuity {
    /// Share of pixels that is sampled at an eccentricity.
    pub fn share(&self, eccentricity_deg: f32) -> f32 {
        let density = candidate_weight(eccentricity_deg, self.fovea_deg, 1.0 / cell_density(self.fovea_deg));
        density.powf(self.falloff).clamp(self.least.clamp(0.0, 1.0), 1.0)
    }

    /// Expected number of targets.
    pub fn expected(&self, geometry: &ViewGeometry, gaze_px: [f32; 2]) -> f64 {
        geometry.eccentricity_map(gaze_px).pixels().iter().map(|&e| f64::from(self.share(e))).sum()
    }

    /// Pixels of frame number `frame`, by rows, and the level of detail everywhere.
    pub(super) fn targets(
        &self,
        geometry: &ViewGeometry,
        gaze_px: [f32; 2],
        frame: u64,
    ) -> (Vec<[u32; 2]>, Image<f32>) {
        let shares = geometry.eccentricity_map(gaze_px).map(|e| self.share(e));
        let width = shares.width();
        let chosen = |(i, &share): (usize, &f32)| {
            let (x, y) = ((i % width) as u32, (i / width) as u32);
            (threshold(x, y, frame) < share).then_some([x, y])
        };
        let targets = shares.pixels().iter().enumerate().filter_map(chosen).collect();
        (targets, shares.map(|share| -0.5 * share.log2()))
    }
}

/// A number in \[0, 1) for a pixel of a frame. Along the pixels it is the additive recurrence of Roberts' R2 sequence, so that
/// the pixels below any bound keep their distance from each other; from frame to frame it moves on by the golden ratio, so that a
/// pixel's turns are evenly spread over time.
fn threshold(x: u32, y: u32, frame: u64) -> f32 {
    // In fractions of 2^32: exact at any coordinate and frame.
    const ALONG_X: u32 = 3_242_174_889;
    const ALONG_Y: u32 = 2_447_445_414;
    const IN_TIME: u32 = 2_654_435_769;
    let at = x
        .wrapping_mul(ALONG_X)
        .wrapping_add(y.wrapping_mul(ALONG_Y))
        .wrapping_add((frame as u32).wrapping_mul(IN_TIME));
    (at >> 8) as f32 * (1.0 / 16_777_216.0)
}
