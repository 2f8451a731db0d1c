//! Disocclusion, sky, camera motion.

use super::*;
use afterimage_testing::holds;

fn two_walls(split: u32, near: f32, far: f32) -> Image<f32> {
    Image::from_fn(SIZE, |[x, _]| if x < split { near } else { far })
}

#[test]
fn a_disoccluded_wall_is_rejected_and_only_it() {
    let mut post = context(ungated());
    let first = Input { depth: Some(two_walls(32, 1.0, 5.0)), ..Input::still(noise(SIZE, "x")) };
    one(&mut post, 0, &first);
    // The near wall steps back by 8 px: columns 24..32 now show the far wall.
    let motion = Image::from_fn(SIZE, |[x, _]| if x < 24 { [8.0, 0.0] } else { [0.0, 0.0] });
    let second = Input { depth: Some(two_walls(24, 1.0, 5.0)), motion: Some(motion), ..Input::still(noise(SIZE, "y")) };
    let (_, stats, trace) = one(&mut post.clone(), 1, &second);
    assert_eq!(stats.verdicts[Verdict::Disoccluded as usize], 8 * 48);
    assert!((24..32).all(|x| trace.at(x, 3).verdict == Verdict::Disoccluded && trace.at(x, 3).take));
    // Without the test they keep the wrong wall's samples.
    post.set_settings(Settings { depth_test: None, ..post.desc().settings }).unwrap();
    let (_, stats, _) = one(&mut post, 1, &second);
    assert_eq!(stats.rejected(), 0);
}

#[test]
fn h44_a_grazing_plane_under_jitter_is_not_rejected() {
    // Planes seen at up to 89.9 degrees from their normal, from the horizon on; the depth sample moves by half a pixel.
    let focal_px = 32.0 / 35_f32.to_radians().tan();
    let mut seen = 0;
    for method in METHODS {
        for angle_deg in [60.0_f32, 85.0, 89.0, 89.9] {
            let mut draws = Draws::new("jittered floor");
            let per_row = angle_deg.to_radians().tan() / focal_px;
            let row = |y: f32| 0.2 * (1.0 + per_row * (y - 23.5));
            let mut frame = |index: u64| {
                let jitter = if index == 0 { 0.0 } else { draws.range(-0.5, 0.5) };
                let depth = Image::from_fn(SIZE, |[_, y]| {
                    let d = row(y as f32 + jitter);
                    if d > 0.0 { 1.0 / d } else { f32::INFINITY }
                });
                Input { depth: Some(depth), ..Input::still(noise(SIZE, "floor")) }
            };
            let mut post = context_of(method);
            // Only where the neighbouring rows are on the plane for any sample position: the horizon is a silhouette.
            let plane = |y: usize| row(y as f32 - 1.5) > 0.0;
            for index in 0..20 {
                let (_, _, trace) = one(&mut post, index, &frame(index));
                for (i, t) in trace.pixels().iter().enumerate().filter(|(i, _)| plane(i / 64)) {
                    assert!(t.verdict != Verdict::Disoccluded, "{method:?}, {angle_deg} degrees, row {}", i / 64);
                    seen += 1;
                }
            }
            // The planted error: no allowance for slope.
            let test = DepthTest { slope_px: 0.0, ..DepthTest::default() };
            post.set_settings(Settings { depth_test: Some(test), ..post.desc().settings }).unwrap();
            assert!(one(&mut post, 20, &frame(20)).1.rejected() > 0 || angle_deg < 89.0);
        }
    }
    holds!("H44", Cpu, "wrs and smr, 60 to 89.9 degrees, 20 jittered frames: 0 of {seen} pixels rejected");
}

#[test]
fn h45_driving_at_a_wall_keeps_history_when_camera_motion_is_known() {
    let step_m = 1.0;
    let camera = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, step_m], [0.0, 0.0, 0.0, 1.0]];
    let frame = |z: f32, camera| {
        // The wall's points flow outwards: previous = current * z / (z + step), about the middle.
        let motion = Image::from_fn(SIZE, |[x, y]| {
            let k = z / (z + step_m) - 1.0;
            [(x as f32 - 31.5) * k, (y as f32 - 23.5) * k]
        });
        Input { depth: Some(Image::filled(SIZE, z)), motion: Some(motion), camera, ..Input::still(noise(SIZE, "wall")) }
    };
    for method in METHODS {
        let [known, unknown] = [Some(camera), None].map(|camera| {
            let mut post = context_of(method);
            one(&mut post, 0, &frame(6.0, camera));
            one(&mut post, 1, &frame(5.0, camera)).1.verdicts[Verdict::Disoccluded as usize]
        });
        assert_eq!([known, unknown], [0, 64 * 48], "{method:?}");
    }
    holds!("H45", Cpu, "wrs and smr, from 6 to 5 m: 0 of 3072 pixels rejected; 3072 without camera motion");
}

