//! The pass as a whole on the CPU: conventions, flushes, determinism, lifecycle; hard cases H19, H22, H29, H46-H60, H63, H66, H77-H79.

mod common;

use afterimage::convention::{
    DepthConvention, MotionConvention, MotionDirection, MotionUnit, YAxis,
};
use afterimage::cpu::{CpuAfterimage, CpuFrame, CpuView, FrameStats, PixelTrace};
use afterimage::display::ViewGeometry;
use afterimage::error::FrameError;
use afterimage::frame::{ContextDesc, Gaze, Reset, ViewFrame};
use afterimage::image::Image;
use afterimage::kernel::reproject::Verdict;
use afterimage::settings::{Bias, DepthTest, Method, Sampler, Settings};
use common::Draws;
use proptest::prelude::*;

const SIZE: [u32; 2] = [64, 48];
type Color = Image<[f32; 3]>;

fn geometry(size: [u32; 2]) -> ViewGeometry {
    ViewGeometry::flat(size, 70.0).unwrap()
}

/// Colours that halves hold exactly, different at every pixel.
fn noise(size: [u32; 2], name: &str) -> Color {
    let mut draws = Draws::new(name);
    Image::from_fn(size, |_| {
        [0; 3].map(|_| (draws.bits() % 1024) as f32 / 1024.0)
    })
}

/// One view with everything given.
struct Input {
    color: Color,
    depth: Option<Image<f32>>,
    motion: Option<Image<[f32; 2]>>,
    gaze: Gaze,
    camera: Option<[[f32; 4]; 4]>,
}

impl Input {
    fn still(color: Color) -> Self {
        Self {
            color,
            depth: None,
            motion: None,
            gaze: Gaze::At { px: [20.0, 20.0] },
            camera: None,
        }
    }

    fn view(&self) -> CpuView<'_> {
        CpuView {
            facts: ViewFrame {
                geometry: geometry(self.color.size()),
                gaze: self.gaze,
                previous_from_current: self.camera,
            },
            color: &self.color,
            depth: self.depth.as_ref(),
            motion: self.motion.as_ref(),
        }
    }
}

fn context(settings: Settings) -> CpuAfterimage {
    CpuAfterimage::new(ContextDesc::new(SIZE), settings).unwrap()
}

/// Keeps history for certain while its weight is this large: a draw of 2^-24 steps never reaches the candidate's share.
fn sticky(post: &mut CpuAfterimage) {
    use afterimage::kernel::pack;
    let words: Vec<_> = post
        .history()
        .words()
        .iter()
        .map(|&w| {
            pack::pack(pack::Stored {
                w_sum: 1e12,
                ..pack::unpack(w)
            })
        })
        .collect();
    let mut copy = post.clone();
    copy.restore_history(&words);
    *post = copy;
}

fn step(
    post: &mut CpuAfterimage,
    index: u64,
    reset: Reset,
    inputs: &[&Input],
) -> (Vec<Color>, FrameStats, Vec<Image<PixelTrace>>) {
    let size = inputs[0].color.size();
    let mut out = vec![Image::filled(size, [f32::NAN; 3]); inputs.len()];
    let mut trace = vec![Image::filled(size, PixelTrace::default()); inputs.len()];
    let views: Vec<_> = inputs.iter().map(|i| i.view()).collect();
    let stats = post
        .process(
            &CpuFrame {
                views: &views,
                index,
                reset,
            },
            &mut out,
            Some(&mut trace),
        )
        .unwrap();
    (out, stats, trace)
}

fn one(
    post: &mut CpuAfterimage,
    index: u64,
    input: &Input,
) -> (Color, FrameStats, Image<PixelTrace>) {
    let (mut out, stats, mut trace) = step(post, index, Reset::None, &[input]);
    (out.remove(0), stats, trace.remove(0))
}

// ---- reprojection ------------------------------------------------------------------------------------------------------

