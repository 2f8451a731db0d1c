//! One point sample a block, as coarse shading does: blocks of powers of two on a fixed grid, nested, each decided by the
//! eccentricity of its own centre.

use super::{Foveation, Pyramid};
use crate::display::ViewGeometry;
use crate::image::Image;

/// Textures are filtered for the shading rate, but not quite: the sample of a block of level l sees level l - 2, as a renderer's
/// anisotropic filter with its usual bias does. What remains is aliasing, which is the point of this simulator.
const SAMPLE_LEVEL_BIAS: usize = 2;

/// Level of the coarsest aligned block around each pixel whose centre is far enough out; whole numbers.
pub fn lod_map(foveation: &Foveation, geometry: &ViewGeometry, gaze_px: [f32; 2]) -> Image<f32> {
    let size = geometry.size_px();
    let coarsest = foveation.max_level();
    let wants: Vec<Image<bool>> = (1..=coarsest)
        .map(|level| {
            let blocks = size.map(|s| s.div_ceil(1 << level));
            Image::from_fn_parallel(blocks, |block| {
                let center = block_center(block, level, size);
                foveation.lod(geometry.eccentricity_deg(center, gaze_px)) >= level as f32
            })
        })
        .collect();
    Image::from_fn_parallel(size, |[x, y]| {
        let level = (1..=coarsest).rev().find(|&l| wants[l as usize - 1].at((x >> l) as usize, (y >> l) as usize));
        level.unwrap_or(0) as f32
    })
}

/// Centre of a block in pixels, kept inside the image for blocks that its border cuts.
fn block_center(block: [u32; 2], level: u32, size: [u32; 2]) -> [f32; 2] {
    let edge = (1_u32 << level) as f32;
    [0, 1].map(|i| ((block[i] as f32 + 0.5) * edge - 0.5).min((size[i] - 1) as f32))
}

/// Every pixel shows the sample of its block.
pub fn render(pyramid: &Pyramid, lods: &Image<f32>) -> Image<[f32; 3]> {
    let size = lods.size();
    Image::from_fn_parallel(size, |[x, y]| {
        let level = lods.at(x as usize, y as usize) as u32;
        if level == 0 {
            return pyramid.level(0).at(x as usize, y as usize);
        }
        let center = block_center([x >> level, y >> level], level, size);
        let source = (level as usize).saturating_sub(SAMPLE_LEVEL_BIAS);
        let image = pyramid.level(source);
        let [tx, ty] = center.map(|c| (c as usize) >> source);
        image.at(tx.min(image.width() - 1), ty.min(image.height() - 1))
    })
}
