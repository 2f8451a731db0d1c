//! Resets, sizes, views, trust.

use super::rig::*;
use afterimage::{Filter, Method, Smr, Verdict};

/// Frames of a fading picture, half of it coarse, so that all output depends on earlier frames.
fn frame(index: u64) -> View {
    let picture = noise(SIZE, "run").map(|c| c.map(|v| v * (1.0 + 0.02 * index as f32)));
    let lods = Image::from_fn(SIZE, |[x, _]| if (u64::from(x) + 5 * index) % 26 < 13 { 0.0 } else { 1.5 });
    View { lod: Some(lods.clone()), ..sharp(LowPass::new(&picture, 4).render(&lods)) }
}

fn run(post: &mut CpuAfterimage, frames: std::ops::Range<u64>) -> Vec<Made> {
    frames.map(|index| step(post, index, &frame(index))).collect()
}

#[test]
fn another_method_and_back_equals_a_fresh_context() {
    for method in METHODS {
        let fresh = run(&mut context(method), 10..14);
        let mut changed = context(method);
        run(&mut changed, 0..10);
        assert_ne!(run(&mut changed.clone(), 10..14)[0].shown, fresh[0].shown, "the planted error: no change");
        let other = if method == MethodKind::Taa { MethodKind::Smr } else { MethodKind::Taa };
        for kind in [MethodKind::Wrs, MethodKind::None, other, method] {
            changed.set_settings(settings(kind)).unwrap();
        }
        assert_eq!(run(&mut changed, 10..14), fresh, "{method:?}");
    }
}

#[test]
fn tunables_change_without_a_loss_of_history() {
    let mut post = context(MethodKind::Smr);
    run(&mut post, 0..4);
    let changed = |smr| Settings { method: Method::Smr(smr), ..settings(MethodKind::Smr) };
    post.set_settings(changed(Smr { tolerance: 2.0, ..Smr::default() })).unwrap();
    assert!(run(&mut post, 4..5)[0].trace.pixels().iter().all(|t| t.verdict == Verdict::Valid));
    assert!(post.set_settings(changed(Smr { accumulate: 0.99, ..Smr::default() })).is_err());
}

#[test]
fn h76_any_size_down_to_a_pixel_works_and_takes_what_is_documented() {
    for size in [[1, 1], [1, 17], [17, 1], [2, 3], [33, 31]] {
        for filter in [Filter::Mip, Filter::Gauss, Filter::Block, Filter::Off] {
            for method in METHODS {
                let mut settings = settings(method);
                settings.foveation.filter = filter;
                let mut post = context_of(size, settings);
                for index in 0..3 {
                    let input = View {
                        lod: None,
                        depth: Some(Image::filled(size, 1.0)),
                        motion: Some(Image::filled(size, [0.25, 0.0])),
                        ..sharp(noise(size, "sizes"))
                    };
                    let made = step(&mut post, index, &input);
                    assert!(made.shown.pixels().iter().flatten().all(|v| v.is_finite()));
                    assert!(index > 0 || made.shown == input.color);
                }
            }
        }
    }
    // Two words of two frames, and for smr levels 1 to 4 of sixteen bytes a texel of two frames: a quarter, a
    // sixteenth, ...
    let bytes = |method| context_of([64, 48], settings(method)).memory_bytes();
    let texels = 32 * 24 + 16 * 12 + 8 * 6 + 4 * 3;
    assert_eq!((bytes(MethodKind::Taa), bytes(MethodKind::Smr)), (16 * 64 * 48, 16 * 64 * 48 + 32 * texels));
}

#[test]
fn views_know_nothing_of_each_other() {
    for method in METHODS {
        let desc = ContextDesc { view_count: 2, ..ContextDesc::new(SIZE) };
        let fresh = || CpuAfterimage::new(&ContextDesc { settings: settings(method), ..desc }).unwrap();
        let (mut both, mut swapped) = (fresh(), fresh());
        let (mut left, mut right) = (context(method), context(method));
        for index in 0..5 {
            let a = View::still(frame(index).color, [10.0, 10.0]);
            let b = View::still(noise(SIZE, &format!("other eye {index}")), [40.0, 30.0]);
            let (alone_a, alone_b) = (step(&mut left, index, &a), step(&mut right, index, &b));
            for (made, expected) in [
                (step_views(&mut both, index, &[&a, &b]), [&alone_a, &alone_b]),
                (step_views(&mut swapped, index, &[&b, &a]), [&alone_b, &alone_a]),
            ] {
                for (made, alone) in made.iter().zip(expected) {
                    assert_eq!((&made.shown, &made.words, &made.trace), (&alone.shown, &alone.words, &alone.trace));
                }
            }
        }
    }
}

