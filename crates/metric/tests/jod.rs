//! The foveated video metric: what it must see, must not see, and must survive.

use afterimage::{Image, ViewGeometry};
use afterimage_metric::csf::sensitivity;
use afterimage_metric::{Display, ReferenceVideo, TestVideo, VideoScore, Viewing};
use std::f32::consts::TAU;

const SIZE: [u32; 2] = [160, 96];
const MIDDLE: [f32; 2] = [80.0, 48.0];
type Frame = Image<[f32; 3]>;

fn viewing() -> Viewing {
    let geometry = ViewGeometry::flat(SIZE, 30.0).unwrap();
    Viewing { geometry, display: Display::default(), fps: 60.0 }
}

/// Scores of a video: reference and test of each frame number, and the gaze.
fn score_seen(
    viewing: Viewing,
    frames: usize,
    gaze: impl Fn(usize) -> Option<[f32; 2]>,
    reference: impl Fn(usize) -> Frame,
    test: impl Fn(usize) -> Frame,
) -> VideoScore {
    let (mut references, mut video) = (ReferenceVideo::new(viewing), TestVideo::default());
    for i in 0..frames {
        video.push(&references.push(&reference(i), gaze(i)), &test(i));
    }
    video.score().unwrap()
}

fn score(reference: impl Fn(usize) -> Frame, test: impl Fn(usize) -> Frame) -> VideoScore {
    score_seen(viewing(), 12, |_| Some(MIDDLE), reference, test)
}

/// A textured picture that moves to the right by a pixel a frame.
fn scene(frame: usize) -> Frame {
    Image::from_fn(SIZE, |[x, y]| {
        let (x, y) = (x as f32 - frame as f32, y as f32);
        let v = 0.5 + 0.18 * (0.21 * x + 0.1 * y).sin() + 0.12 * (0.9 * x).sin() * (0.7 * y).cos();
        [v, v * 0.9, v * 0.8]
    })
}

/// `frame` with `f` of each pixel's place and color.
fn changed(frame: &Frame, f: impl Fn(usize, usize, f32) -> f32) -> Frame {
    let width = frame.width();
    let mut out = frame.clone();
    for (i, pixel) in out.pixels_mut().iter_mut().enumerate() {
        *pixel = pixel.map(|v| f(i % width, i / width, v));
    }
    out
}

/// Noise in [-1, 1] of a place and a seed.
fn noise(x: usize, y: usize, seed: usize) -> f32 {
    let mut h = (x as u32).wrapping_mul(0x9e37_79b9)
        ^ (y as u32).wrapping_mul(0x85eb_ca6b)
        ^ (seed as u32).wrapping_mul(0xc2b2_ae35);
    h = (h ^ (h >> 15)).wrapping_mul(0x2c1b_3c6d);
    h = (h ^ (h >> 12)).wrapping_mul(0x297a_2d39);
    ((h ^ (h >> 15)) >> 8) as f32 / 8_388_608.0 - 1.0
}

fn blurred(frame: &Frame, radius: isize) -> Frame {
    let (w, h) = (frame.width() as isize, frame.height() as isize);
    Image::from_fn(SIZE, |[x, y]| {
        let mut sum = [0.0; 3];
        for d in -radius..=radius {
            for e in -radius..=radius {
                let (x, y) = ((x as isize + d).clamp(0, w - 1), (y as isize + e).clamp(0, h - 1));
                let c = frame.at(x as usize, y as usize);
                sum.iter_mut().zip(c).for_each(|(s, v)| *s += v);
            }
        }
        sum.map(|s| s / ((2 * radius + 1) * (2 * radius + 1)) as f32)
    })
}

/// Sine grating of linear contrast on mid grey, sRGB-encoded.
fn grating(contrast: f32, cpd: f32) -> Frame {
    let pixels_per_degree = viewing().pixels_per_degree();
    let encode = afterimage::kernel::color::srgb_encode;
    Image::from_fn(SIZE, |[x, _]| {
        let phase = TAU * cpd * x as f32 / pixels_per_degree;
        [encode(0.2 * (1.0 + contrast * phase.sin())); 3]
    })
}

/// Asserts that the scores of growing distortions fall, and prints them.
fn falls(what: &str, scores: &[f64]) {
    println!("{what}: {scores:.3?}");
    assert!(scores.windows(2).all(|s| s[1] < s[0]), "{what}: {scores:?}");
}

#[test]
fn identical_videos_have_10() {
    let score = score(scene, scene);
    assert_eq!(score.jod, 10.0);
    assert_eq!(score.bands, [Some(10.0); 3]);
}

