//! Invalid colors, to measure the robustness of methods.

use afterimage::Image;
use afterimage::kernel::rng;

const INVALID: [f32; 5] = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e30, -5.0];
/// Purpose of these random numbers, distinct from those of the methods.
const PURPOSE: u32 = 0x706f_6973;

/// `color` with a random share of its pixels replaced by invalid colors.
pub fn among(mut color: Image<[f32; 3]>, share: f32, index: u32) -> Image<[f32; 3]> {
    let width = color.width();
    for (i, pixel) in color.pixels_mut().iter_mut().enumerate() {
        let bits = rng::bits((i % width) as u32, (i / width) as u32, index, PURPOSE);
        if rng::unit_draw(bits) < share {
            *pixel = [INVALID[bits as usize % INVALID.len()]; 3];
        }
    }
    color
}
