//! Hard cases of motion, H51 to H54, H58 to H60 and H105: laws that hold on either executor.

use crate::depth_hard::{METHODS, Made, Make, SIZE, is_planned, of, still, ungated_and_planned};
use crate::images::{View, noise, pixel, pixels};
use afterimage::internal::{ContextDesc, MethodKind, ViewFrame};
use afterimage::{DepthConvention, Image, MotionConvention, Verdict, ViewGeometry};
use glam::{DMat4, DVec2, DVec3};

/// The laws as tests of an executor. `$run_law` runs one, and returns what it measured.
macro_rules! motion_laws {
    ($side:ident, $run_law:ident) => {
        crate::laws::laws! { $side, $run_law,
            h51_a_thousand_still_frames_never_move_a_sample: "H51", still_frames;
            h52_an_integer_shift_moves_history_exactly_and_marks_the_border_new: "H52", whole_shift;
            h53_half_pixel_motion_never_blurs: "H53", half_pixels;
            h54_garbage_motion_shows_the_candidate: "H54", garbage_motion;
            h58_nothing_bleeds_over_a_depth_edge: "H58", depth_edge;
            h59_a_zoom_leaves_no_hole: "H59", zoom;
            h60_a_turn_is_a_full_reset: "H60", turn;
            h105_what_has_no_vector_follows_the_camera: "H105", camera_motion;
        }
    };
}
pub(crate) use motion_laws;

pub fn still_frames(make: Make<'_>) -> Option<String> {
    // Every frame has another picture at the same depths: each output pixel is the sample of some frame at that pixel.
    let mut post = make(of(MethodKind::Wrs))?;
    let mut seen = vec![std::collections::HashSet::new(); 64 * 48];
    let depth = Image::from_fn(SIZE, |[x, y]| 1.0 + ((x / 5) * (y / 3)) as f32);
    let mut kept = 0;
    for index in 0..1000 {
        let input = View {
            depth: Some(depth.clone()),
            motion: Some(Image::filled(SIZE, [0.0, -0.0])),
            ..still(noise(SIZE, &format!("still {index}")))
        };
        let Made { shown: out, stats, trace, .. } = post.step(index, &input);
        assert_eq!(stats.rejected(), 0);
        for (i, colors) in seen.iter_mut().enumerate() {
            colors.insert(input.color.pixels()[i].map(f32::to_bits));
            assert!(colors.contains(&out.pixels()[i].map(f32::to_bits)), "frame {index}, pixel {i}");
        }
        kept += trace.pixels().iter().filter(|t| !t.is_replaced).count();
    }
    Some(format!("wrs, 1000 frames of noise over 200 depths: {kept} samples kept, each at its own pixel, bit for bit"))
}

pub fn whole_shift(make: Make<'_>) -> Option<String> {
    let mut border = 0;
    for (shift, right) in [([3.0, -2.0], true), ([-3.0, 2.0], false)] {
        let mut post = make(of(MethodKind::Wrs))?;
        let before = noise(SIZE, "before");
        post.step(0, &still(before.clone()));
        post.stick();
        let input = View { motion: Some(Image::filled(SIZE, shift)), ..still(noise(SIZE, "after")) };
        let Made { shown: out, trace, .. } = post.step(1, &input);
        let mut wrong = 0;
        border = 0;
        for px in pixels(SIZE) {
            let source = [px[0] + 3, px[1].wrapping_sub(2)];
            let inside = source[0] < 64 && source[1] < 48;
            let from_source = || (pixel(&before, source), Verdict::Valid);
            let expected = if inside { from_source() } else { (pixel(&input.color, px), Verdict::OffScreen) };
            wrong += u32::from((pixel(&out, px), pixel(&trace, px).verdict) != expected);
            border += u32::from(!inside);
        }
        assert_eq!(wrong == 0, right, "{wrong} wrong; the planted error: the other sign");
    }
    assert_eq!(border, 64 * 48 - 61 * 46);
    Some(format!("wrs: {} samples moved bit for bit, {border} of the border new", 61 * 46))
}

