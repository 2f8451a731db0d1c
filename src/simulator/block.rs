//! Block filter: one point sample a block, as coarse shading hardware renders it. Blocks have power-of-two edges on a
//! fixed, nested grid; the eccentricity of its centre decides whether a block is used.

use super::Pyramid;
use crate::foveation::Foveation;
use crate::geometry::ViewGeometry;
use crate::image::Image;
use crate::kernel::{foveate, sanitize};
use glam::Vec3;

/// Level of detail of each pixel, a whole number: level of the coarsest aligned block around it whose centre's level of
/// detail is at least the block's level.
pub fn lod_map(foveation: &Foveation, geometry: &ViewGeometry, gaze_px: [f32; 2]) -> Image<f32> {
    let size = geometry.size_px();
    let coarsest = foveation.max_level();
    let is_used: Vec<Image<bool>> = (1..=coarsest)
        .map(|level| {
            let blocks = size.map(|s| foveate::level_len(s, level));
            Image::from_fn_parallel(blocks, |block| {
                let center = [0, 1].map(|i| foveate::block_center_px(block[i], level, size[i]));
                foveation.lod(foveation.region_angle_deg(geometry, center, gaze_px)) >= level as f32
            })
        })
        .collect();
    Image::from_fn_parallel(size, |[x, y]| {
        let level = (1..=coarsest).rev().find(|&l| is_used[l as usize - 1].at((x >> l) as usize, (y >> l) as usize));
        level.unwrap_or(0) as f32
    })
}

/// Foveated frame: every pixel has the sample of its block. Non-finite samples become black, so that one non-finite
/// pixel does not fill a block.
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
