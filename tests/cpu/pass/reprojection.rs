//! Reprojection: identity, shifts, conventions, garbage vectors.

use super::*;
use afterimage_testing::holds;

#[test]
fn h51_a_thousand_still_frames_never_move_a_sample() {
    // Every frame has another picture at the same depths: each output pixel is the sample of some frame at that pixel.
    let mut post = context_of(MethodKind::Wrs);
    let mut seen = vec![std::collections::HashSet::new(); 64 * 48];
    let depth = Image::from_fn(SIZE, |[x, y]| 1.0 + ((x / 5) * (y / 3)) as f32);
    let mut kept = 0;
    for index in 0..1000 {
        let input = Input {
            depth: Some(depth.clone()),
            motion: Some(Image::filled(SIZE, [0.0, -0.0])),
            ..Input::still(noise(SIZE, &format!("still {index}")))
        };
        let (out, stats, trace) = one(&mut post, index, &input);
        assert_eq!(stats.rejected(), 0);
        for (i, colors) in seen.iter_mut().enumerate() {
            colors.insert(input.color.pixels()[i].map(f32::to_bits));
            assert!(colors.contains(&out.pixels()[i].map(f32::to_bits)), "frame {index}, pixel {i}");
        }
        kept += trace.pixels().iter().filter(|t| !t.take).count();
    }
    holds!(
        "H51",
        Cpu,
        "wrs, 1000 frames of noise over 200 depths: {kept} samples kept, each at its own pixel, bit for bit"
    );
}

#[test]
fn h52_an_integer_shift_moves_history_exactly_and_marks_the_border_new() {
    let mut post = context(ungated());
    let before = noise(SIZE, "before");
    one(&mut post, 0, &Input::still(before.clone()));
    sticky(&mut post);
    let input = Input { motion: Some(Image::filled(SIZE, [3.0, -2.0])), ..Input::still(noise(SIZE, "after")) };
    let (out, _, trace) = one(&mut post, 1, &input);
    let mut border = 0;
    for y in 0..48_usize {
        for x in 0..64_usize {
            let (qx, qy) = (x + 3, y as i64 - 2);
            if qx < 64 && qy >= 0 {
                assert_eq!(out.at(x, y), before.at(qx, qy as usize));
                assert_eq!(trace.at(x, y).verdict, Verdict::Valid);
            } else {
                assert_eq!(out.at(x, y), input.color.at(x, y));
                assert_eq!(trace.at(x, y).verdict, Verdict::OffScreen);
                border += 1;
            }
        }
    }
    assert_eq!(border, 64 * 48 - 61 * 46);
    holds!("H52", Cpu, "wrs: {} samples moved bit for bit, {border} of the border new", 61 * 46);
}

