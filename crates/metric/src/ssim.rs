//! SSIM (Wang et al. 2004: 11x11 Gaussian window, sigma 1.5, on Rec. 709 luma) by the `blazediff-ssim` crate.

use afterimage::Image;
use afterimage::kernel::color;
use blazediff_ssim::{Plane, SsimOptions, ssim};
use glam::Vec3;
use rayon::prelude::*;

/// Side of the window in pixels.
const WINDOW: usize = 11;

/// Rows of the map per strip. The crate downsamples images whose shorter side exceeds 384 pixels, as the authors'
/// script does. Strips stay below, so that SSIM is computed at full resolution, and run in parallel.
const STRIP_ROWS: usize = 128;

/// SSIM at every pixel whose window lies inside the image: a map that is 10 pixels smaller in width and height, whose
/// pixel (0, 0) is the image's (5, 5). `None` for images smaller than the window.
///
/// # Panics
/// If the sizes differ.
pub fn ssim_map(reference: &Image<[f32; 3]>, output: &Image<[f32; 3]>) -> Option<Image<f32>> {
    assert_eq!(reference.size(), output.size());
    let (width, height) = (reference.width(), reference.height());
    if width < WINDOW || height < WINDOW {
        return None;
    }
    let map_height = height + 1 - WINDOW;
    let map_width = width + 1 - WINDOW;
    let strips: Vec<Vec<f32>> = (0..map_height.div_ceil(STRIP_ROWS))
        .into_par_iter()
        .map(|strip| {
            let first = strip * STRIP_ROWS;
            let rows = STRIP_ROWS.min(map_height - first);
            let range = first * width..(first + rows + WINDOW - 1) * width;
            let plane = |image: &Image<[f32; 3]>| Plane {
                samples: image.pixels()[range.clone()].iter().map(|&c| 255.0 * color::luma(Vec3::from(c))).collect(),
                width,
                height: rows + WINDOW - 1,
            };
            let outcome = ssim(&plane(reference), &plane(output), &SsimOptions::default())
                .expect("strips have one size, at least that of the window");
            assert_eq!([outcome.map_width, outcome.map_height], [map_width, rows], "strips must not be shrunk");
            outcome.map
        })
        .collect();
    Image::from_pixels([map_width as u32, map_height as u32], strips.concat()).ok()
}
