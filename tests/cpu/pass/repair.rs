//! Repair of sparse frames: the pixels that a plan chooses, and their output.

use super::*;
use crate::any_frame::{self, any_frame};
use crate::images::View;
use crate::sparse_hard::foveation;
use afterimage::kernel::repair::{KEYS, asked_px, priority, quad_key, threshold};
use afterimage::{Foveation, Lattices, Repair, Smr};

/// Frames in which lattices of steps 2 and 4 visit every position.
const TURN: u64 = 16;
const GAZE: [f32; 2] = [20.0, 20.0];
const SQUARE_PX: u32 = 16;

type Mask = Image<bool>;

fn settings(budget: f32, antialias: bool) -> Settings {
    let method = Method::Smr(Smr { repair: Some(Repair { budget }), antialias, ..Smr::default() });
    Settings { method, foveation: foveation(), ..Settings::default() }
}

/// Smooth waves, so that history fits.
fn waves([x, y]: [f32; 2]) -> [f32; 3] {
    [(0.5 * x).sin(), (0.4 * y + 0.1 * x).cos(), (0.3 * x - 0.35 * y).sin()].map(|v| 0.5 + 0.3 * v)
}

/// A sparse frame of a square at 2 m in front of a wall at 6 m. Frame `index` is one of a still until `from`; then the
/// square moves by `speed_px` a frame.
fn square(index: u64, from: u64, speed_px: [i32; 2], antialias: bool) -> View {
    let moves = index >= from;
    let steps = (index + 1).saturating_sub(from) as i32;
    let low = [0, 1].map(|i| [30, 22][i] + speed_px[i] * steps);
    let jitter = if antialias { Foveation::jitter_px(index) } else { [0.0; 2] };
    let inside = |px: [u32; 2]| (0..2).all(|i| (0..SQUARE_PX as i32).contains(&(px[i] as i32 - low[i])));
    let color = |px: [u32; 2]| {
        let at = [0, 1].map(|i| px[i] as f32 - jitter[i]);
        if inside(px) { waves([0, 1].map(|i| 40.0 + at[i] - low[i] as f32)) } else { waves(at) }
    };
    let motion = |px| if inside(px) && moves { speed_px.map(|v| -v as f32) } else { [0.0; 2] };
    let view = View {
        depth: Some(Image::from_fn(SIZE, |px| if inside(px) { 2.0 } else { 6.0 })),
        motion: Some(Image::from_fn(SIZE, motion)),
        ..View::still(Image::from_fn(SIZE, color), GAZE)
    };
    view.foveated(&foveation(), GAZE, index).with(|view| view.facts.jitter_px = jitter)
}

fn samples(view: &View, [x, y]: [usize; 2]) -> bool {
    let px = [x as u32, y as u32];
    view.facts.lattices.unwrap().at(px).unwrap().samples(px)
}

/// Mask, output and decisions of a frame.
fn show(post: &mut CpuAfterimage, index: u64, view: &View) -> (Mask, Color, Image<PixelTrace>) {
    let images = Images::of(&[view.one()]);
    let frame = images.frame(index);
    let before = post.clone();
    let mask = post.plan(&frame).unwrap()[0].clone();
    assert!(post.plan(&Frame { color: &[], ..frame }).unwrap()[0] == mask, "the second call");
    assert!(post.history() == before.history(), "the question changed history");
    let repaired = view.repaired.as_ref().map(|color| [color]);
    let mut out = [Image::filled(SIZE, [f32::NAN; 3])];
    let mut trace = [Image::filled(SIZE, PixelTrace::default())];
    let frame = Frame { repaired: repaired.as_ref().map(|r| &r[..]), ..frame };
    post.process_traced(&frame, &mut out, &mut trace).unwrap();
    let ([out], [trace]) = (out, trace);
    (mask, out, trace)
}

/// Number of quads of a mask, which consists of quads.
fn quads(mask: &Mask) -> usize {
    let [width, height] = [mask.width(), mask.height()];
    let mut count = 0;
    for (x, y) in (0..height).step_by(2).flat_map(|y| (0..width).step_by(2).map(move |x| (x, y))) {
        let chosen = mask.at(x, y);
        let pixels = [[x, y], [x + 1, y], [x, y + 1], [x + 1, y + 1]];
        let inside = pixels.into_iter().filter(|p| p[0] < width && p[1] < height);
        assert!(inside.into_iter().all(|[x, y]| mask.at(x, y) == chosen), "half a quad at {x}, {y}");
        count += usize::from(chosen);
    }
    count
}

