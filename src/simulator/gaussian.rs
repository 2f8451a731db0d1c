//! Gaussian filter: blur that grows with eccentricity. Two one-dimensional passes, each with the width at the pixel
//! that it writes: exact where the width is constant, a good approximation where it changes slowly.

use crate::image::Image;
use crate::kernel::{foveate, sanitize};
use glam::Vec3;

/// Foveated frame: `full` blurred by the width of each pixel's level of detail. Borders are clamped. Pixels of level 0
/// are copied bit for bit; for others non-finite pixels count as black.
pub fn render(full: &Image<[f32; 3]>, lods: &Image<f32>) -> Image<[f32; 3]> {
    blur_axis(&blur_axis(full, lods, 0), lods, 1)
}

/// Blurs along one axis: x (0) or y (1).
fn blur_axis(image: &Image<[f32; 3]>, lods: &Image<f32>, axis: usize) -> Image<[f32; 3]> {
    let last = i64::from(image.size()[axis]) - 1;
    Image::from_fn_parallel(image.size(), |px| {
        let [x, y] = px.map(|v| v as usize);
        let lod = lods.at(x, y);
        if lod <= 0.0 {
            return image.at(x, y);
        }
        let tap = |offset: i64| {
            let mut at = [x, y];
            at[axis] = (i64::from(px[axis]) + offset).clamp(0, last) as usize;
            sanitize::color(Vec3::from(image.at(at[0], at[1]))).0
        };
        let sigma_px = foveate::blur_sigma_px(lod);
        let mut gauss = foveate::gauss_center(sigma_px);
        let mut sum = tap(0);
        let mut side = 0.0;
        for d in 1..=i64::from(foveate::gauss_radius(sigma_px)) {
            gauss = foveate::gauss_next(gauss);
            side += gauss.weight;
            sum += (tap(-d) + tap(d)) * gauss.weight;
        }
        (sum / (1.0 + 2.0 * side)).to_array()
    })
}