pub fn half_pixels(make: Make<'_>) -> Option<String> {
    // Nearest reprojection moves samples by whole pixels: after 200 frames of 0.5 px every color is still one of the
    // input colors.
    let mut post = make(of(MethodKind::Wrs))?;
    let mut known = std::collections::HashSet::new();
    let mut kept = 0;
    for index in 0..200 {
        let color = noise(SIZE, &format!("frame {index}"));
        known.extend(color.pixels().iter().map(|c| c.map(f32::to_bits)));
        let input = View { motion: Some(Image::filled(SIZE, [-0.5, 0.5])), ..still(color) };
        let Made { shown: out, trace, .. } = post.step(index, &input);
        assert!(out.pixels().iter().all(|c| known.contains(&c.map(f32::to_bits))), "H22: no invented colors");
        kept += trace.pixels().iter().filter(|t| !t.is_replaced).count();
    }
    Some(format!("wrs, 0.5 px x 200: {kept} samples kept, no color that no frame brought; nearest, nothing is mixed"))
}

/// Vectors that are not numbers, or far too long.
pub fn garbage_motion(make: Make<'_>) -> Option<String> {
    for method in METHODS {
        let mut post = make(of(method))?;
        post.step(0, &still(noise(SIZE, "a")));
        for (index, bad) in (1..).zip([f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e9, -1e9, f32::MAX]) {
            if method == MethodKind::Wrs {
                post.stick();
            }
            let mut motion = Image::filled(SIZE, [0.0; 2]);
            motion.pixels_mut()[5 * 64 + 7] = [bad, 0.0];
            motion.pixels_mut()[6 * 64 + 7] = [0.0, bad];
            let input = View { motion: Some(motion), ..still(noise(SIZE, "b")) };
            let Made { shown: out, stats, .. } = post.step(index, &input);
            assert_eq!((stats.verdicts[Verdict::BadMotion as usize], stats.rejected()), (2, 2), "{method:?}, {bad}");
            assert_eq!((out.at(7, 5), out.at(7, 6)), (input.color.at(7, 5), input.color.at(7, 6)));
        }
    }
    Some("wrs and smr: NaN, infinities, +-1e9, 3e38 on either axis show the candidate, and return".into())
}

pub fn depth_edge(make: Make<'_>) -> Option<String> {
    // A bright near square moves right by 1.5 px a frame over a dark wall; vectors are right at each pixel.
    let mut post = make(of(MethodKind::Wrs))?;
    for index in 0..30_u64 {
        let left = 4.0 + 1.5 * index as f32;
        let inside = |x: u32, y: u32| (left..left + 10.0).contains(&(x as f32)) && (10..30).contains(&y);
        let input = View {
            color: Image::from_fn(SIZE, |[x, y]| if inside(x, y) { [1.0; 3] } else { [0.125; 3] }),
            depth: Some(Image::from_fn(SIZE, |[x, y]| if inside(x, y) { 1.0 } else { 8.0 })),
            motion: Some(Image::from_fn(SIZE, |[x, y]| if inside(x, y) { [-1.5, 0.0] } else { [0.0, 0.0] })),
            ..still(noise(SIZE, ""))
        };
        let out = post.step(index, &input).shown;
        assert_eq!(out, input.color, "frame {index}");
    }
    Some("wrs, a square at 1.5 px a frame over a wall, 30 frames: no pixel bleeds".into())
}

pub fn zoom(make: Make<'_>) -> Option<String> {
    let before = noise(SIZE, "zoom");
    let zoomed = |factor: f32| -> Option<[u64; 2]> {
        let mut post = make(of(MethodKind::Wrs))?;
        post.step(0, &still(before.clone()));
        post.stick();
        // Previous minus current, about pixel (32, 24).
        let motion = Image::from_fn(SIZE, |[x, y]| [x as f32 - 32.0, y as f32 - 24.0].map(|v| v * (factor - 1.0)));
        let input = View { motion: Some(motion), ..still(noise(SIZE, "zoom 2")) };
        let Made { shown: out, stats, trace, .. } = post.step(1, &input);
        let (mut kept, mut sources) = (0, std::collections::HashSet::new());
        for px in pixels(SIZE) {
            let source = [0, 1].map(|i| ([32.0, 24.0][i] + (px[i] as f32 - [32.0, 24.0][i]) * factor + 0.5).floor());
            let (shown, t) = (pixel(&out, px), pixel(&trace, px));
            if (0.0..64.0).contains(&source[0]) && (0.0..48.0).contains(&source[1]) {
                let source = source.map(|v| v as u32);
                assert_eq!((shown, t.age, t.is_replaced), (pixel(&before, source), 1, false));
                sources.insert(source);
                kept += 1;
            } else {
                assert_eq!((shown, t.age, t.verdict), (pixel(&input.color, px), 0, Verdict::OffScreen));
            }
        }
        assert_eq!(stats.rejected(), 64 * 48 - kept);
        Some([kept, sources.len() as u64])
    };
    let ([near, originals], [far, all]) = (zoomed(0.5)?, zoomed(2.0)?);
    assert!(near == 64 * 48 && near > 3 * originals && far == all && far < 1000);
    Some(format!(
        "wrs, in x2: {near} show {originals} samples, ages kept; out x2: {far} kept, the rest is the candidate"
    ))
}

