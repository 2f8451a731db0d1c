//! Nested lattices aligned to the gaze (thesis: foveated path tracing for VR, KTH 2020).

use super::circle::Circle;
use super::fill::Filter;
use super::regions::tangent_px;
use super::rings::Ring;
use afterimage::ViewGeometry;
use afterimage_lab::view::Lattice;

/// Four nested lattices. Defaults are the thesis'.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layers {
    /// Radii of the three inner layers around the gaze, degrees.
    pub radii_deg: [f32; 3],
    /// Distance in pixels between the sampled pixels of the four layers.
    pub steps: [u32; 4],
    /// Radius in degrees around the view's axis that a headset's lens shows; nothing is traced outside. `None` for a
    /// screen, which shows everything.
    pub lens_deg: Option<f32>,
}

impl Default for Layers {
    fn default() -> Self {
        Self { radii_deg: [6.0, 10.0, 20.0], steps: [1, 2, 3, 4], lens_deg: None }
    }
}

impl Layers {
    pub(super) fn rings(&self, geometry: &ViewGeometry, gaze_px: [f32; 2], samples: u32) -> Vec<Ring> {
        let size_px = geometry.size_px();
        let lens = self.lens_deg.and_then(|deg| {
            let center_px = geometry.project([0.0, 0.0, 1.0])?;
            Some(Circle { radius_px: tangent_px(geometry, deg), ..Circle::around(center_px) })
        });
        let mut radius = 0.0_f32;
        (0..4)
            .map(|i| {
                radius = self.radii_deg.get(i).map_or(f32::INFINITY, |&deg| tangent_px(geometry, deg)).max(radius);
                Ring {
                    lattice: Lattice::through(self.steps[i], gaze_px, size_px),
                    samples,
                    radius_px: radius,
                    blend_px: if i < 3 { 2.0 * self.steps[i + 1] as f32 } else { 0.0 },
                    filter: if self.steps[i] > 1 { Filter::Bicubic } else { Filter::Linear },
                    lens: lens.unwrap_or(Circle::EVERYTHING),
                }
            })
            .collect()
    }
}
