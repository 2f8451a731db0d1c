//! Gaussian blur that grows with eccentricity. Two one-dimensional passes, each with the width of the pixel it writes: exact
//! where the width is constant, and close to it where it changes slowly.

use crate::image::Image;
use crate::kernel::foveate::blur_sigma_px;
use glam::Vec3;

/// Kernels are kept for widths in steps of this many pixels.
const SIGMA_STEP_PX: f32 = 1.0 / 16.0;

/// Half kernels by width: weight of the centre, then of each pixel to a side. Each whole kernel sums to 1.
fn kernels(max_sigma: f32) -> Vec<Vec<f32>> {
    let count = (max_sigma / SIGMA_STEP_PX).round() as usize + 1;
    (0..count)
        .map(|i| {
            let sigma = (i as f32 * SIGMA_STEP_PX).max(1e-3);
            let radius = (3.0 * sigma).ceil() as i32;
            let mut weights: Vec<f32> = (0..=radius).map(|d| (-0.5 * (d as f32 / sigma).powi(2)).exp()).collect();
            let sum = 2.0 * weights.iter().sum::<f32>() - weights[0];
            weights.iter_mut().for_each(|w| *w /= sum);
            weights
        })
        .collect()
}

/// The frame blurred by the width that belongs to each pixel's level of detail. Borders are continued by their last pixel.
pub fn render(full: &Image<[f32; 3]>, lods: &Image<f32>) -> Image<[f32; 3]> {
    let largest = lods.pixels().iter().copied().fold(0.0, f32::max);
    let kernels = kernels(blur_sigma_px(largest));
    let clean = full.map(|c| crate::kernel::scrub::color(Vec3::from(c)).0.to_array());
    let across = blur_axis(&clean, lods, &kernels, true);
    let mut blurred = blur_axis(&across, lods, &kernels, false);
    for ((out, &lod), &sharp) in blurred.pixels_mut().iter_mut().zip(lods.pixels()).zip(full.pixels()) {
        if lod <= 0.0 {
            *out = sharp;
        }
    }
    blurred
}

fn blur_axis(image: &Image<[f32; 3]>, lods: &Image<f32>, kernels: &[Vec<f32>], horizontal: bool) -> Image<[f32; 3]> {
    let last = if horizontal { image.width() } else { image.height() } as i32 - 1;
    Image::from_fn_parallel(image.size(), |[x, y]| {
        let sigma = blur_sigma_px(lods.at(x as usize, y as usize));
        let kernel = &kernels[((sigma / SIGMA_STEP_PX).round() as usize).min(kernels.len() - 1)];
        let center = if horizontal { x } else { y } as i32;
        let tap = |offset: i32| {
            let at = (center + offset).clamp(0, last) as usize;
            Vec3::from(if horizontal { image.at(at, y as usize) } else { image.at(x as usize, at) })
        };
        let mut sum = tap(0) * kernel[0];
        for (d, &w) in kernel.iter().enumerate().skip(1) {
            sum += (tap(d as i32) + tap(-(d as i32))) * w;
        }
        sum.to_array()
    })
}
