//! Three regions: pixels, blocks of 2x2, blocks of 4x4 (Mohanto et al., "A Foveated Framework to Accelerate Real-Time
//! Path Tracing", 2023).

use super::circle::Circle;
use super::fill::Filter;
use super::rings::Ring;
use afterimage::ViewGeometry;
use afterimage_lab::view::Lattice;

/// Three regions around the gaze. Defaults are the paper's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Regions {
    /// Samples per pixel in the fovea, per block in the middle region, per block in the outer region.
    pub samples: [u32; 3],
    /// Block edges of the middle and outer region, in pixels.
    pub blocks: [u32; 2],
    /// Diameters of fovea and middle region as full visual angles, degrees.
    pub diameters_deg: [f32; 2],
    /// Factor on both radii; 0.5 is the paper's variant with halved radii.
    pub radius_scale: f32,
}

impl Default for Regions {
    fn default() -> Self {
        Self { samples: [32, 16, 8], blocks: [2, 4], diameters_deg: [5.2, 17.0], radius_scale: 1.0 }
    }
}

impl Regions {
    /// Radii in pixels of the two inner regions: a = 2 d tan(e/2) on the screen, where d is the viewing distance that
    /// the view's angles imply.
    pub fn radii_px(&self, geometry: &ViewGeometry) -> [f32; 2] {
        self.diameters_deg.map(|e| tangent_px(geometry, 0.5 * e) * self.radius_scale)
    }

    /// Samples of a frame if both discs lie fully on it, without blending: the paper's ideal reduction.
    pub fn ideal_samples(&self, geometry: &ViewGeometry) -> f64 {
        let [r0, r1] = self.radii_px(geometry).map(f64::from);
        let [w, h] = geometry.size_px().map(f64::from);
        let (fovea, disc) = (std::f64::consts::PI * r0 * r0, std::f64::consts::PI * r1 * r1);
        let [a, b, c] = self.samples.map(f64::from);
        let [m, n] = self.blocks.map(|b| f64::from(b) * f64::from(b));
        fovea * a + (disc - fovea) / m * b + (w * h - disc).max(0.0) / n * c
    }

    pub(super) fn rings(&self, geometry: &ViewGeometry) -> Vec<Ring> {
        let size_px = geometry.size_px();
        let [fovea, middle] = self.radii_px(geometry);
        let ring = |step: u32, samples: u32, radius_px: f32, blend_px: f32| Ring {
            lattice: Lattice::blocks(step, size_px),
            samples,
            radius_px,
            blend_px,
            filter: Filter::Linear,
            lens: Circle::EVERYTHING,
        };
        // Regions blend over two blocks of the outer one. A smaller width shows the border, a larger one costs samples.
        let [m, n] = self.blocks;
        vec![
            ring(1, self.samples[0], fovea, 2.0 * m as f32),
            ring(m, self.samples[1], middle.max(fovea), 2.0 * n as f32),
            ring(n, self.samples[2], f32::INFINITY, 0.0),
        ]
    }
}

/// Length in pixels that an angle from the axis spans at the centre of the view.
pub(super) fn tangent_px(geometry: &ViewGeometry, angle_deg: f32) -> f32 {
    let (scale, _) = geometry.scale_offset();
    angle_deg.clamp(0.0, 89.0).to_radians().tan() / scale[0]
}
