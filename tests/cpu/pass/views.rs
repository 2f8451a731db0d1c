//! Several views, lost gaze, settings.

use super::*;
use crate::settings::{ungated, wrs};
use afterimage::{Foveation, Wrs};
use afterimage_testing::holds;

#[test]
fn h27_stereo_views_never_read_each_other() {
    let stereo = ContextDesc { view_count: 2, ..ContextDesc::new(SIZE) };
    let settings = ungated();
    let fresh = || CpuAfterimage::new(&ContextDesc { settings, ..stereo }).unwrap();
    let [mut both, mut left_only, mut right_only] = [fresh(), fresh(), fresh()];
    let mut mono = context(settings);
    let junk = Input { gaze: Gaze::Lost, ..Input::still(Image::filled(SIZE, [f32::NAN, 9.0, 1e9])) };
    let mut eyes_differ = false;
    for index in 0..20 {
        let left = Input::still(noise(SIZE, &format!("left {index}")));
        let gaze = Gaze::At { px: [50.0, 30.0] };
        let right = Input { gaze, ..Input::still(noise(SIZE, &format!("right {index}"))) };
        let both_out = step(&mut both, index, Reset::None, &[&left, &right]).0;
        assert_eq!(both_out[0], step(&mut left_only, index, Reset::None, &[&left, &junk]).0[0], "left");
        assert_eq!(both_out[1], step(&mut right_only, index, Reset::None, &[&junk, &right]).0[1], "right");
        assert_eq!(both_out[0], one(&mut mono, index, &left).0, "as if it were alone");
        // The same input to both eyes still draws different numbers.
        let same_out = step(&mut both.clone(), index, Reset::None, &[&left, &left]).0;
        eyes_differ |= same_out[0] != same_out[1];
    }
    assert!(eyes_differ);
}

#[test]
fn h63_a_lost_gaze_is_held_then_centred_at_the_start() {
    let held = |gazes: &[Gaze]| {
        let mut post = context(ungated());
        let mut weights = vec![];
        for (i, &gaze) in gazes.iter().enumerate() {
            let (_, _, trace) = one(&mut post, i as u64, &Input { gaze, ..Input::still(noise(SIZE, "gaze")) });
            assert!(trace.pixels().iter().all(|t| t.weight.is_finite() && t.weight > 0.0));
            weights = trace.pixels().iter().map(|t| t.weight).collect();
        }
        weights
    };
    let at = |px| Gaze::At { px };
    let there = held(&[at([9.0, 9.0])]);
    assert_eq!(held(&[at([9.0, 9.0]), Gaze::Lost]), there);
    assert_eq!(held(&[at([9.0, 9.0]), at([f32::NAN, 3.0])]), there);
    assert_eq!(held(&[at([9.0, 9.0]), Gaze::Lost, at([f32::INFINITY, 3.0])]), there);
    assert_eq!(held(&[Gaze::Lost]), held(&[at([31.5, 23.5])]));
    held(&[at([-5000.0, 1e30])]);
    // smr and taa: the output depends on the resolved gaze position, and on that alone.
    for method in [MethodKind::Wrs, MethodKind::Smr] {
        let shown = |gazes: &[Gaze]| {
            let mut post = context_of(method);
            let frames = gazes.iter().enumerate();
            let input = |i, gaze| Input { gaze, ..Input::still(noise(SIZE, &format!("gaze {i}"))) };
            frames.map(|(i, &gaze)| one(&mut post, i as u64, &input(i, gaze)).0).collect::<Vec<_>>()
        };
        let nan = at([3.0, f32::NAN]);
        let expected = shown(&[at([31.5, 23.5]), at([9.0, 9.0]), at([9.0, 9.0]), at([9.0, 9.0])]);
        assert_eq!(shown(&[Gaze::Lost, at([9.0, 9.0]), Gaze::Lost, nan]), expected, "{method:?}");
        assert_ne!(shown(&[Gaze::Lost, at([9.0, 9.0]), Gaze::Lost, at([50.0, 9.0])]), expected, "{method:?}");
    }
    holds!(
        "H63",
        Cpu,
        "wrs and smr: lost, NaN and infinite are held, the middle before any; 1e30 px off: weights finite"
    );
}