#[test]
fn more_of_a_distortion_is_worse() {
    let of = |test: &dyn Fn(usize) -> Frame| score(scene, test).jod;
    falls("blur", &[0, 1, 2, 4].map(|r| of(&|i| blurred(&scene(i), r))));
    let noisy = |i: usize, a: f32, seed: usize| changed(&scene(i), |x, y, v| v + a * noise(x, y, seed));
    falls("still noise", &[0.0, 0.02, 0.05, 0.15].map(|a| of(&|i| noisy(i, a, 1))));
    falls("new noise", &[0.0, 0.02, 0.05, 0.15].map(|a| of(&|i| noisy(i, a, i))));
    falls(
        "flicker",
        &[0.0, 0.02, 0.05, 0.2]
            .map(|a| of(&|i| changed(&scene(i), |_, _, v| v * if i % 2 == 0 { 1.0 - a } else { 1.0 + a }))),
    );
    falls(
        "contrast",
        &[0.0, 0.1, 0.3, 0.6].map(|a| of(&|i| changed(&scene(i), |_, _, v| 0.5 + (v - 0.5) * (1.0 - a)))),
    );
    falls(
        "blocks",
        &[1, 2, 4, 8].map(|side| {
            of(&|i| {
                let frame = scene(i);
                Image::from_fn(SIZE, |[x, y]| frame.at((x / side * side) as usize, (y / side * side) as usize))
            })
        }),
    );
}

/// Hard case H68: latency. Each frame late shifts the moving scene by a pixel.
#[test]
fn h68_a_later_picture_is_worse() {
    let late = [0, 1, 2, 4].map(|k: usize| score(|i| scene(i + 4), |i| scene(i + 4 - k)).jod);
    falls("frames late", &late);
}

/// The fovea follows the eye late: the coarse picture stays where the eye looks.
#[test]
fn h68_a_late_fovea_is_worse() {
    let size = [320, 96];
    let geometry = ViewGeometry::flat(size, 50.0).unwrap();
    // Faint, because strong texture masks its own blur whatever the eccentricity.
    let texture = |x: f32, y: f32| 0.5 + 0.03 * (1.3 * x).sin() * (1.1 * y).cos();
    let frame = |sharp_from: f32| {
        Image::from_fn(size, |[x, y]| {
            let near = (x as f32 - sharp_from).hypot(y as f32 - 48.0) < 40.0;
            let side = if near { 1 } else { 2 };
            [texture((x / side * side) as f32, (y / side * side) as f32); 3]
        })
    };
    let full = Image::from_fn(size, |[x, y]| [texture(x as f32, y as f32); 3]);
    let gaze = |i: i32| 100.0 + 8.0 * i as f32;
    let viewing = Viewing { geometry, ..viewing() };
    let late = [0, 3, 6, 12].map(|k: i32| {
        let test = |i: usize| frame(gaze(i as i32 - k));
        score_seen(viewing, 20, |i| Some([gaze(i as i32), 48.0]), |_| full.clone(), test)
    });
    for (what, scores) in [("frame", late.map(|s| s.jod)), ("fovea", late.map(|s| s.bands[0].unwrap()))] {
        println!("{what}, fovea late by 0, 3, 6 and 12 frames: {scores:.3?}");
        assert!(scores[1..].iter().all(|&late| late < scores[0]), "{what}: {scores:?}");
    }
}

#[test]
fn what_the_eye_looks_at_counts_most_and_a_mirrored_gaze_is_caught() {
    let left = |i: usize| changed(&scene(i), |x, y, v| if x < 30 { v + 0.1 * noise(x, y, i) } else { v });
    let at = |x: f32| score_seen(viewing(), 12, |_| Some([x, 48.0]), scene, left);
    let (near, far) = (at(15.0), at(145.0));
    println!("noise at the left, gaze left {near:.3?}, right {far:.3?}");
    assert!(near.jod + 0.1 < far.jod, "a mirrored gaze would not be seen");
    assert!(near.bands[0].unwrap() < near.bands[2].unwrap());
    assert_eq!(far.bands[0], Some(10.0));
}

