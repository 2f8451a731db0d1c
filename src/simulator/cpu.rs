//! The simulators for images in memory.

use super::{Pyramid, block, gaussian};
use crate::foveation::{Filter, Foveation};
use crate::geometry::ViewGeometry;
use crate::image::Image;

impl Foveation {
    /// Level of detail of every pixel, given their eccentricities for the same gaze.
    pub fn lod_map(&self, geometry: &ViewGeometry, gaze_px: [f32; 2], ecc_deg: &Image<f32>) -> Image<f32> {
        if self.filter == Filter::Block {
            return block::lod_map(self, geometry, gaze_px);
        }
        Image::from_fn_parallel(geometry.size_px(), |[x, y]| self.lod(ecc_deg.at(x as usize, y as usize)))
    }

    /// The frame as it looks with the given level of detail at each pixel. Pixels of level 0 are copied bit for bit.
    pub fn render(&self, pyramid: &Pyramid, lods: &Image<f32>) -> Image<[f32; 3]> {
        match self.filter {
            Filter::Off => pyramid.level(0).clone(),
            Filter::Mip => Image::from_fn_parallel(lods.size(), |[x, y]| {
                pyramid.trilinear([x as f32, y as f32], lods.at(x as usize, y as usize))
            }),
            Filter::Block => block::render(pyramid, lods),
            Filter::Gauss => gaussian::render(pyramid.level(0), lods),
        }
    }
}