#[test]
fn every_motion_convention_means_the_same_shift() {
    let before = noise(SIZE, "convention");
    for unit in [MotionUnit::Pixels, MotionUnit::Uv, MotionUnit::Ndc] {
        for direction in [MotionDirection::PreviousMinusCurrent, MotionDirection::CurrentMinusPrevious] {
            for y_axis in [YAxis::Down, YAxis::Up] {
                let convention = MotionConvention { unit, direction, y_axis, jittered: false };
                let scale = convention.to_internal(SIZE);
                let vector = [3.0 / scale[0], -2.0 / scale[1]];
                let desc = ContextDesc { motion: convention, ..ContextDesc::new(SIZE) };
                let mut post = CpuAfterimage::new(&ContextDesc { settings: ungated(), ..desc }).unwrap();
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
    // Computed by hand, not by the function under test: 3 px right to left in a 64 px wide frame.
    let uv = MotionConvention {
        unit: MotionUnit::Uv,
        direction: MotionDirection::CurrentMinusPrevious,
        y_axis: YAxis::Up,
        jittered: false,
    };
    assert_eq!(uv.to_internal([64, 48]), [-64.0, 48.0]);
    let ndc = MotionConvention { unit: MotionUnit::Ndc, ..MotionConvention::default() };
    assert_eq!(ndc.to_internal([64, 48]), [32.0, 24.0]);
}

#[test]
fn h53_half_pixel_motion_never_blurs() {
    // Nearest reprojection moves samples by whole pixels: after 200 frames of 0.5 px every color is still one of the
    // input colors.
    let mut post = context(ungated());
    let mut known = std::collections::HashSet::new();
    let mut kept = 0;
    for index in 0..200 {
        let color = noise(SIZE, &format!("frame {index}"));
        known.extend(color.pixels().iter().map(|c| c.map(f32::to_bits)));
        let input = Input { motion: Some(Image::filled(SIZE, [-0.5, 0.5])), ..Input::still(color) };
        let (out, _, trace) = one(&mut post, index, &input);
        assert!(out.pixels().iter().all(|c| known.contains(&c.map(f32::to_bits))), "H22: no invented colors");
        kept += trace.pixels().iter().filter(|t| !t.take).count();
    }
    holds!(
        "H53",
        Cpu,
        "wrs, 0.5 px x 200: {kept} samples kept, no color that no frame brought; nearest, nothing is mixed"
    );
}

#[test]
fn h54_garbage_motion_shows_the_candidate() {
    let mut post = context(ungated());
    one(&mut post, 0, &Input::still(noise(SIZE, "a")));
    sticky(&mut post);
    for (i, bad) in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e9, -1e9].into_iter().enumerate() {
        let mut motion = Image::filled(SIZE, [0.0; 2]);
        motion.pixels_mut()[5 * 64 + 7] = [bad, 0.0];
        motion.pixels_mut()[6 * 64 + 7] = [0.0, bad];
        let input = Input { motion: Some(motion), ..Input::still(noise(SIZE, "b")) };
        let (out, stats, _) = one(&mut post, 1 + i as u64, &input);
        assert_eq!(stats.verdicts[Verdict::BadMotion as usize], 2);
        assert_eq!(stats.rejected(), 2);
        assert_eq!((out.at(7, 5), out.at(7, 6)), (input.color.at(7, 5), input.color.at(7, 6)));
    }
    holds!("H54", Cpu, "wrs: NaN, infinities, 1e9 and -1e9 on either axis show the candidate, bit for bit");
}

#[test]
fn h59_a_zoom_leaves_no_hole() {
    let before = noise(SIZE, "zoom");
    let zoomed = |factor: f32| {
        let mut post = context_of(MethodKind::Wrs);
        one(&mut post, 0, &Input::still(before.clone()));
        sticky(&mut post);
        // Previous minus current, about pixel (32, 24).
        let motion =
            Image::from_fn(SIZE, |[x, y]| [(x as f32 - 32.0) * (factor - 1.0), (y as f32 - 24.0) * (factor - 1.0)]);
        let input = Input { motion: Some(motion), ..Input::still(noise(SIZE, "zoom 2")) };
        let (out, stats, trace) = one(&mut post, 1, &input);
        let (mut kept, mut sources) = (0, std::collections::HashSet::new());
        for y in 0..48_usize {
            for x in 0..64_usize {
                let source = |at: usize, middle: f32| (middle + (at as f32 - middle) * factor + 0.5).floor();
                let [qx, qy] = [source(x, 32.0), source(y, 24.0)];
                let t = trace.at(x, y);
                if (0.0..64.0).contains(&qx) && (0.0..48.0).contains(&qy) {
                    assert_eq!((out.at(x, y), t.age, t.take), (before.at(qx as usize, qy as usize), 1, false));
                    sources.insert((qx as usize, qy as usize));
                    kept += 1;
                } else {
                    assert_eq!((out.at(x, y), t.age, t.verdict), (input.color.at(x, y), 0, Verdict::OffScreen));
                }
            }
        }
        assert_eq!(stats.rejected(), 64 * 48 - kept);
        [kept, sources.len() as u64]
    };
    let ([near, originals], [far, all]) = (zoomed(0.5), zoomed(2.0));
    assert!(near == 64 * 48 && near > 3 * originals && far == all && far < 1000);
    holds!(
        "H59",
        Cpu,
        "wrs, in x2: {near} show {originals} samples, ages kept; out x2: {far} kept, the rest is the candidate"
    );
}

#[test]
fn h60_a_turn_is_a_full_reset() {
    for method in METHODS {
        let mut post = context_of(method);
        one(&mut post, 0, &Input::still(noise(SIZE, "turn 0")));
        let turn = Input { motion: Some(Image::filled(SIZE, [5000.0, 0.0])), ..Input::still(noise(SIZE, "turn")) };
        let (out, stats, _) = one(&mut post, 1, &turn);
        assert_eq!((out, stats.rejected()), (turn.color, 64 * 48), "{method:?}");
    }
}

/// CPU time of the calling thread.
#[cfg(unix)]
fn thread_ns() -> f64 {
    let t = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    t.tv_sec as f64 * 1e9 + t.tv_nsec as f64
}

#[cfg(unix)]
#[test]
fn h60_a_turn_costs_no_more_than_any_other_frame() {
    const LARGE: [u32; 2] = [256, 192];
    // On one thread, whose time is measured. Normal frames and turns alternate, so that both meet the same load.
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let mut ratios = vec![];
    for method in METHODS {
        let depth = Some(Image::from_fn(LARGE, |[x, y]| 2.0 + (x + y) as f32 * 0.01));
        let frame = |name: &str, motion: f32| Input {
            depth: depth.clone(),
            motion: Some(Image::filled(LARGE, [motion, 0.25])),
            ..Input::still(noise(LARGE, name))
        };
        let (normal, turn) = (frame("cost", 0.25), frame("cost", 5000.0));
        let mut start = CpuAfterimage::new(&ContextDesc {
            settings: Settings { method: method.into(), ..Settings::paper() },
            ..ContextDesc::new(LARGE)
        })
        .unwrap();
        one(&mut start, 0, &frame("before", 0.0));
        let time = |input: &Input| {
            let mut post = start.clone();
            pool.install(|| {
                let from = thread_ns();
                one(&mut post, 1, input);
                thread_ns() - from
            })
        };
        let mut times = [vec![], vec![]];
        for _ in 0..15 {
            times[0].push(time(&normal));
            times[1].push(time(&turn));
        }
        let [normal, turn] = times.map(|mut t| {
            t.sort_by(f64::total_cmp);
            t[t.len() / 2]
        });
        ratios.push(turn / normal);
    }
    assert!(ratios.iter().all(|&r| r < 1.1), "{ratios:?}");
    let [wrs, smr] = ratios[..] else { unreachable!() };
    holds!("H60", Cpu, "all is new, bit for bit; CPU time over a normal frame's: wrs {wrs:.2}, smr {smr:.2}");
}