/// The contrast that one detects in half of the cases must cost little, in a patch 6 degrees wide.
#[test]
fn a_grating_at_its_threshold_is_just_seen_at_any_eccentricity() {
    let (cpd, geometry) = (1.0, viewing().geometry);
    let losses = [0.0, 5.0, 10.0, 20.0].map(|ecc_deg: f32| {
        let threshold = 1.0 / sensitivity(cpd, 0.0, ecc_deg, 50.0, std::f32::consts::PI * 9.0);
        let gaze = [80.0 + 80.0 * ecc_deg.to_radians().tan() / 15.0_f32.to_radians().tan(), 48.0];
        let loss = |times: f32| {
            let (grey, all) = (grating(0.0, cpd), grating(times * threshold, cpd));
            let test = Image::from_fn(SIZE, |[x, y]| {
                let is_inside = geometry.eccentricity_deg([x as f32 + 0.5, y as f32 + 0.5], MIDDLE) < 3.0;
                if is_inside { &all } else { &grey }.at(x as usize, y as usize)
            });
            10.0 - score_seen(viewing(), 2, |_| Some(gaze), |_| grey.clone(), |_| test.clone()).jod
        };
        [loss(1.0), loss(4.0)]
    });
    println!("loss at the threshold and at 4 times it, at 0, 5, 10 and 20 degrees: {losses:.3?}");
    for [one, four] in losses {
        assert!(one > 0.0005 && one < 0.5 && four > 3.0 * one, "{losses:?}");
    }
}

/// JOD lost by FovVideoVDP 1.2.2 for a grating of contrast 0.25 in a ring 8 degrees wide around the gaze: eccentricity
/// in degrees, cycles per degree in the middle, gaze in degrees to the right. 640x200 pixels over 110 degrees, two
/// frames.
#[test]
fn rings_in_a_wide_view_have_about_the_loss_that_fovvideovdp_gives_them() {
    let size = [640, 200];
    let geometry = ViewGeometry::flat(size, 110.0).unwrap();
    let viewing = Viewing { geometry, ..viewing() };
    let encode = afterimage::kernel::color::srgb_encode;
    let grey = Image::filled(size, [encode(0.2); 3]);
    let rows = [
        (0.0, 0.5, 0.0, 0.845),
        (10.0, 0.5, 0.0, 1.899),
        (20.0, 0.5, 0.0, 2.567),
        (30.0, 0.5, 0.0, 2.509),
        (40.0, 0.5, 0.0, 2.291),
        (50.0, 0.5, 0.0, 1.776),
        (0.0, 1.0, 0.0, 0.768),
        (10.0, 1.0, 0.0, 1.681),
        (20.0, 1.0, 0.0, 1.933),
        (30.0, 1.0, 0.0, 1.481),
        (40.0, 1.0, 0.0, 1.113),
        (50.0, 1.0, 0.0, 0.420),
        (0.0, 1.0, 45.0, 0.924),
        (20.0, 1.0, 45.0, 1.227),
        (20.0, 0.5, 45.0, 2.071),
        (40.0, 1.0, 45.0, 0.812_f64),
    ];
    let mut sum = 0.0;
    for (ecc_deg, cpd, gaze_deg, theirs) in rows {
        let tangent: f32 = (gaze_deg as f32).to_radians().tan() / 55.0_f32.to_radians().tan();
        let gaze = [320.0 + 320.0 * tangent, 100.0];
        let test = Image::from_fn(size, |[x, y]| {
            let off: f32 = geometry.eccentricity_deg([x as f32 + 0.5, y as f32 + 0.5], gaze) - ecc_deg;
            let wave = (TAU * cpd * x as f32 / viewing.pixels_per_degree()).sin();
            [encode(0.2 * (1.0 + if off.abs() < 4.0 { 0.25 * wave } else { 0.0 })); 3]
        });
        let ours = 10.0 - score_seen(viewing, 2, |_| Some(gaze), |_| grey.clone(), |_| test.clone()).jod;
        println!("{cpd} cpd at {ecc_deg} degrees, gaze {gaze_deg}: loses {ours:.3}, FovVideoVDP {theirs:.3}");
        sum += (ours - theirs).abs();
    }
    let mean = sum / rows.len() as f64;
    println!("mean difference {mean:.3}");
    // 0.255 without the magnification off the axis, 1.08 with the loss of thresholds.
    assert!(mean < 0.18, "{mean}");
}