#[test]
fn trust_of_1_changes_nothing_and_of_0_shows_the_candidate() {
    for method in METHODS {
        let mut plain = context(method);
        run(&mut plain, 0..5);
        let expected = step(&mut plain.clone(), 5, &frame(5));
        let mask = |at: [u32; 2]| (at[0] / 7 % 2) as f32;
        let full = View { trust: Some(Image::filled(SIZE, 1.0)), ..frame(5) };
        assert_eq!(step(&mut plain.clone(), 5, &full), expected);
        let made = step(&mut plain, 5, &View { trust: Some(Image::from_fn(SIZE, mask)), ..frame(5) });
        for (i, t) in made.trace.pixels().iter().enumerate() {
            if mask([i as u32 % 52, 0]) == 0.0 {
                assert_eq!(t.verdict, Verdict::Distrusted);
                assert_eq!(made.shown.pixels()[i], frame(5).color.pixels()[i]);
            } else {
                assert_eq!(made.shown.pixels()[i], expected.shown.pixels()[i]);
            }
        }
        let half = (0..52).filter(|x| x / 7 % 2 == 0).count() as u64 * 41;
        assert_eq!(made.stats.verdicts[Verdict::Distrusted as usize], half);
    }
}

#[test]
fn half_the_trust_is_half_the_history() {
    let mut post = context(MethodKind::Smr);
    let first = step(&mut post, 0, &sharp(noise(SIZE, "half trust")));
    let coarse = LowPass::new(&first.stored(), 4).render(&Image::filled(SIZE, 2.0));
    let input = View { trust: Some(Image::filled(SIZE, 0.5)), ..at_lod(coarse.clone(), 2.0) };
    let made = step(&mut post, 1, &input);
    for (i, shown) in made.shown.pixels().iter().enumerate() {
        let (c, h) = (coarse.pixels()[i], first.stored().pixels()[i]);
        assert!((0..3).all(|k| (shown[k] - 0.5 * (c[k] + h[k])).abs() < 1e-6));
        // Half way from level 0 to 2, in sevenths.
        assert_eq!(made.surfaces()[i].lod, 1.0);
    }
    // taa uses the larger one of its own share of the candidate and 1 - trust.
    let mut post = context(MethodKind::Taa);
    step(&mut post, 0, &frame(0));
    let input = View { trust: Some(Image::filled(SIZE, 0.25)), ..frame(1) };
    assert!(step(&mut post, 1, &input).trace.pixels().iter().all(|t| t.history_share == 0.25));
}

#[test]
fn beside_a_depth_edge_another_texel_stands_in_for_the_nearest_one() {
    // The far pixel in column 26 was at 25.4 or 25.05: the nearest texel shows the near surface, and the one that shows
    // the far surface has a weight of 0.4 or 0.05.
    let near = |[x, _]: [u32; 2]| x < 26;
    let far_color = [0.1, 0.2, 0.4];
    let color = Image::from_fn(SIZE, |at| if near(at) { [0.9, 0.6, 0.3] } else { far_color });
    let depth = Some(Image::from_fn(SIZE, |at| if near(at) { 1.0 } else { 3.0 }));
    for method in METHODS {
        for (motion_px, verdict) in [(-0.6, Verdict::Valid), (-0.95, Verdict::Disoccluded)] {
            let mut post = context(method);
            step(&mut post, 0, &View { depth: depth.clone(), ..sharp(color.clone()) });
            let motion = Some(Image::filled(SIZE, [motion_px, 0.0]));
            let made = step(&mut post, 1, &View { depth: depth.clone(), motion, ..at_lod(color.clone(), 1.0) });
            for y in 0..SIZE[1] as usize {
                assert_eq!(made.trace.at(26, y).verdict, verdict, "{method:?} by {motion_px} px in row {y}");
                let shown = made.shown.at(26, y);
                assert!((0..3).all(|k| (shown[k] - far_color[k]).abs() < 0.006 * far_color[k]), "{shown:?}");
            }
        }
    }
}
