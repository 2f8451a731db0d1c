//! Simulators for images in memory.

use super::{Pyramid, block, gaussian};
use crate::foveation::{Foveation, FoveationKind};
use crate::geometry::ViewGeometry;
use crate::image::Image;

impl Foveation {
    /// Level of detail of every pixel, for [`render`](Self::render) and for `cpu::Frame::lod`. Needs the feature `cpu`.
    /// Example: `internal::Pyramid`.
    pub fn lod_map(&self, geometry: &ViewGeometry, gaze_px: [f32; 2]) -> Image<f32> {
        if self.kind == FoveationKind::Block {
            return block::lod_map(self, geometry, gaze_px);
        }
        Image::from_fn_parallel(geometry.size_px(), |px| {
            self.lod(self.region_angle_deg(geometry, px.map(|v| v as f32), gaze_px))
        })
    }

    /// Foveated frame, from the mip levels of a full-rate frame (levels 0 to [`max_level`](Self::max_level)) and the
    /// level of detail of each pixel. Pixels of level 0 are copied bit for bit. Needs the feature `cpu`.
    ///
    /// # Panics
    /// If the pyramid has too few levels.
    pub fn render(&self, pyramid: &Pyramid, lods: &Image<f32>) -> Image<[f32; 3]> {
        match self.kind {
            // A planned frame is the full-rate frame: the post-process reads only its samples.
            FoveationKind::Off | FoveationKind::Quads => pyramid.level(0).clone(),
            FoveationKind::Mip => Image::from_fn_parallel(lods.size(), |[x, y]| {
                pyramid.trilinear([x as f32, y as f32], lods.at(x as usize, y as usize))
            }),
            FoveationKind::Block => block::render(pyramid, lods),
            FoveationKind::Gauss => gaussian::render(pyramid.level(0), lods),
        }
    }
}