pub fn turn(make: Make<'_>) -> Option<String> {
    for (method, lod) in [(MethodKind::Wrs, None), (MethodKind::Smr, None), (MethodKind::Smr, Some(2.0))] {
        let mut post = make(of(method))?;
        post.step(0, &still(noise(SIZE, "turn 0")));
        let lod = lod.map(|lod| Image::filled(SIZE, lod));
        let turn = View { motion: Some(Image::filled(SIZE, [5000.0, 0.0])), lod, ..still(noise(SIZE, "turn")) };
        let Made { shown: out, stats, .. } = post.step(1, &turn);
        assert_eq!((out, stats.rejected()), (turn.color, 64 * 48), "{method:?}");
    }
    Some("wrs and smr: all 3072 pixels are the candidate, bit for bit".into())
}

const REVERSED: DepthConvention = DepthConvention::Reversed { near: 0.1, far: 100.0 };
const JITTER_PX: [f32; 2] = [0.25, -0.3];

/// Pose of a camera that turns and moves; y up, -z forward. A million metres from the origin.
fn pose(index: u64) -> DMat4 {
    let turn = DMat4::from_rotation_y(0.02 * index as f64) * DMat4::from_rotation_x(-0.01 * index as f64);
    DMat4::from_translation(DVec3::new(1e6 + 0.05 * index as f64, 1.6, -2e6 - 0.08 * index as f64)) * turn
}

/// Distance of a pixel's surface; infinite for the sky.
fn distance([x, y]: [u32; 2]) -> f64 {
    if y < 12 { f64::INFINITY } else { 1.0 + f64::from((x / 8) * (y / 6)) }
}

/// Whether a pixel shows the object that moves.
fn is_object([x, y]: [u32; 2]) -> bool {
    (20..30).contains(&x) && (20..30).contains(&y)
}

/// The object's own motion in pixels.
const OWN_PX: [f32; 2] = [3.0, -1.0];

/// Motion vector of a pixel by its definition, in doubles: where the point that it shows was in the previous frame.
fn expected_vector(px: [u32; 2], own: [f32; 2], now: &ViewGeometry, before: &ViewGeometry) -> DVec2 {
    let rays = |geometry: &ViewGeometry| {
        let (scale, offset) = geometry.scale_offset();
        [scale, offset].map(|v| DVec2::from(v.map(f64::from)))
    };
    let ([scale, offset], [old_scale, old_offset]) = (rays(now), rays(before));
    let shown = DVec2::new(f64::from(px[0]), f64::from(px[1])) - DVec2::from(JITTER_PX.map(f64::from));
    let tangent = (shown + DVec2::from(own.map(f64::from))) * scale + offset;
    let z = distance(px);
    // y up, -z forward.
    let ray = DVec3::new(tangent.x, -tangent.y, -1.0);
    let previous_from_current = pose(0).inverse() * pose(1);
    let seen = match z.is_finite() {
        true => previous_from_current.transform_point3(ray * z),
        false => previous_from_current.transform_vector3(ray),
    };
    let old_tangent = DVec2::new(seen.x, -seen.y) / -seen.z;
    (old_tangent - old_offset) / old_scale - shown
}