#[test]
fn h51_a_thousand_still_frames_never_move_a_sample() {
    let mut post = context(Settings {
        gate: None,
        ..Settings::default()
    });
    let picture = noise(SIZE, "still");
    for index in 0..1000 {
        let (out, stats, _) = one(&mut post, index, &Input::still(picture.clone()));
        assert_eq!(out, picture);
        assert_eq!(stats.flushed(), 0);
    }
}

#[test]
fn h52_an_integer_shift_moves_history_exactly_and_marks_the_border_new() {
    let mut post = context(Settings {
        gate: None,
        ..Settings::default()
    });
    let before = noise(SIZE, "before");
    one(&mut post, 0, &Input::still(before.clone()));
    sticky(&mut post);
    let input = Input {
        motion: Some(Image::filled(SIZE, [3.0, -2.0])),
        ..Input::still(noise(SIZE, "after"))
    };
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
        for direction in [
            MotionDirection::PreviousMinusCurrent,
            MotionDirection::CurrentMinusPrevious,
        ] {
            for y_axis in [YAxis::Down, YAxis::Up] {
                let convention = MotionConvention {
                    unit,
                    direction,
                    y_axis,
                };
                let scale = convention.to_internal(SIZE);
                let vector = [3.0 / scale[0], -2.0 / scale[1]];
                let desc = ContextDesc {
                    motion: convention,
                    ..ContextDesc::new(SIZE)
                };
                let mut post = CpuAfterimage::new(
                    desc,
                    Settings {
                        gate: None,
                        ..Settings::default()
                    },
                )
                .unwrap();
                one(&mut post, 0, &Input::still(before.clone()));
                sticky(&mut post);
                let input = Input {
                    motion: Some(Image::filled(SIZE, vector)),
                    ..Input::still(noise(SIZE, "later"))
                };
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
    let uv = MotionConvention {
        unit: MotionUnit::Uv,
        direction: MotionDirection::CurrentMinusPrevious,
        y_axis: YAxis::Up,
    };
    assert_eq!(uv.to_internal([64, 48]), [-64.0, 48.0]);
    let ndc = MotionConvention {
        unit: MotionUnit::Ndc,
        ..MotionConvention::default()
    };
    assert_eq!(ndc.to_internal([64, 48]), [32.0, 24.0]);
}

#[test]
fn h53_half_pixel_motion_never_blurs() {
    // Nearest reprojection moves samples by whole pixels: after 200 frames of 0.5 px every colour is still one that was put in.
    let mut post = context(Settings {
        gate: None,
        ..Settings::default()
    });
    let mut known = std::collections::HashSet::new();
    for index in 0..200 {
        let color = noise(SIZE, &format!("frame {index}"));
        known.extend(color.pixels().iter().map(|c| c.map(f32::to_bits)));
        let input = Input {
            motion: Some(Image::filled(SIZE, [-0.5, 0.5])),
            ..Input::still(color)
        };
        let (out, ..) = one(&mut post, index, &input);
        assert!(
            out.pixels()
                .iter()
                .all(|c| known.contains(&c.map(f32::to_bits))),
            "H22: no invented colours"
        );
    }
}

#[test]
fn h54_garbage_motion_shows_the_candidate() {
    let mut post = context(Settings {
        gate: None,
        ..Settings::default()
    });
    one(&mut post, 0, &Input::still(noise(SIZE, "a")));
    sticky(&mut post);
    for (i, bad) in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e9, -1e9]
        .into_iter()
        .enumerate()
    {
        let mut motion = Image::filled(SIZE, [0.0; 2]);
        motion.pixels_mut()[5 * 64 + 7] = [bad, 0.0];
        motion.pixels_mut()[6 * 64 + 7] = [0.0, bad];
        let input = Input {
            motion: Some(motion),
            ..Input::still(noise(SIZE, "b"))
        };
        let (out, stats, _) = one(&mut post, 1 + i as u64, &input);
        assert_eq!(stats.verdicts[Verdict::BadMotion as usize], 2);
        assert_eq!(stats.flushed(), 2);
        assert_eq!(
            (out.at(7, 5), out.at(7, 6)),
            (input.color.at(7, 5), input.color.at(7, 6))
        );
    }
}

#[test]
fn h59_h60_zoom_and_turn_leave_no_hole() {
    let mut post = context(Settings {
        gate: None,
        ..Settings::default()
    });
    one(&mut post, 0, &Input::still(noise(SIZE, "zoom")));
    // A zoom out by 2: the border comes from outside; inside, texels are skipped.
    let zoom = Image::from_fn(SIZE, |[x, y]| [x as f32 - 32.0, y as f32 - 24.0]);
    let (out, stats, trace) = one(
        &mut post,
        1,
        &Input {
            motion: Some(zoom),
            ..Input::still(noise(SIZE, "zoom 2"))
        },
    );
    assert!(out.pixels().iter().flatten().all(|v| v.is_finite()));
    assert!(stats.flushed() > 0);
    let kept = trace.pixels().iter().filter(|t| !t.take).count();
    assert!(
        trace
            .pixels()
            .iter()
            .filter(|t| !t.take)
            .all(|t| t.age == 1),
        "ages are kept by duplicates ({kept})"
    );
    // A turn by 180 degrees: everything is off screen, everything is the candidate.
    let turn = Input {
        motion: Some(Image::filled(SIZE, [5000.0, 0.0])),
        ..Input::still(noise(SIZE, "turn"))
    };
    let (out, stats, _) = one(&mut post, 2, &turn);
    assert_eq!(out, turn.color);
    assert_eq!(stats.flushed(), 64 * 48);
}

// ---- depth -------------------------------------------------------------------------------------------------------------

fn two_walls(split: u32, near: f32, far: f32) -> Image<f32> {
    Image::from_fn(SIZE, |[x, _]| if x < split { near } else { far })
}

#[test]
fn a_disoccluded_wall_is_flushed_and_only_it() {
    let mut post = context(Settings {
        gate: None,
        ..Settings::default()
    });
    let first = Input {
        depth: Some(two_walls(32, 1.0, 5.0)),
        ..Input::still(noise(SIZE, "x"))
    };
    one(&mut post, 0, &first);
    // The near wall steps back by 8 px: columns 24..32 now show the far wall.
    let motion = Image::from_fn(SIZE, |[x, _]| if x < 24 { [8.0, 0.0] } else { [0.0, 0.0] });
    let second = Input {
        depth: Some(two_walls(24, 1.0, 5.0)),
        motion: Some(motion),
        ..Input::still(noise(SIZE, "y"))
    };
    let (_, stats, trace) = one(&mut post.clone(), 1, &second);
    assert_eq!(stats.verdicts[Verdict::Disoccluded as usize], 8 * 48);
    assert!(
        (24..32).all(|x| trace.at(x, 3).verdict == Verdict::Disoccluded && trace.at(x, 3).take)
    );
    // Without the test they keep the wrong wall's samples.
    post.set_settings(Settings {
        depth_test: None,
        ..*post.settings()
    })
    .unwrap();
    let (_, stats, _) = one(&mut post, 1, &second);
    assert_eq!(stats.flushed(), 0);
}

#[test]
fn h45_driving_at_a_wall_does_not_flush_when_the_camera_is_known() {
    let step_m = 1.0;
    let camera = [
        [1.0, 0.0, 0.0, 0.0],
        [0.0, 1.0, 0.0, 0.0],
        [0.0, 0.0, 1.0, step_m],
        [0.0, 0.0, 0.0, 1.0],
    ];
    let frame = |z: f32, camera| {
        // The wall's points flow outwards: previous = current * z / (z + step), about the middle.
        let motion = Image::from_fn(SIZE, |[x, y]| {
            let k = z / (z + step_m) - 1.0;
            [(x as f32 - 31.5) * k, (y as f32 - 23.5) * k]
        });
        Input {
            depth: Some(Image::filled(SIZE, z)),
            motion: Some(motion),
            camera,
            ..Input::still(noise(SIZE, "wall"))
        }
    };
    for (camera, flushes) in [(Some(camera), false), (None, true)] {
        let mut post = context(Settings::default());
        one(&mut post, 0, &frame(6.0, camera));
        let (_, stats, _) = one(&mut post, 1, &frame(5.0, camera));
        assert_eq!(stats.verdicts[Verdict::Disoccluded as usize] > 0, flushes);
    }
}

#[test]
fn h46_a_jittering_wire_flushes_itself_alone() {
    let mut post = context(Settings::default());
    let mut flushed = vec![];
    for index in 0..60 {
        // One pixel wide at 1 m over a wall at 10 m, hopping between two columns with the jitter.
        let column = 30 + (index % 2) as u32;
        let depth = Image::from_fn(SIZE, |[x, _]| if x == column { 1.0 } else { 10.0 });
        let input = Input {
            depth: Some(depth),
            ..Input::still(noise(SIZE, "wire"))
        };
        let (out, stats, _) = one(&mut post, index, &input);
        assert!(out.pixels().iter().flatten().all(|v| v.is_finite()));
        flushed.push(stats.flushed());
    }
    assert!(
        flushed[1..].iter().all(|&n| n == 2 * 48),
        "the two columns, and only they: {flushed:?}"
    );
}

#[test]
fn h47_a_nan_depth_flushes_its_pixel_alone() {
    let mut post = context(Settings {
        gate: None,
        ..Settings::default()
    });
    let clean = Input {
        depth: Some(Image::filled(SIZE, 4.0)),
        ..Input::still(noise(SIZE, "d"))
    };
    one(&mut post, 0, &clean);
    let mut depth = Image::filled(SIZE, 4.0);
    depth.pixels_mut()[20 * 64 + 20] = f32::NAN;
    let (_, stats, trace) = one(
        &mut post,
        1,
        &Input {
            depth: Some(depth),
            ..Input::still(noise(SIZE, "d"))
        },
    );
    assert_eq!(stats.flushed(), 1);
    assert_eq!(trace.at(20, 20).verdict, Verdict::Disoccluded);
    // What was stored there has no depth: flushed once more, then all is well.
    let (_, stats, _) = one(&mut post, 2, &clean);
    assert_eq!(stats.flushed(), 1);
    let (_, stats, _) = one(&mut post, 3, &clean);
    assert_eq!(stats.flushed(), 0);
}

#[test]
fn h41_h49_sky_and_orthographic_depth_go_through_the_pass() {
    for (depth, sky, wall) in [
        (
            DepthConvention::Reversed {
                near: 0.1,
                far: f32::INFINITY,
            },
            0.0,
            0.05,
        ),
        (
            DepthConvention::Forward {
                near: 0.1,
                far: f32::INFINITY,
            },
            1.0,
            0.98,
        ),
        (DepthConvention::Linear, f32::INFINITY, 5.0),
        (
            DepthConvention::Orthographic {
                near: 0.0,
                far: 100.0,
            },
            1.0,
            0.05,
        ),
    ] {
        let desc = ContextDesc {
            depth,
            ..ContextDesc::new(SIZE)
        };
        let mut post = CpuAfterimage::new(desc, Settings::default()).unwrap();
        let frame = |split| Input {
            depth: Some(two_walls(split, wall, sky)),
            ..Input::still(noise(SIZE, "sky"))
        };
        one(&mut post, 0, &frame(32));
        assert_eq!(one(&mut post, 1, &frame(32)).1.flushed(), 0, "{depth:?}");
        assert_eq!(
            one(&mut post, 2, &frame(30)).1.flushed(),
            2 * 48,
            "{depth:?}"
        );
    }
}

#[test]
fn h58_nothing_bleeds_over_a_depth_edge() {
    // A bright near square moves right by 1.5 px a frame over a dark wall; vectors are right at each pixel.
    let mut post = context(Settings {
        gate: None,
        ..Settings::default()
    });
    for index in 0..30_u64 {
        let left = 4.0 + 1.5 * index as f32;
        let inside =
            |x: u32, y: u32| (left..left + 10.0).contains(&(x as f32)) && (10..30).contains(&y);
        let input = Input {
            color: Image::from_fn(
                SIZE,
                |[x, y]| if inside(x, y) { [1.0; 3] } else { [0.125; 3] },
            ),
            depth: Some(Image::from_fn(
                SIZE,
                |[x, y]| if inside(x, y) { 1.0 } else { 8.0 },
            )),
            motion: Some(Image::from_fn(SIZE, |[x, y]| {
                if inside(x, y) {
                    [-1.5, 0.0]
                } else {
                    [0.0, 0.0]
                }
            })),
            ..Input::still(noise(SIZE, ""))
        };
        let (out, ..) = one(&mut post, index, &input);
        assert_eq!(out, input.color, "frame {index}");
    }
}

#[test]
fn h50_z_fighting_shows_only_what_was_presented() {
    let mut post = context(Settings::default());
    let (a, b) = ([0.25, 0.5, 0.75], [0.75, 0.25, 0.5]);
    let mut draws = Draws::new("z-fighting");
    for index in 0..100 {
        let picks: Vec<bool> = (0..64 * 48).map(|_| draws.uniform() < 0.5).collect();
        let color =
            Image::from_pixels(SIZE, picks.iter().map(|&p| if p { a } else { b }).collect())
                .unwrap();
        let depth = Image::from_pixels(
            SIZE,
            picks
                .iter()
                .map(|&p| if p { 3.0 } else { 3.0001 })
                .collect(),
        )
        .unwrap();
        let (out, stats, trace) = one(
            &mut post,
            index,
            &Input {
                depth: Some(depth),
                ..Input::still(color)
            },
        );
        assert!(out.pixels().iter().all(|&c| c == a || c == b));
        assert_eq!(stats.flushed(), 0);
        assert!(trace.pixels().iter().all(|t| u64::from(t.age) <= index));
    }
}

// ---- NaN ---------------------------------------------------------------------------------------------------------------

proptest! {
    #![proptest_config(common::property("nan pixel", 64))]

    #[test]
    fn nan_in_one_pixel_stays_there_for_one_frame(x in 0usize..64, y in 0usize..48, channel in 0usize..3, bad in prop::sample::select(vec![f32::NAN, f32::INFINITY, f32::NEG_INFINITY])) {
        let mut clean = context(Settings::default());
        let mut hurt = clean.clone();
        for index in 0..4 {
            let color = noise(SIZE, &format!("nan {index}"));
            let mut broken = color.clone();
            if index == 0 || index == 2 {
                broken.pixels_mut()[y * 64 + x][channel] = bad;
            }
            let (a, ..) = one(&mut clean, index, &Input::still(color));
            let (b, stats, _) = one(&mut hurt, index, &Input::still(broken));
            prop_assert_eq!(stats.nonfinite, u64::from(index == 0 || index == 2));
            prop_assert!(b.pixels().iter().flatten().all(|v| v.is_finite()));
            for (i, (p, q)) in a.pixels().iter().zip(b.pixels()).enumerate() {
                prop_assert!(p == q || i == y * 64 + x, "a neighbour changed");
            }
            if index == 0 {
                prop_assert_eq!(b.at(x, y), [0.0; 3]);
            }
        }
        // Once there is a history, it is shown instead.
        prop_assert!(hurt.history().is_filled());
    }

    #[test]
    fn h19_h79_whatever_the_history_holds_the_output_is_finite_and_heals(words in prop::collection::vec(any::<[u32; 3]>(), 64 * 48), sampler in prop::sample::select(vec![Sampler::AChao, Sampler::AEs])) {
        let mut post = context(Settings { sampler, ..Settings::default() });
        one(&mut post, 0, &Input::still(noise(SIZE, "h")));
        post.restore_history(&words);
        let (out, ..) = one(&mut post, 1, &Input::still(noise(SIZE, "h")));
        prop_assert!(out.pixels().iter().flatten().all(|v| v.is_finite()));
        for &w in post.history().words() {
            let s = afterimage::kernel::pack::unpack(w);
            prop_assert!(s.w_sum > 0.0 && s.color.is_finite(), "every reservoir holds a sample again");
        }
    }
}

#[test]
fn h79_poisoned_fresh_history_is_never_read() {
    let mut post = context(Settings::default());
    post.restore_history(&vec![[u32::MAX; 3]; 64 * 48]);
    let input = Input::still(noise(SIZE, "poison"));
    assert_eq!(
        one(&mut post.clone(), 0, &input).0,
        input.color,
        "all NaN words are empty"
    );
    let (out, _, _) = step(&mut post, 0, Reset::All, &[&input]);
    assert_eq!(out[0], input.color);
}

// ---- lifecycle ---------------------------------------------------------------------------------------------------------

fn run(post: &mut CpuAfterimage, frames: std::ops::Range<u64>) -> Vec<Color> {
    frames
        .map(|i| one(post, i, &Input::still(noise(SIZE, &format!("run {i}")))).0)
        .collect()
}

#[test]
fn h29_the_same_bytes_whatever_the_number_of_threads() {
    for settings in [
        Settings::default(),
        Settings {
            sampler: Sampler::AEs,
            bias: Bias::Exponential { lambda: 0.05 },
            ..Settings::default()
        },
    ] {
        let with = |threads| {
            let pool = rayon::ThreadPoolBuilder::new()
                .num_threads(threads)
                .build()
                .unwrap();
            pool.install(|| {
                let mut post = context(settings);
                (run(&mut post, 0..20), post.history().words().to_vec())
            })
        };
        assert_eq!(with(1), with(2));
        assert_eq!(with(2), with(7));
    }
    let other_seed = run(
        &mut context(Settings {
            seed: 1,
            ..Settings::default()
        }),
        0..20,
    );
    assert_ne!(other_seed, run(&mut context(Settings::default()), 0..20));
}

#[test]
fn h76_h77_h78_reset_resize_and_forget_equal_a_fresh_context() {
    let settings = Settings {
        gate: None,
        ..Settings::default()
    };
    let fresh = run(&mut context(settings), 20..30);
    let mut used = context(settings);
    run(&mut used, 0..20);
    let stale = run(&mut used.clone(), 20..30);
    assert_ne!(stale, fresh, "the planted error: no reset");

    let mut forgotten = used.clone();
    forgotten.forget();
    assert_eq!(run(&mut forgotten, 20..30), fresh);

    let mut resized = used.clone();
    resized.resize([3, 5]).unwrap();
    resized.resize(SIZE).unwrap();
    assert_eq!(run(&mut resized, 20..30), fresh);

    let mut cut = used.clone();
    let input = Input::still(noise(SIZE, "run 20"));
    for _ in 0..2 {
        assert_eq!(
            step(&mut cut, 20, Reset::All, &[&input]).0[0],
            fresh[0],
            "reset two frames running"
        );
    }
    assert_eq!(run(&mut cut, 21..30), fresh[1..]);
}

#[test]
fn a_frame_that_is_refused_changes_nothing() {
    let settings = Settings {
        gate: None,
        ..Settings::default()
    };
    let (mut good, mut mixed) = (context(settings), context(settings));
    let expected = run(&mut good, 0..6);
    let mut got = run(&mut mixed, 0..3);
    let words = mixed.history().words().to_vec();
    let (small, right) = (noise([3, 4], "small"), noise(SIZE, "right"));
    let facts = Input::still(right.clone()).view().facts;
    let bad = |view: CpuView<'_>, out: &mut [Color], mixed: &mut CpuAfterimage| {
        let frame = CpuFrame {
            views: &[view],
            index: 3,
            reset: Reset::All,
        };
        mixed.process(&frame, out, None).unwrap_err()
    };
    let view = CpuView {
        facts,
        color: &right,
        depth: None,
        motion: None,
    };
    let depth = Image::filled([3, 4], 1.0);
    let mut matrix = facts;
    matrix.previous_from_current = Some([[f32::NAN; 4]; 4]);
    for (view, out_size) in [
        (
            CpuView {
                color: &small,
                ..view
            },
            SIZE,
        ),
        (
            CpuView {
                depth: Some(&depth),
                ..view
            },
            SIZE,
        ),
        (
            CpuView {
                facts: matrix,
                ..view
            },
            SIZE,
        ),
        (view, [9, 9]),
    ] {
        let mut out = [Image::filled(out_size, [0.5; 3])];
        let error = bad(view, &mut out, &mut mixed);
        println!("{error}");
        assert!(
            out[0].pixels().iter().all(|&c| c == [0.5; 3]),
            "nothing was written"
        );
    }
    assert_eq!(
        bad(view, &mut [], &mut mixed),
        FrameError::ViewCount {
            found: 0,
            expected: 1
        }
    );
    assert_eq!(mixed.history().words(), words);
    got.extend(run(&mut mixed, 3..6));
    assert_eq!(got, expected);
}

