//! Properties of the filters' output on the GPU: hard cases H69, H70, H71.

use super::rig::*;
use afterimage::{Filter, Foveation, Image};
use afterimage_testing::Draws;
use afterimage_testing::holds;
use approx::assert_abs_diff_eq;

/// Foveated on the GPU; `None` without one.
fn show(foveation: Foveation, image: &Image<[f32; 3]>, gaze_px: [f32; 2]) -> Option<Image<[f32; 3]>> {
    let mut rig = Rig::new(&desc(image.size(), 1, foveation))?;
    let made = rig.on_gpu(&Scene::mono(image.clone(), gaze_px));
    let pixels = made.shown.iter().map(|c| c.map(f32::from_bits)).collect();
    Some(Image::from_pixels(image.size(), pixels).unwrap())
}

#[test]
fn h69_a_constant_image_stays_constant_at_any_size() {
    // Seen from afar all of it is coarsest: at every level.
    let (sizes, mut worst) = ([[1, 1], [17, 1], [1, 33], [4097, 3], [640, 360], [333, 77]], 0.0_f32);
    for (size, level) in sizes.into_iter().flat_map(|size| (1..=8).map(move |level| (size, level))) {
        let foveation = Foveation { rate_mid: 1 << level, rate_far: 1 << level, ..Foveation::default() };
        let Some(out) = show(foveation, &Image::filled(size, [0.3, 0.6, 0.9]), [-1e5, 0.0]) else { return };
        for c in out.pixels() {
            worst = c.iter().zip([0.3, 0.6, 0.9]).fold(worst, |w, (v, exact)| w.max((v - exact).abs()));
        }
    }
    assert!(worst < 1e-6, "{worst}");
    for size in sizes {
        for filter in [Filter::Mip, Filter::Gauss, Filter::Block, Filter::Off] {
            let foveation = Foveation { filter, ..Foveation::default() };
            let Some(out) = show(foveation, &Image::filled(size, [0.3, 0.6, 0.9]), [0.0, 0.0]) else { return };
            for c in out.pixels() {
                for (v, exact) in c.iter().zip([0.3, 0.6, 0.9]) {
                    assert_abs_diff_eq!(*v, exact, epsilon = 1e-6);
                }
            }
        }
    }
    holds!("H69", Gpu, "levels 1 to 8, 1x1, 17x1, 1x33, 4097x3 and two more: off by {worst:.1e} at the most");
}

fn mean(image: &Image<[f32; 3]>) -> f64 {
    let sum: f64 = image.pixels().iter().flatten().map(|&v| f64::from(v)).sum();
    sum / (3 * image.pixels().len()) as f64
}

#[test]
fn h70_the_mean_is_preserved() {
    let mut worst = 0.0_f64;
    for size in [[640, 360], [641, 359]] {
        let mut draws = Draws::new("energy");
        let image = Image::from_fn(size, |_| [draws.uniform(), draws.uniform(), draws.uniform()]);
        for filter in [Filter::Mip, Filter::Gauss] {
            let foveation = Foveation { filter, rate_mid: 4, rate_far: 8, ..Foveation::default() };
            let Some(out) = show(foveation, &image, [300.0, 100.0]) else { return };
            let change = (mean(&out) / mean(&image) - 1.0).abs();
            println!("{filter:?} {size:?}: mean changes by {change:.1e}");
            assert!(change <= 1e-3);
            worst = worst.max(change);
        }
    }
    holds!("H70", Gpu, "mip and gauss, 640x360 and 641x359: the mean changes by {worst:.1e} at the most");
}

#[test]
fn h71_the_image_has_no_seam_at_the_rings() {
    let image = Image::from_fn([640, 360], |[x, y]| [x as f32 / 640.0, y as f32 / 360.0, 0.5]);
    let mut worst = 0.0_f32;
    for filter in [Filter::Mip, Filter::Gauss] {
        let foveation = Foveation { filter, ..Foveation::default() };
        let Some(out) = show(foveation, &image, [320.0, 180.0]) else { return };
        let jump = |a: [f32; 3], b: [f32; 3]| (0..3).map(|i| (a[i] - b[i]).abs()).fold(0.0, f32::max);
        let ramp =
            (17..343).flat_map(|y| (17..623).map(move |x| (x, y))).map(|(x, y)| jump(out.at(x, y), out.at(x + 1, y)));
        worst = worst.max(640.0 * ramp.fold(0.0, f32::max));
        for y in 17..343 {
            for x in 17..623 {
                assert!(
                    jump(out.at(x, y), out.at(x + 1, y)) < 2.0 / 640.0
                        && jump(out.at(x, y), out.at(x, y + 1)) < 2.0 / 360.0
                );
            }
        }
    }
    holds!("H71", Gpu, "mip and gauss over a ramp: the steepest step is {worst:.3} of the ramp's own (bound: 2)");
}
