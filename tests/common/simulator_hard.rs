//! Hard cases of the foveation simulators, H69 to H71: laws that hold on either executor.

use afterimage::Image;
use afterimage::internal::{Foveation, FoveationKind};
use afterimage_testing::Draws;

/// The laws as tests of an executor. `$run_law` runs one, and returns what it measured.
macro_rules! simulator_laws {
    ($side:ident, $run_law:ident) => {
        crate::laws::laws! { $side, $run_law,
            h69_a_constant_image_stays_constant_at_any_size: "H69", constant;
            h70_the_mean_is_preserved: "H70", mean;
            h71_the_image_has_no_seam_at_the_rings: "H71", ramp;
        }
    };
}
pub(crate) use simulator_laws;

pub type Color = Image<[f32; 3]>;

/// Foveates an image around a gaze position, under 70 degrees, if there is an executor.
pub type Foveate<'a> = &'a dyn Fn(&Foveation, &Color, [f32; 2]) -> Option<Color>;

const CONSTANT: [f32; 3] = [0.3, 0.6, 0.9];
pub const SIZES: [[u32; 2]; 6] = [[1, 1], [17, 1], [1, 33], [4097, 3], [640, 360], [333, 77]];

/// A constant image of that size.
pub fn flat(size: [u32; 2]) -> Color {
    Image::filled(size, CONSTANT)
}

/// The largest difference from the constant.
pub fn off(image: &Color) -> f32 {
    let of = |c: &[f32; 3]| (0..3).map(|i| (c[i] - CONSTANT[i]).abs()).fold(0.0, f32::max);
    image.pixels().iter().map(of).fold(0.0, f32::max)
}

/// A constant image, at every level and through every filter.
pub fn constant(foveate: Foveate<'_>) -> Option<String> {
    let mut worst = 0.0_f32;
    for size in SIZES {
        // Seen from afar all of it is coarsest.
        for level in 1..=8 {
            let foveation = Foveation { rate_mid: 1 << level, rate_far: 1 << level, ..Foveation::default() };
            worst = worst.max(off(&foveate(&foveation, &flat(size), [-1e5, 0.0])?));
        }
        for filter in [FoveationKind::Mip, FoveationKind::Gauss, FoveationKind::Block, FoveationKind::Off] {
            worst =
                worst.max(off(&foveate(&Foveation { kind: filter, ..Foveation::default() }, &flat(size), [0.0; 2])?));
        }
    }
    assert!(worst < 1e-6, "{worst}");
    Some(format!("levels 1 to 8, 1x1, 17x1, 1x33, 4097x3 and two more: off by {worst:.1e} at the most"))
}

/// Random pictures, whose mean the borders can move by chance only as far as their share of the picture reaches.
pub fn mean(foveate: Foveate<'_>) -> Option<String> {
    let mean = |image: &Color| {
        let sum: f64 = image.pixels().iter().flatten().map(|&v| f64::from(v)).sum();
        sum / (3 * image.pixels().len()) as f64
    };
    let mut worst = 0.0_f64;
    for size in [[640, 360], [641, 359], [1023, 257]] {
        let mut draws = Draws::new("energy");
        let image = Image::from_fn(size, |_| [draws.uniform(), draws.uniform(), draws.uniform()]);
        for filter in [FoveationKind::Mip, FoveationKind::Gauss] {
            let foveation = Foveation { kind: filter, rate_mid: 4, rate_far: 8, ..Foveation::default() };
            let change = (mean(&foveate(&foveation, &image, [300.0, 100.0])?) / mean(&image) - 1.0).abs();
            assert!(change <= 1e-3, "{filter:?} {size:?}: mean changes by {change:.1e}");
            worst = worst.max(change);
        }
    }
    Some(format!("mip and gauss, three sizes, odd ones too: the mean changes by {worst:.1e} at the most"))
}

/// A smooth ramp: neighbouring pixels may differ by its step and the slope of the blend, never by a jump.
pub fn ramp(foveate: Foveate<'_>) -> Option<String> {
    let image = Image::from_fn([640, 360], |[x, y]| [x as f32 / 640.0, y as f32 / 360.0, 0.5]);
    let mut worst = 0.0_f32;
    for filter in [FoveationKind::Mip, FoveationKind::Gauss] {
        let out = foveate(&Foveation { kind: filter, ..Foveation::default() }, &image, [320.0, 180.0])?;
        let jump = |a: [f32; 3], b: [f32; 3]| (0..3).map(|i| (a[i] - b[i]).abs()).fold(0.0, f32::max);
        for (x, y) in (17..343).flat_map(|y| (17..623).map(move |x| (x, y))) {
            let [right, below] = [out.at(x + 1, y), out.at(x, y + 1)].map(|next| jump(out.at(x, y), next));
            assert!(right < 2.0 / 640.0 && below < 2.0 / 360.0, "{filter:?} at {x}, {y}");
            worst = worst.max(640.0 * right);
        }
    }
    Some(format!("mip and gauss over a ramp: the steepest step is {worst:.3} of the ramp's own (bound: 2)"))
}