#[test]
fn h76_empty_and_huge_sizes_are_refused_and_a_pixel_is_enough() {
    for size in [[0, 0], [0, 5], [5, 0], [1 << 20, 1]] {
        assert!(CpuAfterimage::new(ContextDesc::new(size), Settings::default()).is_err());
        let mut post = context(Settings::default());
        assert!(matches!(post.resize(size), Err(FrameError::Extent { .. })));
        assert_eq!(post.desc().size_px, SIZE);
    }
    let mut post = CpuAfterimage::new(ContextDesc::new([1, 1]), Settings::default()).unwrap();
    let input = Input {
        depth: Some(Image::filled([1, 1], 1.0)),
        ..Input::still(noise([1, 1], "one"))
    };
    assert_eq!(one(&mut post, 0, &input).0, input.color);
    assert_eq!(one(&mut post, 1, &input).0, input.color);
}

#[test]
fn memory_is_what_the_documentation_says() {
    let pixels = 64 * 48;
    assert_eq!(context(Settings::default()).memory_bytes(), 24 * pixels);
    assert_eq!(
        context(Settings {
            sampler: Sampler::AEs,
            ..Settings::default()
        })
        .memory_bytes(),
        32 * pixels
    );
    let stereo = ContextDesc {
        view_count: 2,
        ..ContextDesc::new(SIZE)
    };
    assert_eq!(
        CpuAfterimage::new(stereo, Settings::default())
            .unwrap()
            .memory_bytes(),
        48 * pixels
    );
}