/// JOD of FovVideoVDP 1.2.2 for gratings and edges of 160x90 pixels at 8 pixels a degree, gaze in the middle, 250
/// cd/m2, 1000:1, two frames; mean grey of a fifth of white, 1 cycle a degree. The constants are fitted to them, too.
#[test]
fn gratings_have_about_the_loss_that_fovvideovdp_gives_them() {
    let size = [160, 90];
    let tangent_per_px = 2.0 * (0.5_f32 / 8.0).to_radians().tan();
    let hfov_deg = 2.0 * (0.5 * tangent_per_px * 160.0).atan().to_degrees();
    let viewing = Viewing { geometry: ViewGeometry::flat(size, hfov_deg).unwrap(), ..viewing() };
    let encode = afterimage::kernel::color::srgb_encode;
    let wave = |x: u32, phase: f32| (TAU * x as f32 / 8.0 + 0.7 + phase).sin();
    let picture = |f: &dyn Fn(u32, u32) -> f32| Image::from_fn(size, |[x, y]| [encode(f(x, y)); 3]);
    let inside = |x: u32, y: u32, r: f32| (x as f32 - 80.0).hypot(y as f32 - 45.0) < r;
    let step = |x: u32| if x / 20 % 2 == 1 { 0.3 } else { 0.1 };
    type Luminance<'a> = &'a dyn Fn(u32, u32) -> f32;
    let rows: [(&str, f64, Luminance<'_>, Luminance<'_>); 11] = [
        ("contrast 0.05", 2.067, &|_, _| 0.2, &|x, _| 0.2 * (1.0 + 0.05 * wave(x, 0.0))),
        ("contrast 0.2", 5.647, &|_, _| 0.2, &|x, _| 0.2 * (1.0 + 0.2 * wave(x, 0.0))),
        ("contrast 0.8", 7.005, &|_, _| 0.2, &|x, _| 0.2 * (1.0 + 0.8 * wave(x, 0.0))),
        ("patch of 0.1", 0.676, &|_, _| 0.2, &|x, y| {
            0.2 * (1.0 + if inside(x, y, 6.0) { 0.1 * wave(x, 0.0) } else { 0.0 })
        }),
        ("patch of 0.4", 1.131, &|_, _| 0.2, &|x, y| {
            0.2 * (1.0 + if inside(x, y, 6.0) { 0.4 * wave(x, 0.0) } else { 0.0 })
        }),
        ("0.4 lowered by 0.1", 0.040, &|x, _| 0.2 * (1.0 + 0.4 * wave(x, 0.0)), &|x, _| {
            0.2 * (1.0 + 0.36 * wave(x, 0.0))
        }),
        ("0.4 lowered by 0.4", 0.853, &|x, _| 0.2 * (1.0 + 0.4 * wave(x, 0.0)), &|x, _| {
            0.2 * (1.0 + 0.24 * wave(x, 0.0))
        }),
        ("0.4 shifted by 0.5", 0.980, &|x, _| 0.2 * (1.0 + 0.4 * wave(x, 0.0)), &|x, _| {
            0.2 * (1.0 + 0.4 * wave(x, 0.5))
        }),
        ("half as bright", 0.322, &|_, _| 0.2, &|_, _| 0.1),
        ("1.5 times as bright", 0.122, &|_, _| 0.2, &|_, _| 0.3),
        ("edges lowered by 0.2", 0.345, &|x, _| step(x), &|x, _| 0.2 + 0.8 * (step(x) - 0.2)),
    ];
    let mut sum = 0.0;
    for (what, theirs, reference, test) in rows {
        let frames = [picture(reference), picture(test)];
        let seen = score_seen(viewing, 2, |_| Some([80.0, 45.0]), |_| frames[0].clone(), |_| frames[1].clone());
        let ours = 10.0 - seen.jod;
        println!("{what}: loses {ours:.3}, FovVideoVDP {theirs:.3}");
        sum += (ours - theirs).abs();
    }
    let mean = sum / 11.0;
    println!("mean difference {mean:.3}");
    assert!(mean < 0.35, "{mean}");
}

#[test]
fn planted_errors_are_caught() {
    let noisy = |i: usize| changed(&scene(i), |x, y, v| v + 0.05 * noise(x, y, 3));
    let right = score(scene, noisy).jod;
    let linear = |frame: Frame| changed(&frame, |_, _, v| afterimage::kernel::color::srgb_decode(v));
    let as_linear = score(|i| linear(scene(i)), |i| linear(noisy(i))).jod;
    // Two frames change places.
    let swapped = |i: usize| {
        noisy(if i % 4 == 1 {
            i + 1
        } else if i % 4 == 2 {
            i - 1
        } else {
            i
        })
    };
    let out_of_order = score(scene, swapped).jod;
    let radians = Viewing { geometry: ViewGeometry::flat(SIZE, 30.0_f32.to_radians()).unwrap(), ..viewing() };
    let in_radians = score_seen(radians, 12, |_| Some(MIDDLE), scene, noisy).jod;
    let slow = score_seen(
        Viewing { fps: 6.0, ..viewing() },
        12,
        |_| Some(MIDDLE),
        scene,
        |i| changed(&scene(i), |x, y, v| v + 0.05 * noise(x, y, i)),
    );
    let fast = score(scene, |i| changed(&scene(i), |x, y, v| v + 0.05 * noise(x, y, i)));
    println!(
        "right {right:.3}; linear {as_linear:.3}; out of order {out_of_order:.3}; radians {in_radians:.3}; new noise at \
         6 fps {:.3}, at 60 {:.3}",
        slow.jod, fast.jod
    );
    for wrong in [as_linear, out_of_order, in_radians] {
        assert!((wrong - right).abs() > 0.1, "{wrong} {right}");
    }
    assert!((slow.jod - fast.jod).abs() > 0.1);
}