fn all_quads([width, height]: [u32; 2]) -> usize {
    (width.div_ceil(2) * height.div_ceil(2)) as usize
}

#[test]
fn a_settled_still_wants_nothing() {
    for antialias in [false, true] {
        let mut post = context(settings(1.0, antialias));
        let counts: Vec<_> = (0..3 * TURN)
            .map(|index| quads(&show(&mut post, index, &square(index, u64::MAX, [0, 0], antialias)).0))
            .collect();
        println!("antialias {antialias}: quads wanted frame by frame {counts:?}");
        assert!(counts[0] > 500 && counts[4] > 300, "everything outside the fovea is wanted at first");
        assert!(counts[TURN as usize..].iter().all(|&n| n == 0), "{counts:?}");
    }
}

#[test]
fn the_mask_has_the_verdicts_of_process() {
    for antialias in [false, true] {
        for speed_px in [[5, 3], [-7, 2], [0, -6]] {
            let mut post = context(settings(1.0, antialias));
            let (mut rejected, mut chosen) = (0, 0);
            for index in 0..=2 * TURN {
                // In the last frame, the lowest rows are distrusted.
                let trust = Image::from_fn(SIZE, |[_, y]| if index == 2 * TURN && y >= 45 { 0.0 } else { 1.0 });
                let view = View { trust: Some(trust), ..square(index, 2 * TURN, speed_px, antialias) };
                let (mask, _, trace) = show(&mut post, index, &view);
                if index < 2 * TURN && index > 0 {
                    continue;
                }
                // No history is coarse: the previous frame was settled, or history is empty.
                let wants = |x: usize, y: usize| {
                    let t = trace.at(x, y);
                    let unexplained = t.verdict != Verdict::Valid || t.survival == 0.0;
                    !samples(&view, [x, y]) && unexplained
                };
                for (x, y) in (0..SIZE[1] as usize).flat_map(|y| (0..SIZE[0] as usize).map(move |x| (x, y))) {
                    let asked = [0, 1].map(|i| asked_px(i, x as u32 / 2, y as u32 / 2, index as u32));
                    let any = asked.iter().any(|&[x, y]| wants(x as usize, y as usize));
                    assert_eq!(mask.at(x, y), any, "antialias {antialias}, frame {index}, pixel ({x}, {y})");
                    let is_rejected = trace.at(x, y).verdict != Verdict::Valid && !samples(&view, [x, y]);
                    rejected += usize::from(index > 0 && is_rejected);
                }
                chosen = quads(&mask);
            }
            println!("antialias {antialias}, {speed_px:?}: {rejected} pixels uncovered, {chosen} quads chosen");
            assert!(rejected > 40 && 4 * chosen < 6 * rejected, "{rejected} pixels, {chosen} quads");
        }
    }
}

#[test]
fn repaired_pixels_show_their_samples_and_others_change_nothing() {
    for antialias in [false, true] {
        let mut post = context(settings(1.0, antialias));
        for index in 0..=2 * TURN {
            let view = square(index, 2 * TURN, [5, 3], antialias);
            let (mut plain, mut emptied) = (post.clone(), post.clone());
            let (_, without, trace) = show(&mut plain, index, &view);
            let unshaded = View { repaired: Some(Image::filled(SIZE, [f32::NAN; 3])), ..view.clone() };
            let (_, out, _) = show(&mut emptied, index, &unshaded);
            assert!(out == without && emptied.history() == plain.history(), "no pixel was shaded");
            // Other colors than the samples', and every seventh pixel is not a number.
            let bad = |i: usize| i.is_multiple_of(7);
            let shaded = Image::from_fn(SIZE, |[x, y]| {
                let i = (y * SIZE[0] + x) as usize;
                let v = (i % 1024) as f32 / 1024.0;
                if bad(i) { [0.5, f32::NAN, v] } else { [v, 0.25, 1.0 - v] }
            });
            let (mask, with, _) = show(&mut post, index, &View { repaired: Some(shaded.clone()), ..view.clone() });
            let mut shown = 0;
            for (i, &wanted) in mask.pixels().iter().enumerate() {
                let [x, y] = [i % SIZE[0] as usize, i / SIZE[0] as usize];
                let (got, shaded) = (with.pixels()[i], shaded.pixels()[i]);
                let is_fine = view.facts.lattices.unwrap().at([x as u32, y as u32]).unwrap().step == 1;
                if !wanted || bad(i) || is_fine {
                    assert_eq!(got, without.pixels()[i], "frame {index}, pixel ({x}, {y})");
                } else if !antialias || trace.pixels()[i].verdict != Verdict::Valid {
                    assert_eq!(got, shaded, "frame {index}, pixel ({x}, {y})");
                    shown += 1;
                }
            }
            assert!(shown > 0 || (1..2 * TURN).contains(&index), "frame {index}: {shown}");
            if index < 2 * TURN {
                post = plain;
            }
        }
    }
}

