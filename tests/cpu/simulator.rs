//! Foveation simulators: hard cases H62, H67, H69-H71, and closed forms.

use crate::images::{noise, pixel, pixels};
use crate::simulator_hard::*;
use afterimage::internal::{Foveation, FoveationKind, Pyramid};
use afterimage::kernel::foveate;
use afterimage::{Image, ViewGeometry};
use afterimage_testing::holds;
use approx::assert_abs_diff_eq;
use proptest::prelude::*;

const FILTERS: [FoveationKind; 4] =
    [FoveationKind::Mip, FoveationKind::Gauss, FoveationKind::Block, FoveationKind::Off];

/// Levels of detail of a view of 70 degrees.
fn lods(foveation: &Foveation, size: [u32; 2], gaze: [f32; 2]) -> Image<f32> {
    let geometry = ViewGeometry::flat(size, 70.0).unwrap();
    foveation.lod_map(&geometry, gaze)
}

fn foveate(foveation: &Foveation, image: &Image<[f32; 3]>, gaze: [f32; 2]) -> Image<[f32; 3]> {
    foveation.render(&Pyramid::new(image.clone(), foveation.max_level()), &lods(foveation, image.size(), gaze))
}

/// What a law measured.
fn run_law(law: fn(Foveate<'_>) -> Option<String>) -> Option<String> {
    law(&|foveation, image, gaze_px| Some(foveate(foveation, image, gaze_px)))
}

simulator_laws!(Cpu, run_law);

#[test]
fn h69_levels_between_keep_a_constant_image() {
    let foveation = Foveation { rate_mid: 256, rate_far: 256, ..Foveation::default() };
    for size in SIZES {
        let pyramid = Pyramid::new(flat(size), foveation.max_level());
        for lod in (0..=32).map(|l| l as f32 / 4.0) {
            assert!(off(&foveation.render(&pyramid, &Image::filled(size, lod))) < 1e-6, "{size:?}, level {lod}");
        }
    }
}

#[test]
fn mip_levels_are_means_of_the_texels_that_exist() {
    let image = noise([13, 7], "levels");
    let pyramid = Pyramid::new(image.clone(), 3);
    assert_eq!(pyramid.level(1).size(), [7, 4]);
    assert_eq!(pyramid.level(2).size(), [4, 2]);
    assert_eq!(pyramid.level(3).size(), [2, 1]);
    let at = |x: usize, y: usize| image.at(x, y)[0];
    let level = pyramid.level(1);
    assert_abs_diff_eq!(level.at(2, 1)[0], (at(4, 2) + at(5, 2) + at(4, 3) + at(5, 3)) / 4.0, epsilon = 1e-6);
    assert_abs_diff_eq!(level.at(6, 1)[0], (at(12, 2) + at(12, 3)) / 2.0, epsilon = 1e-6);
    assert_abs_diff_eq!(level.at(6, 3)[0], at(12, 6), epsilon = 1e-6);
    // A texel's centre is between its pixels.
    assert_abs_diff_eq!(pyramid.bilinear([4.5, 2.5], 1)[0], level.at(2, 1)[0], epsilon = 1e-6);
    // A linear ramp is reproduced by any level, away from the borders.
    let ramp = Pyramid::new(Image::from_fn([256, 128], |[x, y]| [x as f32, y as f32, 0.0]), 4);
    for level in 1..=4 {
        let c = ramp.bilinear([100.0, 50.0], level);
        assert_abs_diff_eq!(c[0], 100.0, epsilon = 1e-3);
        assert_abs_diff_eq!(c[1], 50.0, epsilon = 1e-3);
    }
}

#[test]
fn the_fovea_is_copied_bit_for_bit_and_the_rest_is_coarser() {
    let image = noise([640, 360], "fovea");
    let geometry = ViewGeometry::flat([640, 360], 70.0).unwrap();
    let gaze = [200.0, 150.0];
    for filter in [FoveationKind::Mip, FoveationKind::Gauss, FoveationKind::Block] {
        let out = foveate(&Foveation { kind: filter, ..Foveation::default() }, &image, gaze);
        let mut outside_same = 0;
        for px in pixels([640, 360]) {
            let e = geometry.eccentricity_deg(px.map(|v| v as f32), gaze);
            let same = pixel(&out, px) == pixel(&image, px);
            // Centres decide whether blocks are used.
            assert!(e >= 2.4 || same || filter == FoveationKind::Block && e > 1.0, "{filter:?} at {e} degrees");
            outside_same += usize::from(same && e > 8.0);
        }
        assert!(outside_same < 20, "{filter:?}: {outside_same}");
    }
}

#[test]
fn h71_the_level_of_detail_is_continuous_and_monotone() {
    for filter in [FoveationKind::Mip, FoveationKind::Gauss] {
        let foveation = Foveation { kind: filter, ..Foveation::default() };
        let mut before = foveation.lod(0.0);
        assert_eq!(before, 0.0);
        for i in 1..=90_000 {
            let lod = foveation.lod(i as f32 * 1e-3);
            // At most 3 levels a degree (mip), 2^lod growing by 2.8 a degree from 1 (gauss): 0.005 levels a step.
            assert!(lod >= before && lod - before < 0.005, "{filter:?} at {}", i as f32 * 1e-3);
            before = lod;
        }
        assert_abs_diff_eq!(before, 4.0, epsilon = 1e-3);
    }
    let foveation = Foveation::default();
    for (e, lod) in [(2.5, 0.0), (3.0, 1.5), (3.5, 3.0), (7.5, 3.0), (8.0, 3.5), (8.5, 4.0), (60.0, 4.0)] {
        assert_abs_diff_eq!(foveation.lod(e), lod, epsilon = 1e-5);
    }
    let hard = Foveation { blend_deg: 0.0, ..foveation };
    assert_eq!((hard.lod(2.5), hard.lod(2.501)), (0.0, 3.0));
    let steps = (0..90_000).map(|i| foveation.lod((i + 1) as f32 * 1e-3) - foveation.lod(i as f32 * 1e-3));
    let steepest = 1000.0 * steps.fold(0.0, f32::max);
    holds!(
        "H71",
        Cpu,
        "level of detail: continuous, monotone, at the most {steepest:.2} levels a degree (stated: 3, +- rounding)"
    );
}

#[test]
fn a_blurred_point_is_a_gaussian() {
    assert!((0..=8).all(|level| foveate::blur_sigma_px(level as f32) == 0.5 * ((1 << level) - 1) as f32));
    // Far out the width is constant, so that the two passes together are exact: weights by f64, cut at 3 standard
    // deviations.
    let mut image = Image::filled([91, 91], [0.0; 3]);
    image.pixels_mut()[45 * 91 + 45] = [1000.0, 100.0, 1.0];
    let foveation = Foveation { kind: FoveationKind::Gauss, ..Foveation::default() };
    let out = foveate(&foveation, &image, [-1e5, 0.0]);
    let sigma = 7.5_f64;
    let radius = foveate::gauss_radius(sigma as f32) as i32;
    let weight = |d: i32| if d.abs() <= radius { (-0.5 * f64::from(d * d) / (sigma * sigma)).exp() } else { 0.0 };
    let total: f64 = (-radius..=radius).map(weight).sum();
    for px in pixels([91, 91]) {
        let exact = px.map(|v| weight(v as i32 - 45)).iter().product::<f64>() / (total * total);
        for (v, peak) in pixel(&out, px).iter().zip([1000.0, 100.0, 1.0]) {
            assert_abs_diff_eq!(f64::from(*v) / peak, exact, epsilon = 1e-7);
        }
    }
}

#[test]
fn blocks_are_aligned_nested_and_constant() {
    let image = noise([320, 180], "blocks");
    let foveation = Foveation { kind: FoveationKind::Block, ..Foveation::default() };
    let lods = lods(&foveation, [320, 180], [100.0, 90.0]);
    let out = foveation.render(&Pyramid::new(image, 4), &lods);
    for px in pixels([320, 180]) {
        let level = pixel(&lods, px) as u32;
        let first = px.map(|v| v >> level << level);
        assert_eq!((pixel(&lods, first) as u32, pixel(&out, first)), (level, pixel(&out, px)));
    }
    for level in 0..=4 {
        assert!(lods.pixels().contains(&(level as f32)), "level {level} occurs");
    }
}

#[test]
fn h62_angles_follow_rays_not_the_screen() {
    // 110 degrees wide: the same pixel distance is a smaller angle at the side. 2 atan(tan(55) (x + 0.5 - 500) / 500)
    // by hand.
    let geometry = ViewGeometry::flat([1000, 500], 110.0).unwrap();
    let mut worst = 0.0_f64;
    let angle = |x: f64| (55.0_f64.to_radians().tan() * (x + 0.5 - 500.0) / 500.0).atan().to_degrees();
    for (a, b) in [(500.0, 550.0), (900.0, 950.0), (0.0, 999.0)] {
        let got = geometry.eccentricity_deg([a as f32, 249.5], [b as f32, 249.5]);
        assert_abs_diff_eq!(f64::from(got), (angle(b) - angle(a)).abs(), epsilon = 1e-3);
        worst = worst.max((f64::from(got) - (angle(b) - angle(a)).abs()).abs());
    }
    // Every pixel of the row, for a gaze off the middle. Planted error: distance on the screen, which is tens of
    // degrees off.
    let map = geometry.eccentricity_map([900.0, 249.5]);
    let mut by_screen = 0.0_f64;
    for x in 0..1000 {
        let exact = (angle(x as f64) - angle(900.0)).abs();
        worst = worst.max((f64::from(geometry.eccentricity_deg([x as f32, 249.5], [900.0, 249.5])) - exact).abs());
        by_screen = by_screen.max(((x as f64 - 900.0).abs() * 110.0 / 1000.0 - exact).abs());
        assert!((f64::from(map.at(x, 249)) - exact).abs() < 0.2, "the row next to the axis");
    }
    assert!(worst < 1e-3 && by_screen > 5.0, "{worst}, {by_screen}");
    assert_abs_diff_eq!(geometry.hfov_deg(), 110.0, epsilon = 1e-3);
    let right_eye = ViewGeometry::off_axis([1000, 1000], [-0.8, 1.2], [-1.0, 1.0]).unwrap();
    assert_abs_diff_eq!(right_eye.ray([399.5, 499.5])[0], 0.0, epsilon = 1e-6);
    let px = right_eye.project(right_eye.ray([12.0, 34.0]).map(|v| v * 7.0)).unwrap();
    assert_abs_diff_eq!(px[0], 12.0, epsilon = 1e-3);
    assert!(right_eye.project([0.0, 0.0, -1.0]).is_none());
    holds!(
        "H62",
        Cpu,
        "110 degrees, eye at the side: off by {worst:.1e} degrees; distance on the screen {by_screen:.0} degrees"
    );
}

#[test]
fn a_bad_pixel_does_not_spread() {
    let mut image = Image::filled([64, 64], [0.5; 3]);
    image.pixels_mut()[20 * 64 + 33] = [f32::NAN, 0.5, f32::INFINITY];
    for filter in FILTERS {
        let out = foveate(&Foveation { kind: filter, ..Foveation::default() }, &image, [0.0, 0.0]);
        for (i, c) in out.pixels().iter().enumerate() {
            assert!(c.iter().all(|v| v.is_finite()) || i == 20 * 64 + 33, "{filter:?}");
        }
    }
    // In coarse regions of any gaze the pixel itself is black or blurred, too.
    for filter in [FoveationKind::Mip, FoveationKind::Gauss, FoveationKind::Block] {
        for x in (0..64).step_by(9) {
            let foveation = Foveation { kind: filter, rate_mid: 2, rate_far: 4, ..Foveation::default() };
            let gaze = [x as f32, 0.0];
            let lods = lods(&foveation, [64, 64], gaze);
            let out = foveate(&foveation, &image, gaze);
            for (c, lod) in out.pixels().iter().zip(lods.pixels()) {
                assert!(c.iter().all(|v| v.is_finite()) || *lod == 0.0, "{filter:?}");
            }
        }
    }
}

proptest! {
    #![proptest_config(afterimage_testing::property("foveation", 40))]

    #[test]
    fn any_gaze_and_size_stays_inside_the_picture_s_range(w in 1u32..90, h in 1u32..90, gx in -1e6f32..1e6, gy in -1e6f32..1e6, pick in 0usize..3) {
        let image = noise([w, h], "range");
        let foveation = Foveation { kind: FILTERS[pick], ..Foveation::default() };
        for gaze in [[gx, gy], [gx % 90.0, gy % 90.0]] {
            let out = foveate(&foveation, &image, gaze);
            prop_assert!(out.pixels().iter().flatten().all(|v| (-1e-5..=1.0 + 1e-5).contains(v)));
        }
    }
}
