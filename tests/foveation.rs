//! Foveation simulators and metrics: hard cases H62, H67-H71, closed forms, and the metrics' own oracles.
#![cfg(feature = "lab")]

mod common;

use afterimage::display::ViewGeometry;
use afterimage::foveation::{Filter, Foveation, Pyramid};
use afterimage::image::Image;
use afterimage::metric::{self, Band, NO_PAST, Scorer, Tracker};
use afterimage::source::SourceFrame;
use approx::assert_abs_diff_eq;
use common::Draws;
use proptest::prelude::*;

const FILTERS: [Filter; 4] = [Filter::Mip, Filter::Gauss, Filter::Block, Filter::Off];

fn noise(size: [u32; 2], name: &str) -> Image<[f32; 3]> {
    let mut draws = Draws::new(name);
    Image::from_fn(size, |_| {
        [draws.uniform(), draws.uniform(), draws.uniform()]
    })
}

fn foveate(foveation: &Foveation, image: &Image<[f32; 3]>, gaze: [f32; 2]) -> Image<[f32; 3]> {
    let geometry = ViewGeometry::flat(image.size(), 70.0).unwrap();
    let ecc = geometry.eccentricity_map(gaze);
    let lods = foveation.lod_map(&geometry, gaze, &ecc);
    foveation.render(&Pyramid::new(image.clone(), foveation.max_level()), &lods)
}

fn mean(image: &Image<[f32; 3]>) -> f64 {
    let sum: f64 = image.pixels().iter().flatten().map(|&v| f64::from(v)).sum();
    sum / (3 * image.pixels().len()) as f64
}

#[test]
fn h69_a_constant_image_stays_constant_at_any_size() {
    for size in [[1, 1], [17, 1], [1, 33], [4097, 3], [640, 360], [333, 77]] {
        for filter in FILTERS {
            let foveation = Foveation {
                filter,
                ..Foveation::default()
            };
            let out = foveate(
                &foveation,
                &Image::filled(size, [0.3, 0.6, 0.9]),
                [0.0, 0.0],
            );
            for c in out.pixels() {
                for (v, exact) in c.iter().zip([0.3, 0.6, 0.9]) {
                    assert_abs_diff_eq!(*v, exact, epsilon = 1e-6);
                }
            }
        }
    }
}

