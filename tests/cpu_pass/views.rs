//! Several views, lost gaze, settings.

use super::*;
use afterimage::foveation::Foveation;

#[test]
fn h27_stereo_views_never_read_each_other() {
    let stereo = ContextDesc { view_count: 2, ..ContextDesc::new(SIZE) };
    let settings = Settings { gate: None, ..Settings::paper() };
    let fresh = || CpuAfterimage::new(stereo, settings).unwrap();
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
        let mut post = context(Settings { gate: None, ..Settings::paper() });
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
}

#[test]
fn h66_a_saccade_keeps_the_old_fovea() {
    let mut post = context(Settings { gate: None, ..Settings::paper() });
    let sharp = noise(SIZE, "sharp");
    for index in 0..18 {
        one(&mut post, index, &Input { gaze: Gaze::At { px: [10.0, 24.0] }, ..Input::still(sharp.clone()) });
    }
    let blurred = Input { gaze: Gaze::At { px: [55.0, 24.0] }, ..Input::still(Image::filled(SIZE, [0.5; 3])) };
    let (out, ..) = one(&mut post, 18, &blurred);
    let kept =
        (5..15).flat_map(|x| (20..28).map(move |y| (x, y))).filter(|&(x, y)| out.at(x, y) == sharp.at(x, y)).count();
    assert!(kept >= 78, "{kept} of 80 sharp samples kept the first frame after");
}

#[test]
fn settings_are_checked_and_named() {
    let base = Settings::paper();
    let fovea = |fovea_deg| Foveation { fovea_deg, ..Foveation::default() };
    for (settings, name) in [
        (Settings { foveation: fovea(-1.0), ..base }, "fovea"),
        (Settings { foveation: fovea(f32::NAN), ..base }, "fovea"),
        (Settings { bias: Bias::Exponential { lambda: -0.1 }, ..base }, "bias lambda"),
        (Settings { depth_test: Some(DepthTest { relative: 0.0, slope_px: 1.0 }), ..base }, "depth_test.relative"),
    ] {
        let error = CpuAfterimage::new(ContextDesc::new(SIZE), settings).unwrap_err();
        assert_eq!(error.setting, name);
        let mut post = context(base);
        assert!(post.set_settings(settings).is_err());
        assert_eq!(*post.settings(), base);
    }
}
