//! One point sample a block, as coarse shading does: blocks of powers of two on a fixed grid, nested, each decided by the
//! eccentricity of its own centre.

use super::Pyramid;
use crate::foveation::Foveation;
use crate::geometry::ViewGeometry;
use crate::image::Image;
use crate::kernel::{foveate, sanitize};
use glam::Vec3;

/// Level of the coarsest aligned block around each pixel whose centre is far enough out; whole numbers.
pub fn lod_map(foveation: &Foveation, geometry: &ViewGeometry, gaze_px: [f32; 2]) -> Image<f32> {
    let size = geometry.size_px();
    let coarsest = foveation.max_level();
    let wants: Vec<Image<bool>> = (1..=coarsest)
        .map(|level| {
            let blocks = size.map(|s| foveate::level_len(s, level));
            Image::from_fn_parallel(blocks, |block| {
                let center = [0, 1].map(|i| foveate::block_center_px(block[i], level, size[i]));
                foveation.lod(geometry.eccentricity_deg(center, gaze_px)) >= level as f32
            })
        })
        .collect();
    Image::from_fn_parallel(size, |[x, y]| {
        let level = (1..=coarsest).rev().find(|&l| wants[l as usize - 1].at((x >> l) as usize, (y >> l) as usize));
        level.unwrap_or(0) as f32
    })
}

/// Every pixel shows the sample of its block; non-finite samples are black, so that one bad pixel does not fill a block.
pub fn render(pyramid: &Pyramid, lods: &Image<f32>) -> Image<[f32; 3]> {
    let size = lods.size();
    Image::from_fn_parallel(size, |px| {
        let level = lods.at(px[0] as usize, px[1] as usize) as u32;
        if level == 0 {
            return pyramid.level(0).at(px[0] as usize, px[1] as usize);
        }
        let [x, y] = [0, 1].map(|i| foveate::block_sample(px[i] >> level, level, size[i]) as usize);
        let source = pyramid.level(foveate::block_sample_level(level) as usize);
        sanitize::color(Vec3::from(source.at(x, y))).0.to_array()
    })
}