#[test]
fn h70_the_mean_is_preserved() {
    // Random pictures, whose mean the borders can move by chance only as far as their share of the picture reaches.
    for size in [[640, 360], [641, 359], [1023, 257]] {
        let image = noise(size, "energy");
        for filter in [Filter::Mip, Filter::Gauss] {
            let foveation = Foveation {
                filter,
                rate_mid: 4,
                rate_far: 8,
                ..Foveation::default()
            };
            let change =
                (mean(&foveate(&foveation, &image, [300.0, 100.0])) / mean(&image) - 1.0).abs();
            println!("{filter:?} {size:?}: mean changes by {change:.1e}");
            assert!(change <= 1e-3);
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
    assert_abs_diff_eq!(
        level.at(2, 1)[0],
        (at(4, 2) + at(5, 2) + at(4, 3) + at(5, 3)) / 4.0,
        epsilon = 1e-6
    );
    assert_abs_diff_eq!(
        level.at(6, 1)[0],
        (at(12, 2) + at(12, 3)) / 2.0,
        epsilon = 1e-6
    );
    assert_abs_diff_eq!(level.at(6, 3)[0], at(12, 6), epsilon = 1e-6);
    // A texel's centre is between its pixels.
    assert_abs_diff_eq!(
        pyramid.bilinear([4.5, 2.5], 1).x,
        level.at(2, 1)[0],
        epsilon = 1e-6
    );
    // A linear ramp is reproduced by any level, away from the borders.
    let ramp = Pyramid::new(
        Image::from_fn([256, 128], |[x, y]| [x as f32, y as f32, 0.0]),
        4,
    );
    for level in 1..=4 {
        let c = ramp.bilinear([100.0, 50.0], level);
        assert_abs_diff_eq!(c.x, 100.0, epsilon = 1e-3);
        assert_abs_diff_eq!(c.y, 50.0, epsilon = 1e-3);
    }
}

#[test]
fn the_fovea_is_copied_bit_for_bit_and_the_rest_is_coarser() {
    let image = noise([640, 360], "fovea");
    let geometry = ViewGeometry::flat([640, 360], 70.0).unwrap();
    let gaze = [200.0, 150.0];
    for filter in [Filter::Mip, Filter::Gauss, Filter::Block] {
        let out = foveate(
            &Foveation {
                filter,
                ..Foveation::default()
            },
            &image,
            gaze,
        );
        let mut outside_same = 0;
        for y in 0..360 {
            for x in 0..640 {
                let e = geometry.eccentricity_deg([x as f32, y as f32], gaze);
                let same = out.at(x, y) == image.at(x, y);
                if e < 2.4 {
                    // Blocks are decided by their centres.
                    assert!(
                        same || filter == Filter::Block && e > 1.0,
                        "{filter:?} at {e} degrees"
                    );
                }
                outside_same += usize::from(same && e > 8.0);
            }
        }
        assert!(outside_same < 20, "{filter:?}: {outside_same}");
    }
}

#[test]
fn h71_the_level_of_detail_is_continuous_and_monotone() {
    for filter in [Filter::Mip, Filter::Gauss] {
        let foveation = Foveation {
            filter,
            ..Foveation::default()
        };
        let mut before = foveation.lod(0.0);
        assert_eq!(before, 0.0);
        for i in 1..=90_000 {
            let lod = foveation.lod(i as f32 * 1e-3);
            // At most 3 levels a degree (mip), 2^lod growing by 2.8 a degree from 1 (gauss): 0.005 levels a step.
            assert!(
                lod >= before && lod - before < 0.005,
                "{filter:?} at {}",
                i as f32 * 1e-3
            );
            before = lod;
        }
        assert_abs_diff_eq!(before, 4.0, epsilon = 1e-3);
    }
    let foveation = Foveation::default();
    for (e, lod) in [
        (2.5, 0.0),
        (3.0, 1.5),
        (3.5, 3.0),
        (7.5, 3.0),
        (8.0, 3.5),
        (8.5, 4.0),
        (60.0, 4.0),
    ] {
        assert_abs_diff_eq!(foveation.lod(e), lod, epsilon = 1e-5);
    }
    let hard = Foveation {
        blend_deg: 0.0,
        ..foveation
    };
    assert_eq!((hard.lod(2.5), hard.lod(2.501)), (0.0, 3.0));
}

#[test]
fn h71_the_image_has_no_seam_at_the_rings() {
    // A smooth ramp: neighbouring pixels may differ by its own step and what the blend adds, never by a jump.
    let image = Image::from_fn([640, 360], |[x, y]| {
        [x as f32 / 640.0, y as f32 / 360.0, 0.5]
    });
    for filter in [Filter::Mip, Filter::Gauss] {
        let out = foveate(
            &Foveation {
                filter,
                ..Foveation::default()
            },
            &image,
            [320.0, 180.0],
        );
        let jump =
            |a: [f32; 3], b: [f32; 3]| (0..3).map(|i| (a[i] - b[i]).abs()).fold(0.0, f32::max);
        for y in 17..343 {
            for x in 17..623 {
                assert!(
                    jump(out.at(x, y), out.at(x + 1, y)) < 2.0 / 640.0
                        && jump(out.at(x, y), out.at(x, y + 1)) < 2.0 / 360.0
                );
            }
        }
    }
}

#[test]
fn blocks_are_aligned_nested_and_constant() {
    let image = noise([320, 180], "blocks");
    let foveation = Foveation {
        filter: Filter::Block,
        ..Foveation::default()
    };
    let geometry = ViewGeometry::flat([320, 180], 70.0).unwrap();
    let gaze = [100.0, 90.0];
    let lods = foveation.lod_map(&geometry, gaze, &geometry.eccentricity_map(gaze));
    let out = foveation.render(&Pyramid::new(image, 4), &lods);
    for y in 0..180_usize {
        for x in 0..320_usize {
            let level = lods.at(x, y) as usize;
            let (bx, by) = (x >> level << level, y >> level << level);
            assert_eq!(lods.at(bx, by) as usize, level);
            assert_eq!(out.at(x, y), out.at(bx, by));
        }
    }
    for level in 0..=4 {
        assert!(
            lods.pixels().contains(&(level as f32)),
            "level {level} occurs"
        );
    }
}

#[test]
fn h62_angles_follow_rays_not_the_screen() {
    // 110 degrees wide: the same pixel distance is a smaller angle at the side. 2 atan(tan(55) (x + 0.5 - 500) / 500) by hand.
    let geometry = ViewGeometry::flat([1000, 500], 110.0).unwrap();
    let angle = |x: f64| {
        (55.0_f64.to_radians().tan() * (x + 0.5 - 500.0) / 500.0)
            .atan()
            .to_degrees()
    };
    for (a, b) in [(500.0, 550.0), (900.0, 950.0), (0.0, 999.0)] {
        let got = geometry.eccentricity_deg([a as f32, 249.5], [b as f32, 249.5]);
        assert_abs_diff_eq!(f64::from(got), (angle(b) - angle(a)).abs(), epsilon = 1e-3);
    }
    assert_abs_diff_eq!(geometry.hfov_deg(), 110.0, epsilon = 1e-3);
    let right_eye = ViewGeometry::off_axis([1000, 1000], [-0.8, 1.2], [-1.0, 1.0]).unwrap();
    assert_abs_diff_eq!(right_eye.ray([399.5, 499.5]).x, 0.0, epsilon = 1e-6);
    let px = right_eye
        .project(right_eye.ray([12.0, 34.0]) * 7.0)
        .unwrap();
    assert_abs_diff_eq!(px[0], 12.0, epsilon = 1e-3);
    assert!(right_eye.project(glam::Vec3::NEG_Z).is_none());
}

#[test]
fn h67_small_gaze_movements_enlarge_the_area_seen_sharp() {
    let size = [640, 360];
    let geometry = ViewGeometry::flat(size, 70.0).unwrap();
    let foveation = Foveation::default();
    let sharp = |gazes: &[[f32; 2]]| {
        let mut seen = Image::filled(size, false);
        for &gaze in gazes {
            let ecc = geometry.eccentricity_map(gaze);
            let lods = foveation.lod_map(&geometry, gaze, &ecc);
            for (s, &l) in seen.pixels_mut().iter_mut().zip(lods.pixels()) {
                *s |= l < 0.25;
            }
        }
        seen.pixels().iter().filter(|&&s| s).count() as f64
    };
    // Half a degree either way in x: the union of discs of radius r over a segment of length d has area pi r^2 + 2 r d.
    let still = sharp(&[[320.0, 180.0]]);
    let px_per_deg = 640.0 / (2.0 * 35.0_f64.to_radians().tan()) * 1.0_f64.to_radians();
    let gazes: Vec<[f32; 2]> = (-5..=5)
        .map(|i| [320.0 + (0.1 * f64::from(i) * px_per_deg) as f32, 180.0])
        .collect();
    let moving = sharp(&gazes);
    let r = (still / std::f64::consts::PI).sqrt();
    let predicted = still + 2.0 * r * px_per_deg;
    println!(
        "sharp area {still} px still, {moving} px with microsaccades, predicted {predicted:.0}"
    );
    assert!(moving >= 0.98 * predicted);
}

#[test]
fn h68_the_error_at_the_true_gaze_grows_with_latency() {
    let size = [640, 360];
    let image = noise(size, "latency");
    let reference = metric::encode(&image, 0.0);
    let geometry = ViewGeometry::flat(size, 70.0).unwrap();
    // The eye moves at 30 degrees a second; the foveation lags.
    let errors: Vec<f64> = [0.0, 30.0, 60.0, 100.0, 150.0]
        .iter()
        .map(|latency_ms| {
            let lag_px = 30.0 * latency_ms / 1000.0 * 8.0;
            let shown = metric::encode(
                &foveate(&Foveation::default(), &image, [320.0 - lag_px, 180.0]),
                0.0,
            );
            let mut frame = source_frame(image.clone());
            frame.cut = true;
            let ecc = geometry.eccentricity_map([320.0, 180.0]);
            let tracked = Tracker::default().advance(&frame, &geometry, &ecc, &ecc);
            let mut scorer = Scorer::default();
            scorer.push(&reference, &shown, &tracked, &ecc);
            scorer.scores().bands[0].mse.unwrap()
        })
        .collect();
    println!("mean squared error in the true fovea by latency: {errors:.4?}");
    assert_eq!(errors[0], 0.0);
    assert!(errors.windows(2).all(|w| w[0] <= w[1]));
}

#[test]
fn a_bad_pixel_does_not_spread() {
    let mut image = Image::filled([64, 64], [0.5; 3]);
    image.pixels_mut()[20 * 64 + 33] = [f32::NAN, 0.5, f32::INFINITY];
    for filter in FILTERS {
        let out = foveate(
            &Foveation {
                filter,
                ..Foveation::default()
            },
            &image,
            [0.0, 0.0],
        );
        for (i, c) in out.pixels().iter().enumerate() {
            assert!(
                c.iter().all(|v| v.is_finite()) || i == 20 * 64 + 33,
                "{filter:?}"
            );
        }
    }
}

#[test]
fn settings_that_contradict_are_refused() {
    let base = Foveation::default();
    for (foveation, words) in [
        (
            Foveation {
                fovea_deg: 20.0,
                ..base
            },
            "at most the middle region's 15 degrees",
        ),
        (
            Foveation {
                rate_mid: 3,
                ..base
            },
            "a power of two",
        ),
        (
            Foveation {
                rate_far: 4,
                ..base
            },
            "from 8 to",
        ),
        (
            Foveation {
                rate_far: 1 << 20,
                ..base
            },
            "to 256",
        ),
        (
            Foveation {
                blend_deg: -1.0,
                ..base
            },
            "0 to 90 degrees",
        ),
        (
            Foveation {
                mid_deg: f32::NAN,
                ..base
            },
            "0 to 180 degrees",
        ),
    ] {
        let message = foveation.validate().unwrap_err().to_string();
        assert!(message.contains(words), "{message}");
    }
}

proptest! {
    #![proptest_config(common::property("foveation", 40))]

    #[test]
    fn any_gaze_and_size_stays_inside_the_picture_s_range(w in 1u32..90, h in 1u32..90, gx in -1e6f32..1e6, gy in -1e6f32..1e6, pick in 0usize..3) {
        let image = noise([w, h], "range");
        let foveation = Foveation { filter: FILTERS[pick], ..Foveation::default() };
        for gaze in [[gx, gy], [gx % 90.0, gy % 90.0]] {
            let out = foveate(&foveation, &image, gaze);
            prop_assert!(out.pixels().iter().flatten().all(|v| (-1e-5..=1.0 + 1e-5).contains(v)));
        }
    }
}

// ---- metrics -----------------------------------------------------------------------------------------------------------

fn source_frame(color: Image<[f32; 3]>) -> SourceFrame {
    SourceFrame {
        color,
        depth: None,
        motion: None,
        previous_from_current: None,
        cut: false,
        nonfinite: 0,
    }
}

#[test]
fn psnr_ssim_and_flicker_of_known_errors() {
    let size = [96, 64];
    let geometry = ViewGeometry::flat(size, 70.0).unwrap();
    let ecc = geometry.eccentricity_map([48.0, 32.0]);
    let reference = Image::filled(size, [0.5; 3]);
    let mut tracker = Tracker::default();
    let mut scorer = Scorer::default();
    for (i, offset) in [0.1_f32, -0.1, 0.1].into_iter().enumerate() {
        let frame = SourceFrame {
            cut: i == 0,
            ..source_frame(reference.clone())
        };
        let tracked = tracker.advance(&frame, &geometry, &ecc, &ecc);
        scorer.push(
            &reference,
            &reference.map(|c| c.map(|v| v + offset)),
            &tracked,
            &ecc,
        );
    }
    let scores = scorer.scores();
    assert_abs_diff_eq!(scores.whole.psnr_db.unwrap(), 20.0, epsilon = 1e-4);
    assert_abs_diff_eq!(scores.bands[2].psnr_db.unwrap(), 20.0, epsilon = 1e-4);
    assert_abs_diff_eq!(scores.flicker.unwrap(), 200.0, epsilon = 1e-2);
    // Flat patches leave SSIM its luminance term alone: (2 ab + c1) / (a^2 + b^2 + c1).
    let luminance = |a: f64, b: f64| (2.0 * a * b + 6.5025) / (a * a + b * b + 6.5025);
    let expected = (2.0 * luminance(127.5, 153.0) + luminance(127.5, 102.0)) / 3.0;
    assert_abs_diff_eq!(scores.whole.ssim.unwrap(), expected, epsilon = 1e-4);
    // An exact picture has no PSNR.
    let mut exact = Scorer::default();
    let tracked = tracker.advance(&source_frame(reference.clone()), &geometry, &ecc, &ecc);
    exact.push(&reference, &reference, &tracked, &ecc);
    let scores = exact.scores();
    assert_eq!((scores.whole.psnr_db, scores.whole.mse), (None, Some(0.0)));
    assert_abs_diff_eq!(scores.whole.ssim.unwrap(), 1.0, epsilon = 1e-6);
}

/// SSIM by its definition in f64, window by window.
fn ssim64(a: &Image<[f32; 3]>, b: &Image<[f32; 3]>, x0: usize, y0: usize) -> f64 {
    let luma = |c: [f32; 3]| {
        255.0 * (0.2126 * f64::from(c[0]) + 0.7152 * f64::from(c[1]) + 0.0722 * f64::from(c[2]))
    };
    let gauss = |d: usize| (-0.5 * ((d as f64 - 5.0) / 1.5).powi(2)).exp();
    let (mut sum, mut ma, mut mb, mut aa, mut bb, mut ab) = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
    for y in 0..11 {
        for x in 0..11 {
            let w = gauss(x) * gauss(y);
            let (p, q) = (luma(a.at(x0 + x, y0 + y)), luma(b.at(x0 + x, y0 + y)));
            sum += w;
            ma += w * p;
            mb += w * q;
            aa += w * p * p;
            bb += w * q * q;
            ab += w * p * q;
        }
    }
    let (ma, mb) = (ma / sum, mb / sum);
    let (va, vb, cov) = (aa / sum - ma * ma, bb / sum - mb * mb, ab / sum - ma * mb);
    let (c1, c2) = (2.55_f64.powi(2), 7.65_f64.powi(2));
    (2.0 * ma * mb + c1) * (2.0 * cov + c2) / ((ma * ma + mb * mb + c1) * (va + vb + c2))
}

#[test]
fn ssim_is_the_published_formula_at_full_resolution() {
    // Taller than a strip, and larger than the size from which the authors' script would shrink it.
    let (a, mut b) = (noise([400, 420], "ssim a"), noise([400, 420], "ssim b"));
    for (p, q) in b.pixels_mut().iter_mut().zip(a.pixels()) {
        *p = [0, 1, 2].map(|i| 0.6 * q[i] + 0.4 * p[i]);
    }
    let map = metric::ssim_map(&a, &b).unwrap();
    assert_eq!(map.size(), [390, 410]);
    for (x, y) in [
        (0, 0),
        (389, 409),
        (17, 127),
        (17, 128),
        (200, 255),
        (3, 300),
    ] {
        assert_abs_diff_eq!(
            f64::from(map.at(x, y)),
            ssim64(&a, &b, x, y),
            epsilon = 1e-3
        );
    }
    assert!(metric::ssim_map(&noise([10, 40], "s"), &noise([10, 40], "t")).is_none());
}

#[test]
fn bands_and_retention_follow_the_eye() {
    assert_eq!(
        [0.0, 2.49, 2.5, 7.5, 7.51].map(|e| Band::of(e) as usize),
        [0, 0, 1, 1, 2]
    );
    let size = [320, 180];
    let geometry = ViewGeometry::flat(size, 70.0).unwrap();
    let foveation = Foveation::default();
    let mut tracker = Tracker::default();
    let mut look = |frame: &SourceFrame, gaze| {
        let ecc = geometry.eccentricity_map(gaze);
        let lods = foveation.lod_map(&geometry, gaze, &ecc);
        tracker.advance(frame, &geometry, &ecc, &lods)
    };
    let mut frame = source_frame(noise(size, "track"));
    frame.cut = true;
    let first = look(&frame, [100.0, 90.0]);
    assert!(
        first.past.pixels().iter().all(|&p| p == NO_PAST)
            && !first.retained.pixels().contains(&true)
    );
    frame.cut = false;
    let second = look(&frame, [220.0, 90.0]);
    assert!(
        second.retained.at(100, 90) && !second.retained.at(220, 90) && !second.retained.at(160, 20)
    );
    assert_eq!(second.past.at(7, 3), 3 * 320 + 7);
    // All moves right by 5 px: retention moves along.
    frame.motion = Some(Image::filled(size, [-5.0, 0.0]));
    let third = look(&frame, [220.0, 90.0]);
    let left_edge = |t: &metric::Tracked| (0..320).find(|&x| t.retained.at(x, 90)).unwrap();
    assert_eq!(left_edge(&third), left_edge(&second) + 5);
    assert_eq!(third.past.at(2, 0), NO_PAST, "came from outside");
    // Something else stands there now: forgotten for good.
    frame.motion = Some(Image::filled(size, [0.0; 2]));
    frame.depth = Some(Image::filled(size, 5.0));
    look(&frame, [220.0, 90.0]);
    let mut depth = Image::filled(size, 5.0);
    depth.pixels_mut()[90 * 320 + 105] = 1.0;
    frame.depth = Some(depth);
    let hidden = look(&frame, [220.0, 90.0]);
    assert!(!hidden.retained.at(105, 90));
}