#[test]
fn method_none_shows_the_frame_and_forgets() {
    let mut post = context(Settings {
        method: Method::None,
        ..Settings::default()
    });
    let mut color = noise(SIZE, "none");
    color.pixels_mut()[3] = [f32::NAN, 1.0, 1.0];
    let (out, stats, _) = one(&mut post, 0, &Input::still(color.clone()));
    assert_eq!(
        (out.pixels()[3], stats.nonfinite, out.pixels()[4]),
        ([0.0; 3], 1, color.pixels()[4])
    );
    assert!(!post.history().is_filled());
}

// ---- views and gaze ----------------------------------------------------------------------------------------------------

#[test]
fn h27_stereo_views_never_read_each_other() {
    let stereo = ContextDesc {
        view_count: 2,
        ..ContextDesc::new(SIZE)
    };
    let settings = Settings {
        gate: None,
        ..Settings::default()
    };
    let mut both = CpuAfterimage::new(stereo, settings).unwrap();
    let mut swapped_right = CpuAfterimage::new(stereo, settings).unwrap();
    let mut left_alone = context(settings);
    let mut differ = false;
    for index in 0..20 {
        let left = Input::still(noise(SIZE, &format!("left {index}")));
        let right = Input {
            gaze: Gaze::At { px: [50.0, 30.0] },
            ..Input::still(noise(SIZE, &format!("right {index}")))
        };
        let junk = Input {
            gaze: Gaze::Lost,
            ..Input::still(Image::filled(SIZE, [f32::NAN, 9.0, 1e9]))
        };
        let (a, ..) = step(&mut both, index, Reset::None, &[&left, &right]);
        let (b, ..) = step(&mut swapped_right, index, Reset::None, &[&left, &junk]);
        let (c, ..) = one(&mut left_alone, index, &left);
        assert_eq!(
            a[0], b[0],
            "what the right eye sees changes nothing on the left"
        );
        assert_eq!(a[0], c);
        // The same input to both eyes still draws different numbers.
        let (d, ..) = step(&mut both.clone(), index, Reset::None, &[&left, &left]);
        differ |= d[0] != d[1];
    }
    assert!(differ);
}

