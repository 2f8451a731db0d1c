//! Non-finite input and corrupt history.

use super::*;
use afterimage_testing::holds;

proptest! {
    #![proptest_config(afterimage_testing::property("nan pixel", 64))]

    #[test]
    fn nan_in_one_pixel_stays_there_for_one_frame(x in 0usize..64, y in 0usize..48, channel in 0usize..3, bad in prop::sample::select(vec![f32::NAN, f32::INFINITY, f32::NEG_INFINITY])) {
        let mut clean = context(Settings::paper());
        let mut hurt = clean.clone();
        for index in 0..4 {
            let color = noise(SIZE, &format!("nan {index}"));
            let mut broken = color.clone();
            if index == 0 || index == 2 {
                broken.pixels_mut()[y * 64 + x][channel] = bad;
            }
            let (a, ..) = one(&mut clean, index, &still(color));
            let (b, stats, _) = one(&mut hurt, index, &still(broken));
            prop_assert_eq!(stats.nonfinite, u64::from(index == 0 || index == 2));
            prop_assert!(b.pixels().iter().flatten().all(|v| v.is_finite()));
            for (i, (p, q)) in a.pixels().iter().zip(b.pixels()).enumerate() {
                prop_assert!(p == q || i == y * 64 + x, "a neighbour changed");
            }
            if index == 0 {
                prop_assert_eq!(b.at(x, y), [0.0; 3]);
            }
        }
        // With history, history is shown instead.
        prop_assert!(hurt.history().is_filled());
    }

    #[test]
    fn h19_h79_whatever_the_history_holds_the_output_is_finite_and_heals(words in prop::collection::vec(any::<[u32; 3]>(), 64 * 48), sampler in prop::sample::select(vec![Sampler::AChao, Sampler::AEs, Sampler::AChaoMean])) {
        let mut post = context(wrs(Wrs { sampler, ..Wrs::default() }));
        one(&mut post, 0, &still(noise(SIZE, "h")));
        post.restore_history(&words);
        let (out, ..) = one(&mut post, 1, &still(noise(SIZE, "h")));
        prop_assert!(out.pixels().iter().flatten().all(|v| v.is_finite()));
        for &w in post.history().words() {
            let s = afterimage::kernel::pack::unpack(w);
            prop_assert!(s.w_sum > 0.0 && s.color.is_finite(), "every reservoir holds a sample again");
        }
    }
}

#[test]
fn h79_poisoned_fresh_history_is_never_read() {
    let mut post = context(Settings::paper());
    post.restore_history(&vec![[u32::MAX; 3]; 64 * 48]);
    let input = still(noise(SIZE, "poison"));
    assert_eq!(one(&mut post.clone(), 0, &input).0, input.color, "all NaN words are empty");
    let (out, _, _) = step(&mut post, 0, Reset::All, &[&input]);
    assert_eq!(out[0], input.color);
    holds!(
        "H79",
        Cpu,
        "wrs: 3072 reservoirs of NaN words show the candidate, bit for bit, as history and after a reset"
    );
}

#[test]
fn h18_a_nonfinite_candidate_shows_history() {
    let mut post = context(Settings::paper());
    let good = noise(SIZE, "good");
    one(&mut post, 0, &still(good.clone()));
    for index in 1..200 {
        let broken = still(Image::filled(SIZE, [f32::NAN; 3]));
        let (out, stats, trace) = one(&mut post, index, &broken);
        assert_eq!(out, good, "frame {index}");
        assert_eq!((stats.nonfinite, stats.replaced), (64 * 48, 0));
        assert!(trace.pixels().iter().all(|t| t.weight == 0.0 && u64::from(t.age) == index && t.history_share == 1.0));
    }
}