#[test]
fn h46_a_jittering_wire_rejects_its_own_history_alone() {
    let [wall, wire] = [[0.25; 3], [0.9; 3]];
    let mut shares = vec![];
    for method in METHODS {
        let mut post = context_of(method);
        let (mut rejected, mut blinks, mut before) = (vec![], 0.0_f64, None::<Color>);
        for index in 0..60 {
            // A wire one pixel wide at 1 m in front of a wall at 10 m, moved between two columns by the jitter.
            let column = 30 + (index % 2) as u32;
            let input = Input {
                depth: Some(Image::from_fn(SIZE, |[x, _]| if x == column { 1.0 } else { 10.0 })),
                ..Input::still(Image::from_fn(SIZE, |[x, _]| if x == column { wire } else { wall }))
            };
            let (out, stats, _) = one(&mut post, index, &input);
            for (x, y) in (0..48).flat_map(|y| [30, 31].map(|x| (x, y))) {
                assert_eq!(out.at(x, y), input.color.at(x, y), "{method:?}: the wire shows what came");
            }
            if let Some(before) = before.replace(out.clone()).filter(|_| index > 1) {
                for (i, (a, b)) in out.pixels().iter().zip(before.pixels()).enumerate() {
                    blinks += if [30, 31].contains(&(i % 64)) { 0.0 } else { f64::from((a[0] - b[0]).powi(2)) };
                }
            }
            rejected.push(stats.rejected());
        }
        assert!(rejected[1..].iter().all(|&n| n == 2 * 48), "the two columns, and only they: {rejected:?}");
        // Compared with the change in the wire's own two columns: 0.65 each, in every frame.
        let share = blinks / (58.0 * 2.0 * 48.0 * 0.65_f64.powi(2));
        shares.push(share);
    }
    // The wire appears in smr's mip chain and disappears from it.
    assert!(shares[0] == 0.0 && shares[1] < 1e-3, "{shares:?}");
    let smr = shares[1];
    holds!(
        "H46",
        Cpu,
        "wrs and smr: 96 px a frame rejected, always; blinking beside them {smr:.1e} of the wire's (wrs 0)"
    );
}

#[test]
fn h47_a_nan_depth_rejects_its_pixel_alone() {
    let hurt_at = 20 * 64 + 20;
    for method in METHODS {
        let (mut clean, mut hurt) = (context_of(method), context_of(method));
        let mut rejected = vec![];
        for index in 0..4 {
            let input =
                Input { depth: Some(Image::filled(SIZE, 4.0)), ..Input::still(noise(SIZE, &format!("d {index}"))) };
            let mut broken = input.clone();
            if index == 1 {
                broken.depth.as_mut().unwrap().pixels_mut()[hurt_at] = f32::NAN;
            }
            let (a, _, a_trace) = one(&mut clean, index, &input);
            let (b, stats, b_trace) = one(&mut hurt, index, &broken);
            rejected.push(stats.rejected());
            // A pixel without history affects its neighbours through smr's mip chain a frame later.
            let unchanged = |i: usize| i == hurt_at || method == MethodKind::Smr && index > 1;
            for i in (0..64 * 48).filter(|&i| !unchanged(i)) {
                assert_eq!(a.pixels()[i], b.pixels()[i], "{method:?}, frame {index}: a neighbour changed");
                assert_eq!(a_trace.pixels()[i], b_trace.pixels()[i]);
            }
            assert_eq!(b_trace.pixels()[hurt_at].verdict == Verdict::Disoccluded, [1, 2].contains(&index));
        }
        // The stored sample has no depth: its history is rejected once more, then it is valid again.
        assert_eq!(rejected, [0, 1, 1, 0]);
    }
    holds!("H47", Cpu, "wrs and smr: its pixel rejected in 2 frames, then kept; {} others: same bits", 64 * 48 - 1);
}

#[test]
fn h48_history_outlives_a_change_of_planes() {
    // Near and far planes belong to a context. History does not depend on them: it is valid under other planes.
    let planes = |near: f32, far: f32| DepthConvention::Reversed { near, far };
    let stored = |d: f32, near: f32, far: f32| (d - 1.0 / far) / (1.0 / near - 1.0 / far);
    let frame = |near: f32, far: f32| {
        let depth = Image::from_fn(SIZE, |[x, _]| stored(1.0 / (1.0 + x as f32), near, far));
        Input { depth: Some(depth), ..Input::still(noise(SIZE, "planes")) }
    };
    let make = |near, far| {
        let desc = ContextDesc { depth: planes(near, far), ..ContextDesc::new(SIZE) };
        CpuAfterimage::new(&ContextDesc { settings: ungated(), ..desc }).unwrap()
    };
    let mut before = make(0.1, 1000.0);
    one(&mut before, 0, &frame(0.1, 1000.0));
    let mut after = make(0.3, 5000.0);
    after.restore_history(before.history().words());
    let (_, stats, _) = one(&mut after.clone(), 1, &frame(0.3, 5000.0));
    assert_eq!(stats.rejected(), 0);
    // Planted error: depth of the old planes read with the new planes.
    let (_, wrong, _) = one(&mut after, 1, &frame(0.1, 1000.0));
    assert!(wrong.rejected() > 3000);
    holds!(
        "H48",
        Cpu,
        "1 to 64 m, near 0.1 to 0.3 m, far 1 to 5 km: none rejected ({} with the old planes)",
        wrong.rejected()
    );
}