#[test]
fn h63_a_lost_gaze_is_held_then_centred_at_the_start() {
    let held = |gazes: &[Gaze]| {
        let mut post = context(Settings {
            gate: None,
            ..Settings::default()
        });
        let mut weights = vec![];
        for (i, &gaze) in gazes.iter().enumerate() {
            let (_, _, trace) = one(
                &mut post,
                i as u64,
                &Input {
                    gaze,
                    ..Input::still(noise(SIZE, "gaze"))
                },
            );
            assert!(
                trace
                    .pixels()
                    .iter()
                    .all(|t| t.weight.is_finite() && t.weight > 0.0)
            );
            weights = trace.pixels().iter().map(|t| t.weight).collect();
        }
        weights
    };
    let at = |px| Gaze::At { px };
    let there = held(&[at([9.0, 9.0])]);
    assert_eq!(held(&[at([9.0, 9.0]), Gaze::Lost]), there);
    assert_eq!(held(&[at([9.0, 9.0]), at([f32::NAN, 3.0])]), there);
    assert_eq!(
        held(&[at([9.0, 9.0]), Gaze::Lost, at([f32::INFINITY, 3.0])]),
        there
    );
    assert_eq!(held(&[Gaze::Lost]), held(&[at([31.5, 23.5])]));
    held(&[at([-5000.0, 1e30])]);
}

