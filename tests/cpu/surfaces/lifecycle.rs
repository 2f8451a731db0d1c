//! Resets, sizes, views, trust.

use super::rig::*;
use afterimage::Verdict;
use afterimage::internal::{Method, Smr};

/// Frames of a fading picture, half of it coarse, so that all output depends on earlier frames.
fn frame(index: u64) -> View {
    let picture = times(&noise(SIZE, "run"), 1.0 + 0.02 * index as f32);
    let lods = Image::from_fn(SIZE, |[x, _]| if (u64::from(x) + 5 * index) % 26 < 13 { 0.0 } else { 1.5 });
    View { lod: Some(lods.clone()), ..sharp(LowPass::new(&picture, 4).render(&lods)) }
}

fn run(post: &mut CpuAfterimage, frames: std::ops::Range<u64>) -> Vec<Made> {
    frames.map(|index| post.step(index, &frame(index))).collect()
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
fn trust_of_1_changes_nothing_and_of_0_shows_the_candidate() {
    for method in METHODS {
        let mut plain = context(method);
        run(&mut plain, 0..5);
        let expected = plain.clone().step(5, &frame(5));
        let mask = |at: [u32; 2]| (at[0] / 7 % 2) as f32;
        let full = View { trust: Some(Image::filled(SIZE, 1.0)), ..frame(5) };
        assert_eq!(plain.clone().step(5, &full), expected);
        let made = plain.step(5, &View { trust: Some(Image::from_fn(SIZE, mask)), ..frame(5) });
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
            post.step(0, &View { depth: depth.clone(), ..sharp(color.clone()) });
            let motion = Some(Image::filled(SIZE, [motion_px, 0.0]));
            let made = post.step(1, &View { depth: depth.clone(), motion, ..at_lod(color.clone(), 1.0) });
            for y in 0..SIZE[1] as usize {
                assert_eq!(made.trace.at(26, y).verdict, verdict, "{method:?} by {motion_px} px in row {y}");
                let shown = made.shown.at(26, y);
                assert!((0..3).all(|k| (shown[k] - far_color[k]).abs() < 0.006 * far_color[k]), "{shown:?}");
            }
        }
    }
}