#[test]
fn h41_h49_sky_and_orthographic_depth_go_through_the_pass() {
    for method in METHODS {
        for (depth, sky, wall) in [
            (DepthConvention::Reversed { near: 0.1, far: f32::INFINITY }, 0.0, 0.05),
            (DepthConvention::Forward { near: 0.1, far: f32::INFINITY }, 1.0, 0.98),
            (DepthConvention::Linear, f32::INFINITY, 5.0),
            (DepthConvention::Orthographic { near: 0.0, far: 100.0 }, 1.0, 0.05),
        ] {
            let desc = ContextDesc { depth, ..ContextDesc::new(SIZE) };
            let mut post = CpuAfterimage::new(&ContextDesc {
                settings: Settings { method: method.into(), ..Settings::paper() },
                ..desc
            })
            .unwrap();
            let frame = |split| Input { depth: Some(two_walls(split, wall, sky)), ..Input::still(noise(SIZE, "sky")) };
            // The wall's edge moves to the left and back: sky replaces wall, then wall replaces sky.
            for (index, split, rejected) in [(0, 32, 0), (1, 32, 0), (2, 30, 2 * 48), (3, 32, 2 * 48), (4, 32, 0)] {
                assert_eq!(one(&mut post, index, &frame(split)).1.rejected(), rejected, "{method:?}, {depth:?}");
            }
        }
    }
    holds!(
        "H41",
        Cpu,
        "wrs and smr, 3 skies: sky on sky keeps 1536 of 1536, sky on wall and wall on sky reject 96 of 96"
    );
    holds!("H49", Cpu, "wrs and smr through the pass: the edge's 96 pixels rejected each way, no other of 3072");
}

#[test]
fn h58_nothing_bleeds_over_a_depth_edge() {
    // A bright near square moves right by 1.5 px a frame over a dark wall; vectors are right at each pixel.
    let mut post = context(ungated());
    for index in 0..30_u64 {
        let left = 4.0 + 1.5 * index as f32;
        let inside = |x: u32, y: u32| (left..left + 10.0).contains(&(x as f32)) && (10..30).contains(&y);
        let input = Input {
            color: Image::from_fn(SIZE, |[x, y]| if inside(x, y) { [1.0; 3] } else { [0.125; 3] }),
            depth: Some(Image::from_fn(SIZE, |[x, y]| if inside(x, y) { 1.0 } else { 8.0 })),
            motion: Some(Image::from_fn(SIZE, |[x, y]| if inside(x, y) { [-1.5, 0.0] } else { [0.0, 0.0] })),
            ..Input::still(noise(SIZE, ""))
        };
        let (out, ..) = one(&mut post, index, &input);
        assert_eq!(out, input.color, "frame {index}");
    }
    holds!("H58", Cpu, "wrs, a square at 1.5 px a frame over a wall, 30 frames: no pixel bleeds");
}

#[test]
fn h50_z_fighting_shows_only_what_was_presented() {
    let (a, b) = ([0.25, 0.5, 0.75], [0.75, 0.25, 0.5]);
    // Reference: the same colors with constant depth. Both must be equal.
    let (mut post, mut plain) = (context(Settings::paper()), context(Settings::paper()));
    let mut draws = Draws::new("z-fighting");
    let mut oldest = 0;
    for index in 0..100 {
        let picks: Vec<bool> = (0..64 * 48).map(|_| draws.uniform() < 0.5).collect();
        let color = Image::from_pixels(SIZE, picks.iter().map(|&p| if p { a } else { b }).collect()).unwrap();
        let depth = picks.iter().map(|&p| if p { 3.0 } else { 3.0001 }).collect();
        let input = Input { depth: Some(Image::from_pixels(SIZE, depth).unwrap()), ..Input::still(color) };
        let (out, stats, trace) = one(&mut post, index, &input);
        let expected = one(&mut plain, index, &Input { depth: None, ..input });
        assert_eq!((&out, &trace, stats.rejected()), (&expected.0, &expected.2, 0), "frame {index}");
        assert!(out.pixels().iter().all(|&c| c == a || c == b));
        oldest = trace.pixels().iter().map(|t| t.age).max().unwrap().max(oldest);
    }
    holds!("H50", Cpu, "wrs, 100 frames: ages (to {oldest}) and colors as without depth, bit for bit; no third color");
}
