//! Sampling density that follows visual acuity.

use afterimage::kernel::acuity::{candidate_weight, cell_density};
use afterimage::{Image, ViewGeometry};

/// Every pixel in the fovea; outside it a share of pixels proportional to a power of retinal cell density, with a
/// different subset each frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Acuity {
    /// Radius of full sampling, degrees.
    pub fovea_deg: f32,
    /// Smallest share of sampled pixels, 0 to 1. Keeps the far periphery up to date.
    pub least: f32,
    /// Exponent of relative cell density: 1 follows the cells, smaller values fall off more slowly.
    pub falloff: f32,
}

impl Default for Acuity {
    fn default() -> Self {
        // Takes as many samples as `Regions` with 32, 16 and 8, at a smaller error (docs/path-tracing.md).
        Self { fovea_deg: 1.0, least: 0.02, falloff: 1.0 }
    }
}

impl Acuity {
    /// Share of pixels that is sampled at an eccentricity, 0 to 1.
    pub fn share(&self, eccentricity_deg: f32) -> f32 {
        let density = candidate_weight(eccentricity_deg, self.fovea_deg, 1.0 / cell_density(self.fovea_deg));
        density.powf(self.falloff).clamp(self.least.clamp(0.0, 1.0), 1.0)
    }

    /// Expected number of sampled pixels per frame.
    pub fn expected(&self, geometry: &ViewGeometry, gaze_px: [f32; 2]) -> f64 {
        geometry.eccentricity_map(gaze_px).pixels().iter().map(|&e| f64::from(self.share(e))).sum()
    }

    /// Sampled pixels of frame `frame`, ordered by row, and the level of detail of every pixel.
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

/// Dither threshold in \[0, 1) of a pixel in a frame. Over pixels it is the additive recurrence of Roberts' R2
/// sequence, so the pixels below any threshold are evenly spread. Over frames it advances by the golden ratio, so a
/// pixel's turns are evenly spread in time.
fn threshold(x: u32, y: u32, frame: u64) -> f32 {
    // Fixed-point fractions of 2^32, exact for any coordinate and frame.
    const ALONG_X: u32 = 3_242_174_889;
    const ALONG_Y: u32 = 2_447_445_414;
    const IN_TIME: u32 = 2_654_435_769;
    let at = x
        .wrapping_mul(ALONG_X)
        .wrapping_add(y.wrapping_mul(ALONG_Y))
        .wrapping_add((frame as u32).wrapping_mul(IN_TIME));
    (at >> 8) as f32 * (1.0 / 16_777_216.0)
}
