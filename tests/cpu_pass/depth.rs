//! Disocclusion, sky, camera motion.

use super::*;

fn two_walls(split: u32, near: f32, far: f32) -> Image<f32> {
    Image::from_fn(SIZE, |[x, _]| if x < split { near } else { far })
}

#[test]
fn a_disoccluded_wall_is_flushed_and_only_it() {
    let mut post = context(Settings { gate: None, ..Settings::paper() });
    let first = Input { depth: Some(two_walls(32, 1.0, 5.0)), ..Input::still(noise(SIZE, "x")) };
    one(&mut post, 0, &first);
    // The near wall steps back by 8 px: columns 24..32 now show the far wall.
    let motion = Image::from_fn(SIZE, |[x, _]| if x < 24 { [8.0, 0.0] } else { [0.0, 0.0] });
    let second = Input { depth: Some(two_walls(24, 1.0, 5.0)), motion: Some(motion), ..Input::still(noise(SIZE, "y")) };
    let (_, stats, trace) = one(&mut post.clone(), 1, &second);
    assert_eq!(stats.verdicts[Verdict::Disoccluded as usize], 8 * 48);
    assert!((24..32).all(|x| trace.at(x, 3).verdict == Verdict::Disoccluded && trace.at(x, 3).take));
    // Without the test they keep the wrong wall's samples.
    post.set_settings(Settings { depth_test: None, ..*post.settings() }).unwrap();
    let (_, stats, _) = one(&mut post, 1, &second);
    assert_eq!(stats.flushed(), 0);
}

#[test]
fn h44_a_steep_floor_under_jitter_is_not_flushed() {
    let mut post = context(Settings { gate: None, ..Settings::paper() });
    for index in 0..20 {
        // Disparity grows by 0.001 a row from the horizon at the top; the depth sample moves by half a pixel.
        let jitter = 0.5 * (index % 2) as f32;
        let depth = Image::from_fn(SIZE, |[_, y]| 1000.0 / (y as f32 + 1.0 + jitter));
        let input = Input { depth: Some(depth), ..Input::still(noise(SIZE, "floor")) };
        let (_, stats, _) = one(&mut post, index, &input);
        assert_eq!(stats.flushed(), 0, "frame {index}");
    }
    // The planted error: no allowance for slope.
    let test = DepthTest { slope_px: 0.0, ..DepthTest::default() };
    post.set_settings(Settings { depth_test: Some(test), ..*post.settings() }).unwrap();
    let depth = Image::from_fn(SIZE, |[_, y]| 1000.0 / (y as f32 + 1.0));
    let input = Input { depth: Some(depth), ..Input::still(noise(SIZE, "floor")) };
    assert!(one(&mut post, 20, &input).1.flushed() > 0);
}

#[test]
fn h45_driving_at_a_wall_does_not_flush_when_the_camera_is_known() {
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
    for (camera, flushes) in [(Some(camera), false), (None, true)] {
        let mut post = context(Settings::paper());
        one(&mut post, 0, &frame(6.0, camera));
        let (_, stats, _) = one(&mut post, 1, &frame(5.0, camera));
        assert_eq!(stats.verdicts[Verdict::Disoccluded as usize] > 0, flushes);
    }
}

#[test]
fn h46_a_jittering_wire_flushes_itself_alone() {
    let mut post = context(Settings::paper());
    let mut flushed = vec![];
    for index in 0..60 {
        // One pixel wide at 1 m over a wall at 10 m, hopping between two columns with the jitter.
        let column = 30 + (index % 2) as u32;
        let depth = Image::from_fn(SIZE, |[x, _]| if x == column { 1.0 } else { 10.0 });
        let input = Input { depth: Some(depth), ..Input::still(noise(SIZE, "wire")) };
        let (out, stats, _) = one(&mut post, index, &input);
        assert!(out.pixels().iter().flatten().all(|v| v.is_finite()));
        flushed.push(stats.flushed());
    }
    assert!(flushed[1..].iter().all(|&n| n == 2 * 48), "the two columns, and only they: {flushed:?}");
}

#[test]
fn h47_a_nan_depth_flushes_its_pixel_alone() {
    let mut post = context(Settings { gate: None, ..Settings::paper() });
    let clean = Input { depth: Some(Image::filled(SIZE, 4.0)), ..Input::still(noise(SIZE, "d")) };
    one(&mut post, 0, &clean);
    let mut depth = Image::filled(SIZE, 4.0);
    depth.pixels_mut()[20 * 64 + 20] = f32::NAN;
    let (_, stats, trace) = one(&mut post, 1, &Input { depth: Some(depth), ..Input::still(noise(SIZE, "d")) });
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
        (DepthConvention::Reversed { near: 0.1, far: f32::INFINITY }, 0.0, 0.05),
        (DepthConvention::Forward { near: 0.1, far: f32::INFINITY }, 1.0, 0.98),
        (DepthConvention::Linear, f32::INFINITY, 5.0),
        (DepthConvention::Orthographic { near: 0.0, far: 100.0 }, 1.0, 0.05),
    ] {
        let desc = ContextDesc { depth, ..ContextDesc::new(SIZE) };
        let mut post = CpuAfterimage::new(desc, Settings::paper()).unwrap();
        let frame = |split| Input { depth: Some(two_walls(split, wall, sky)), ..Input::still(noise(SIZE, "sky")) };
        one(&mut post, 0, &frame(32));
        assert_eq!(one(&mut post, 1, &frame(32)).1.flushed(), 0, "{depth:?}");
        assert_eq!(one(&mut post, 2, &frame(30)).1.flushed(), 2 * 48, "{depth:?}");
    }
}

#[test]
fn h58_nothing_bleeds_over_a_depth_edge() {
    // A bright near square moves right by 1.5 px a frame over a dark wall; vectors are right at each pixel.
    let mut post = context(Settings { gate: None, ..Settings::paper() });
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
}

#[test]
fn h50_z_fighting_shows_only_what_was_presented() {
    let mut post = context(Settings::paper());
    let (a, b) = ([0.25, 0.5, 0.75], [0.75, 0.25, 0.5]);
    let mut draws = Draws::new("z-fighting");
    for index in 0..100 {
        let picks: Vec<bool> = (0..64 * 48).map(|_| draws.uniform() < 0.5).collect();
        let color = Image::from_pixels(SIZE, picks.iter().map(|&p| if p { a } else { b }).collect()).unwrap();
        let depth = Image::from_pixels(SIZE, picks.iter().map(|&p| if p { 3.0 } else { 3.0001 }).collect()).unwrap();
        let (out, stats, trace) = one(&mut post, index, &Input { depth: Some(depth), ..Input::still(color) });
        assert!(out.pixels().iter().all(|&c| c == a || c == b));
        assert_eq!(stats.flushed(), 0);
        assert!(trace.pixels().iter().all(|t| u64::from(t.age) <= index));
    }
}
