//! Non-finite input and corrupt history.

use super::*;
use afterimage_testing::holds;

proptest! {
    #![proptest_config(afterimage_testing::property("nan pixel", 64))]

    #[test]
    fn h19_h79_whatever_the_history_holds_the_output_is_finite_and_heals(words in prop::collection::vec(any::<[u32; 3]>(), 64 * 48), sampler in prop::sample::select(vec![Sampler::AChao, Sampler::AEs, Sampler::AChaoMean])) {
        let mut post = context(wrs(Wrs { sampler, ..Wrs::default() }));
        one(&mut post, 0, &still(noise(SIZE, "h")));
        post.restore_history(&words);
        let (out, ..) = one(&mut post, 1, &still(noise(SIZE, "h")));
        prop_assert!(out.pixels().iter().flatten().all(|v| v.is_finite()));
        for &w in post.history().words() {
            let s = afterimage::kernel::stored_reservoir::unpack(w);
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
    assert_eq!(post.make(0, &input, Exposure::Same, Reset::All).shown, input.color);
    holds!(
        "H79",
        Cpu,
        "wrs: 3072 reservoirs of NaN words show the candidate, bit for bit, as history and after a reset"
    );
}