/// Vectors that lack the camera's motion: all, those of what stands still, or without a motion input.
pub fn camera_motion(make: Make<'_>) -> Option<String> {
    let none = [7.0, -2.5];
    let [now, before] = [70.0, 72.0].map(|hfov_deg| ViewGeometry::flat(SIZE, hfov_deg).unwrap());
    let object =
        |vector: [f32; 2], still: [f32; 2]| Some(Image::from_fn(SIZE, |px| if is_object(px) { vector } else { still }));
    let except = MotionConvention { no_vector: Some(none), ..MotionConvention::default() };
    let excluded = MotionConvention { without_camera: true, ..MotionConvention::default() };
    let both = MotionConvention { no_vector: Some(none), ..excluded };
    // The vectors of the object: complete ones, or its own motion.
    let inputs = [
        (excluded, None, None),
        (except, None, None),
        (except, object([5.0, 2.0], none), Some([5.0, 2.0])),
        (except, object([5.0, 2.0], [f32::NAN, 0.0]), Some([5.0, 2.0])),
        (excluded, object(OWN_PX, [0.0; 2]), None),
        (both, object(OWN_PX, none), None),
    ];
    let (mut largest, mut zero) = (0.0_f64, 0.0_f64);
    for desc in ungated_and_planned() {
        for (convention, motion, complete) in &inputs {
            let mut post = make(ContextDesc { motion: *convention, depth: REVERSED, ..desc })?;
            let depth = Image::from_fn(SIZE, |px| ((1.0 / distance(px) - 0.01) / 9.99).max(0.0) as f32);
            let view = |index: u64, geometry: ViewGeometry| {
                let mut view = View { depth: Some(depth.clone()), ..still(noise(SIZE, &format!("camera {index}"))) };
                let [pose, previous] = [index, index.saturating_sub(1)].map(|i| pose(i).to_cols_array_2d());
                view.facts = ViewFrame { geometry, ..view.facts }.posed(pose, previous).unwrap();
                View { motion: motion.clone(), ..view }
            };
            post.step(0, &view(0, before));
            let mut second = view(1, now);
            second.facts.jitter_px = JITTER_PX;
            // A pixel without distance.
            second.depth.as_mut().unwrap().pixels_mut()[40 * 64 + 3] = f32::NAN;
            let trace = post.step(1, &second).trace;
            assert_eq!(trace.at(3, 40).verdict, Verdict::BadMotion);
            // At silhouettes planned frames have the vector of the nearer surface.
            let is_inside = |px: [u32; 2]| {
                let around = |[x, y]: [u32; 2]| [[x - 1, y], [x + 1, y], [x, y - 1], [x, y + 1]];
                let surface = |px| (distance(px).to_bits(), is_object(px));
                (0..2).all(|i| (1..SIZE[i] - 1).contains(&px[i]))
                    && around(px).into_iter().all(|beside| beside != [3, 40] && surface(beside) == surface(px))
            };
            for px in pixels(SIZE).filter(|&px| px != [3, 40] && (!is_planned(&desc) || is_inside(px))) {
                let found = DVec2::from(pixel(&trace, px).motion.map(f64::from));
                let own = if motion.is_some() && is_object(px) { OWN_PX } else { [0.0; 2] };
                let expected = match complete {
                    Some(vector) if is_object(px) => DVec2::from(vector.map(f64::from)),
                    _ => expected_vector(px, own, &now, &before),
                };
                largest = largest.max((found - expected).length());
                // The planted error: nothing moves.
                zero = zero.max(expected.length());
            }
        }
    }
    assert!(largest < 1e-3 && zero > 2.0, "{largest} px, {zero} px");
    still_camera(make)?;
    Some(format!(
        "wrs, smr and planned, 1e6 m from the origin, turning, moving, zooming, sky: vectors within {largest:.0e} px; a still \
         camera's are 0; zero vectors are {zero:.1} px off"
    ))
}

/// The vectors of a camera that stands still are exactly 0.
fn still_camera(make: Make<'_>) -> Option<()> {
    let mut desc = of(MethodKind::Smr);
    desc.motion.without_camera = true;
    let mut post = make(desc)?;
    let pose = pose(9).to_cols_array_2d();
    for index in 0..3 {
        let depth = Image::from_fn(SIZE, |px| distance(px) as f32);
        let mut view = View { depth: Some(depth), ..still(noise(SIZE, "still camera")) };
        view.facts = view.facts.posed(pose, pose).unwrap();
        view.facts.jitter_px = JITTER_PX;
        let trace = post.step(index, &view).trace;
        assert!(index == 0 || trace.pixels().iter().all(|t| t.motion == [0.0; 2] && t.verdict == Verdict::Valid));
    }
    Some(())
}