#[test]
fn hard_input_gives_a_finite_score() {
    let nan = |i: usize| changed(&scene(i), |x, y, v| if (x, y) == (80, 48) && i == 3 { f32::NAN } else { v });
    let with_nan = score(scene, nan);
    assert!(with_nan.jod.is_finite() && with_nan.jod < 10.0, "{with_nan:?}");
    // It is black for that frame, and no more.
    let black = |i: usize| changed(&scene(i), |x, y, v| if (x, y) == (80, 48) && i == 3 { 0.0 } else { v });
    assert_eq!(with_nan, score(scene, black));
    let huge = score(scene, |i| changed(&scene(i), |_, _, v| if v > 0.6 { f32::INFINITY } else { -v }));
    assert!(huge.jod.is_finite(), "{huge:?}");
    let one = score_seen(viewing(), 1, |_| None, scene, |i| blurred(&scene(i), 2));
    assert!(one.jod < 10.0 && one.jod.is_finite());
    for (fps, contrast) in [(0.0, 1000.0), (f32::NAN, 1000.0), (f32::INFINITY, 1000.0), (60.0, 0.0)] {
        let viewing = Viewing { fps, display: Display { contrast, ..Display::default() }, ..viewing() };
        let seen = score_seen(viewing, 2, |_| Some(MIDDLE), scene, |i| blurred(&scene(i), 2));
        assert!(seen.jod.is_finite(), "{fps} {contrast}: {seen:?}");
    }
    assert_eq!(TestVideo::default().score(), None);
    assert!(TestVideo::default().heat_map().is_none());
    for size in [[1, 1], [1, 7], [2, 2], [3, 200], [17, 5]] {
        let viewing = Viewing { geometry: ViewGeometry::flat(size, 20.0).unwrap(), ..viewing() };
        let flat = |v: f32| Image::filled(size, [v; 3]);
        let score = score_seen(viewing, 3, |_| Some([0.0, 0.0]), |_| flat(0.5), |_| flat(0.1));
        assert!(score.jod.is_finite() && score.jod < 10.0, "{size:?}: {score:?}");
    }
}

#[test]
fn a_lost_gaze_holds_and_a_gaze_outside_counts() {
    let test = |i: usize| changed(&scene(i), |x, y, v| if x < 40 { v + 0.1 * noise(x, y, i) } else { v });
    let held = score_seen(viewing(), 9, |_| Some([20.0, 48.0]), scene, test);
    let lost = score_seen(viewing(), 9, |i| (i < 3).then_some([20.0, 48.0]), scene, test);
    let broken = score_seen(viewing(), 9, |i| Some(if i < 3 { [20.0, 48.0] } else { [f32::NAN, 0.0] }), scene, test);
    assert!(held == lost && held == broken);
    let outside = score_seen(viewing(), 9, |_| Some([-200.0, 48.0]), scene, test);
    println!("at it {held:.3?}, outside {outside:.3?}");
    assert!(outside.jod > held.jod && outside.bands[0].is_none());
}

#[test]
fn the_number_of_threads_changes_no_bit() {
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| score(scene, |i| changed(&scene(i), |x, y, v| v + 0.05 * noise(x, y, i))))
    };
    let one = run(1);
    assert!([2, 3, 7].map(run).iter().all(|other| *other == one));
}

#[test]
fn the_heat_map_shows_where() {
    let (mut references, mut video) = (ReferenceVideo::new(viewing()), TestVideo::default());
    let frame = references.push(&scene(0), Some(MIDDLE));
    video.push(&frame, &changed(&scene(0), |x, y, v| if x > 130 { v + 0.2 * noise(x, y, 1) } else { v }));
    let map = video.heat_map().unwrap();
    assert_eq!(map.size(), SIZE);
    let mean = |columns: std::ops::Range<usize>| {
        let count = (columns.len() * map.height()) as f32;
        (0..map.height()).flat_map(|y| columns.clone().map(move |x| (x, y))).map(|(x, y)| map.at(x, y)).sum::<f32>()
            / count
    };
    println!("left {}, right {}", mean(0..60), mean(135..160));
    assert!(mean(135..160) > 0.5 && mean(0..60) < 0.05);
}
