//! Reprojection: identity, shifts, conventions, garbage vectors.

use super::*;

#[test]
fn h51_a_thousand_still_frames_never_move_a_sample() {
    let mut post = context(Settings { gate: None, ..Settings::paper() });
    let picture = noise(SIZE, "still");
    for index in 0..1000 {
        let (out, stats, _) = one(&mut post, index, &Input::still(picture.clone()));
        assert_eq!(out, picture);
        assert_eq!(stats.flushed(), 0);
    }
}

#[test]
fn h52_an_integer_shift_moves_history_exactly_and_marks_the_border_new() {
    let mut post = context(Settings { gate: None, ..Settings::paper() });
    let before = noise(SIZE, "before");
    one(&mut post, 0, &Input::still(before.clone()));
    sticky(&mut post);
    let input = Input { motion: Some(Image::filled(SIZE, [3.0, -2.0])), ..Input::still(noise(SIZE, "after")) };
    let (out, _, trace) = one(&mut post, 1, &input);
    for y in 0..48_usize {
        for x in 0..64_usize {
            let (qx, qy) = (x + 3, y as i64 - 2);
            if qx < 64 && qy >= 0 {
                assert_eq!(out.at(x, y), before.at(qx, qy as usize));
                assert_eq!(trace.at(x, y).verdict, Verdict::Valid);
            } else {
                assert_eq!(out.at(x, y), input.color.at(x, y));
                assert_eq!(trace.at(x, y).verdict, Verdict::OffScreen);
            }
        }
    }
}

#[test]
fn every_motion_convention_means_the_same_shift() {
    let before = noise(SIZE, "convention");
    for unit in [MotionUnit::Pixels, MotionUnit::Uv, MotionUnit::Ndc] {
        for direction in [MotionDirection::PreviousMinusCurrent, MotionDirection::CurrentMinusPrevious] {
            for y_axis in [YAxis::Down, YAxis::Up] {
                let convention = MotionConvention { unit, direction, y_axis };
                let scale = convention.to_internal(SIZE);
                let vector = [3.0 / scale[0], -2.0 / scale[1]];
                let desc = ContextDesc { motion: convention, ..ContextDesc::new(SIZE) };
                let mut post = CpuAfterimage::new(desc, Settings { gate: None, ..Settings::paper() }).unwrap();
                one(&mut post, 0, &Input::still(before.clone()));
                sticky(&mut post);
                let input = Input { motion: Some(Image::filled(SIZE, vector)), ..Input::still(noise(SIZE, "later")) };
                let (out, ..) = one(&mut post, 1, &input);
                assert_eq!(out.at(10, 10), before.at(13, 8), "{convention:?}");
                // The planted error: the same vector read with the other sign.
                let flipped = Input {
                    motion: Some(Image::filled(SIZE, [-vector[0], vector[1]])),
                    ..Input::still(noise(SIZE, "later"))
                };
                let (out, ..) = one(&mut post, 2, &flipped);
                assert_ne!(out.at(10, 10), before.at(13 + 3, 8), "{convention:?}");
            }
        }
    }
    // By hand, not by the function under test: 3 px right to left in a 64 px wide frame.
    let uv =
        MotionConvention { unit: MotionUnit::Uv, direction: MotionDirection::CurrentMinusPrevious, y_axis: YAxis::Up };
    assert_eq!(uv.to_internal([64, 48]), [-64.0, 48.0]);
    let ndc = MotionConvention { unit: MotionUnit::Ndc, ..MotionConvention::default() };
    assert_eq!(ndc.to_internal([64, 48]), [32.0, 24.0]);
}

#[test]
fn h53_half_pixel_motion_never_blurs() {
    // Nearest reprojection moves samples by whole pixels: after 200 frames of 0.5 px every colour is still one that was put in.
    let mut post = context(Settings { gate: None, ..Settings::paper() });
    let mut known = std::collections::HashSet::new();
    for index in 0..200 {
        let color = noise(SIZE, &format!("frame {index}"));
        known.extend(color.pixels().iter().map(|c| c.map(f32::to_bits)));
        let input = Input { motion: Some(Image::filled(SIZE, [-0.5, 0.5])), ..Input::still(color) };
        let (out, ..) = one(&mut post, index, &input);
        assert!(out.pixels().iter().all(|c| known.contains(&c.map(f32::to_bits))), "H22: no invented colours");
    }
}

#[test]
fn h54_garbage_motion_shows_the_candidate() {
    let mut post = context(Settings { gate: None, ..Settings::paper() });
    one(&mut post, 0, &Input::still(noise(SIZE, "a")));
    sticky(&mut post);
    for (i, bad) in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e9, -1e9].into_iter().enumerate() {
        let mut motion = Image::filled(SIZE, [0.0; 2]);
        motion.pixels_mut()[5 * 64 + 7] = [bad, 0.0];
        motion.pixels_mut()[6 * 64 + 7] = [0.0, bad];
        let input = Input { motion: Some(motion), ..Input::still(noise(SIZE, "b")) };
        let (out, stats, _) = one(&mut post, 1 + i as u64, &input);
        assert_eq!(stats.verdicts[Verdict::BadMotion as usize], 2);
        assert_eq!(stats.flushed(), 2);
        assert_eq!((out.at(7, 5), out.at(7, 6)), (input.color.at(7, 5), input.color.at(7, 6)));
    }
}

#[test]
fn h59_h60_zoom_and_turn_leave_no_hole() {
    let mut post = context(Settings { gate: None, ..Settings::paper() });
    one(&mut post, 0, &Input::still(noise(SIZE, "zoom")));
    // A zoom out by 2: the border comes from outside; inside, texels are skipped.
    let zoom = Image::from_fn(SIZE, |[x, y]| [x as f32 - 32.0, y as f32 - 24.0]);
    let (out, stats, trace) = one(&mut post, 1, &Input { motion: Some(zoom), ..Input::still(noise(SIZE, "zoom 2")) });
    assert!(out.pixels().iter().flatten().all(|v| v.is_finite()));
    assert!(stats.flushed() > 0);
    let kept = trace.pixels().iter().filter(|t| !t.take).count();
    assert!(trace.pixels().iter().filter(|t| !t.take).all(|t| t.age == 1), "ages are kept by duplicates ({kept})");
    // A turn by 180 degrees: everything is off screen, everything is the candidate.
    let turn = Input { motion: Some(Image::filled(SIZE, [5000.0, 0.0])), ..Input::still(noise(SIZE, "turn")) };
    let (out, stats, _) = one(&mut post, 2, &turn);
    assert_eq!(out, turn.color);
    assert_eq!(stats.flushed(), 64 * 48);
}