#[test]
fn two_eyes_are_planned_as_one_would_be_and_a_lost_gaze_is_held() {
    let fresh = |view_count| {
        CpuAfterimage::new(&ContextDesc { settings: settings(0.05, false), view_count, ..ContextDesc::new(SIZE) })
            .unwrap()
    };
    let (mut both, mut left) = (fresh(2), fresh(1));
    let mut differ = false;
    for index in 0..8 {
        let input = square(index, 3, [3, 1], false);
        let mut here = input.one();
        let mut there = here;
        there.facts.gaze = if index == 0 { Gaze::At { px: [50.0, 40.0] } } else { Gaze::Lost };
        if index == 5 {
            here.facts.gaze = Gaze::Lost;
        }
        let images = [Images::of(&[here, there]), Images::of(&[here])];
        let masks = both.plan(&images[0].frame(index)).unwrap().to_vec();
        assert_eq!(masks[0], left.plan(&images[1].frame(index)).unwrap()[0], "frame {index}");
        differ |= masks[0] != masks[1];
        let mut held = there;
        held.facts.gaze = Gaze::At { px: [50.0, 40.0] };
        assert_eq!(masks, both.plan(&Images::of(&[here, held]).frame(index)).unwrap(), "the gaze is held");
        let mut out = vec![Image::filled(SIZE, [0.0; 3]); 2];
        both.process(&images[0].frame(index), &mut out).unwrap();
        left.process(&images[1].frame(index), &mut out[..1]).unwrap();
    }
    assert!(differ, "the eyes look elsewhere");
}

#[test]
fn a_reset_wants_everything_again() {
    let mut post = context(settings(1.0, false));
    for index in 0..=TURN {
        let view = square(index, u64::MAX, [0, 0], false);
        let images = Images::of(&[view.one()]);
        let after_a_cut = Frame { reset: Reset::All, ..images.frame(index) };
        let mut fresh = context(settings(1.0, false));
        assert_eq!(post.plan(&after_a_cut).unwrap(), fresh.plan(&images.frame(index)).unwrap());
        show(&mut post, index, &view);
    }
}

#[test]
fn what_does_not_fit_is_refused() {
    let input = square(0, u64::MAX, [0, 0], false);
    let (images, repaired) = (Images::of(&[input.one()]), [&input.color]);
    let mut plain = context(Settings { method: MethodKind::Smr.into(), ..settings(0.1, false) });
    let mut post = context(settings(0.1, false));
    let mut out = [Image::filled(SIZE, [0.0; 3])];
    let frame = Frame { repaired: Some(&repaired), ..images.frame(0) };
    let refused = |result: Result<(), FrameError>, words: &str| {
        let error = result.unwrap_err().to_string();
        assert!(error.starts_with(words), "{error}");
    };
    refused(plain.plan(&images.frame(0)).map(drop), "Smr::repair of view 0 is None: expected given");
    let unset = "repaired of view 0 is given: expected None; or set Smr::repair";
    refused(plain.process(&frame, &mut out).map(drop), unset);
    let unplanned = "repaired of view 0 is given: expected None, or that plan was called with this frame";
    refused(post.process(&frame, &mut out).map(drop), unplanned);
    post.plan(&frame).unwrap();
    refused(post.process(&Frame { index: 1, ..frame }, &mut out).map(drop), unplanned);
    let small = [&Image::filled([8, 8], [0.0; 3])];
    refused(post.process(&Frame { repaired: Some(&small), ..frame }, &mut out).map(drop), "repaired of view 0 is 8x8");
    post.process(&frame, &mut out).unwrap();
    refused(post.process(&frame, &mut out).map(drop), unplanned);
    for budget in [-0.1, 1.1, f32::NAN] {
        let error = settings(budget, false).validate().unwrap_err().to_string();
        assert!(error.starts_with("smr.repair.budget is "), "{error}");
    }
}