#[test]
fn h66_a_saccade_keeps_the_old_fovea_and_it_decays_as_theory_says() {
    // Degrees are 6 pixels, so that a fovea of 5 degrees is some 700 of them.
    const WIDE: [u32; 2] = [480, 48];
    let view = geometry(WIDE);
    let [old, new] = [20.0_f32, 0.0].map(|e| view.project([-e.to_radians().tan(), 0.0, 1.0]).unwrap());
    let mut post = CpuAfterimage::new(&ContextDesc { settings: ungated(), ..ContextDesc::new(WIDE) }).unwrap();
    let frame = |index: u64, px| Input { gaze: Gaze::At { px }, ..Input::still(noise(WIDE, &format!("h66 {index}"))) };
    for index in 0..18 {
        one(&mut post, index, &frame(index, old));
    }
    let fovea: Vec<usize> =
        (0..480 * 48).filter(|i| view.eccentricity_deg([(i % 480) as f32, (i / 480) as f32], old) < 2.5).collect();
    // Sums and survival of each pixel in f64: 18 candidates of weight 1, then those of its new eccentricity b: a = a^2
    // / (a + b) + b.
    let weight = |e: f64| {
        let d = |e: f64| (0.9851 / (1.0 + e / 1.058).powi(2) + 0.0149 * (-e / 22.14).exp()) / (1.0 + e / 41.03);
        (d(e) / d(2.5)).min(1.0)
    };
    let b: Vec<f64> =
        fovea.iter().map(|i| weight(view.eccentricity_deg([(i % 480) as f32, (i / 480) as f32], new).into())).collect();
    let mut sums = vec![(0..17).fold(1.0_f64, |a, _| a * a / (a + 1.0) + 1.0); fovea.len()];
    let mut alive = vec![1.0_f64; fovea.len()];
    let mut half_life = None;
    for n in 1..=100_u64 {
        let (_, _, trace) = one(&mut post, 17 + n, &frame(17 + n, new));
        for ((a, s), b) in sums.iter_mut().zip(&mut alive).zip(&b) {
            *a = *a * *a / (*a + b) + b;
            *s *= 1.0 - b / *a;
        }
        // The sample is from one of the 18 frames, so at least as old as the saccade.
        let kept = fovea.iter().filter(|&&i| u64::from(trace.pixels()[i].age) >= n).count() as f64;
        let (mean, variance) = alive.iter().fold((0.0, 0.0), |(m, v), s| (m + s, v + s * (1.0 - s)));
        if [1, 10, 30, 63, 100].contains(&n) {
            afterimage_testing::accept(
                &format!("{n} frames after: {kept} of {mean:.1} kept"),
                afterimage_testing::p_of_z((kept - mean) / f64::sqrt(variance)),
            );
        }
        if n == 63 {
            // Plain sums, without decay: 18 of 18 + n b.
            let plain: Vec<f64> = b.iter().map(|b| 18.0 / (18.0 + 63.0 * b)).collect();
            let (mean, variance) = plain.iter().fold((0.0, 0.0), |(m, v), s| (m + s, v + s * (1.0 - s)));
            afterimage_testing::reject("without bias", afterimage_testing::p_of_z((kept - mean) / f64::sqrt(variance)));
        }
        if kept < 0.5 * fovea.len() as f64 {
            half_life.get_or_insert(n);
        }
    }
    let half_life = half_life.expect("half of it is gone in 100 frames");
    // n50 = ln 2 (a0 + b) / b + (ln 2)^2 / 2 with a0 = 5.42 and b of 20 degrees.
    let ln2 = std::f64::consts::LN_2;
    let theory = ln2 * (5.42 + weight(20.0)) / weight(20.0) + ln2 * ln2 / 2.0;
    assert!((half_life as f64 - theory).abs() < 10.0, "{half_life} for {theory}");
    holds!(
        "H66",
        Cpu,
        "wrs: {} px of the old fovea, half of them gone after {half_life} frames, by theory {theory:.1}",
        fovea.len()
    );
}

#[test]
fn settings_are_checked_and_named() {
    let base = Settings::paper();
    let fovea = |fovea_deg| Foveation { fovea_deg, ..Foveation::default() };
    for (settings, name) in [
        (Settings { foveation: fovea(-1.0), ..base }, "fovea"),
        (Settings { foveation: fovea(f32::NAN), ..base }, "fovea"),
        (wrs(Wrs { bias: Bias::Exponential { lambda: -0.1 }, ..Wrs::default() }), "bias lambda"),
        (Settings { depth_test: Some(DepthTest { relative: 0.0, slope_px: 1.0 }), ..base }, "depth_test.relative"),
    ] {
        let error = CpuAfterimage::new(&ContextDesc { settings, ..ContextDesc::new(SIZE) }).unwrap_err();
        assert_eq!(error.setting, name);
        let mut post = context(base);
        assert!(post.set_settings(settings).is_err());
        assert_eq!(post.desc().settings, base);
    }
}