#[test]
fn h66_a_saccade_keeps_the_old_fovea() {
    let mut post = context(Settings {
        gate: None,
        ..Settings::default()
    });
    let sharp = noise(SIZE, "sharp");
    for index in 0..18 {
        one(
            &mut post,
            index,
            &Input {
                gaze: Gaze::At { px: [10.0, 24.0] },
                ..Input::still(sharp.clone())
            },
        );
    }
    let blurred = Input {
        gaze: Gaze::At { px: [55.0, 24.0] },
        ..Input::still(Image::filled(SIZE, [0.5; 3]))
    };
    let (out, ..) = one(&mut post, 18, &blurred);
    let kept = (5..15)
        .flat_map(|x| (20..28).map(move |y| (x, y)))
        .filter(|&(x, y)| out.at(x, y) == sharp.at(x, y))
        .count();
    assert!(
        kept >= 78,
        "{kept} of 80 sharp samples kept the first frame after"
    );
}

#[test]
fn settings_are_checked_and_named() {
    let base = Settings::default();
    for (settings, name) in [
        (
            Settings {
                fovea_deg: -1.0,
                ..base
            },
            "fovea_deg",
        ),
        (
            Settings {
                fovea_deg: f32::NAN,
                ..base
            },
            "fovea_deg",
        ),
        (
            Settings {
                bias: Bias::Exponential { lambda: -0.1 },
                ..base
            },
            "bias lambda",
        ),
        (
            Settings {
                depth_test: Some(DepthTest {
                    relative: 0.0,
                    slope_px: 1.0,
                }),
                ..base
            },
            "depth_test.relative",
        ),
    ] {
        let error = CpuAfterimage::new(ContextDesc::new(SIZE), settings).unwrap_err();
        assert_eq!(error.setting, name);
        let mut post = context(base);
        assert!(post.set_settings(settings).is_err());
        assert_eq!(*post.settings(), base);
    }
}