#[test]
fn priorities_are_ordered_by_class_then_by_ring() {
    assert_eq!([(0.0, 0.0), (0.99, 90.0)].map(|(lod, e_deg)| priority(lod, e_deg)), [0; 2]);
    let wanted = [(-1.0, 0.0), (-1.0, 180.0), (1.0, 0.0), (8.0, 180.0)];
    assert_eq!(wanted.map(|(lod, e_deg)| priority(lod, e_deg)), [62, 32, 31, 1]);
    for ring in 1..40 {
        let e_deg = ring as f32 * 3.0;
        assert!(priority(-1.0, e_deg) <= priority(-1.0, e_deg - 3.0) && priority(-1.0, e_deg) > priority(2.0, 0.0));
    }
    let largest = (0..1000).map(|i| quad_key(62, i, 0, 0, 0)).max().unwrap();
    assert!((62 << 8..KEYS).contains(&largest));
    assert!((0..1000).all(|i| quad_key(0, i, 0, 0, 0) == 0));
    assert!(quad_key(62, 5, 7, 0, 0) != quad_key(62, 5, 7, 1, 0), "every frame has another order");
}

/// Any frame of 8x6 pixels with lattices.
fn sparse_any(draws: &mut Draws, wild: f32, index: u64, at_samples: bool) -> View {
    let frame = any_frame(draws, wild);
    let mut frame = frame.foveated(&foveation(), [draws.range(0.0, 8.0), draws.range(0.0, 6.0)], index);
    if at_samples {
        frame.facts.lattices = frame.facts.lattices.map(Lattices::with_geometry_at_samples);
    }
    if draws.uniform() < 0.2 {
        frame.facts.gaze = Gaze::Lost;
    }
    frame
}

proptest! {
    #![proptest_config(afterimage_testing::property("repair", 200))]

    #[test]
    fn a_budget_is_never_exceeded_and_used_up_to_one_key(counts in prop::collection::vec(0u32..50, 2..200), budget in 0u32..3000) {
        let key = threshold(&counts, budget) as usize;
        let chosen = |key: usize| counts[key..].iter().sum::<u32>();
        prop_assert!(key >= 1 && chosen(key) <= budget);
        prop_assert!(key == 1 || chosen(key - 1) > budget);
    }

    #[test]
    fn any_frames_are_within_the_budget(name in any::<u64>(), wild in prop::sample::select(vec![0.0, 0.1, 1.0]), budget in 0.0f32..=1.0, [antialias, noisy, at_samples] in any::<[bool; 3]>()) {
        let mut draws = Draws::new(&name.to_string());
        let size = any_frame::SIZE;
        let settings = Settings { noisy, ..settings(budget, antialias) };
        let desc = ContextDesc { settings, view_count: 2, ..ContextDesc::new(size) };
        let mut post = CpuAfterimage::new(&desc).unwrap();
        for index in 0..4 {
            let frames = [0; 2].map(|_| sparse_any(&mut draws, wild, index, at_samples));
            let views = frames.each_ref().map(|f| OneView {
                lod: None,
                noise: f.noise.as_ref().filter(|_| noisy),
                ..f.one()
            });
            let images = Images::of(&views);
            let reset = if draws.uniform() < 0.2 { Reset::All } else { Reset::None };
            let frame = Frame { reset, ..images.frame(index) };
            let before = post.clone();
            let masks = post.plan(&frame).unwrap().to_vec();
            prop_assert_eq!(post.plan(&Frame { color: &[], noise: None, ..frame }).unwrap(), &masks);
            prop_assert!(post.history() == before.history());
            for mask in &masks {
                prop_assert!(quads(mask) as f64 <= f64::from(budget) * all_quads(size) as f64);
            }
            let repaired = frames.each_ref().map(|f| &f.color);
            let mut out = vec![Image::filled(size, [f32::NAN; 3]); 2];
            post.process(&Frame { repaired: Some(&repaired), ..frame }, &mut out).unwrap();
            prop_assert!(out.iter().flat_map(|o| o.pixels()).flatten().all(|v| v.is_finite()));
        }
    }
}
