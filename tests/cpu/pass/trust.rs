//! The trust mask: confidence in history.

use super::*;
use crate::reactive::reactive_is_the_inverse_of_trust;
use crate::settings::{ungated, wrs};
use afterimage::kernel::stored_reservoir;

/// A mask of columns.
fn columns(values: &[f32]) -> Image<f32> {
    Image::from_fn(SIZE, |[x, _]| values[x as usize * values.len() / 64])
}

#[test]
fn trust_of_1_changes_nothing_and_of_0_is_a_reset_of_that_pixel() {
    for sampler in [Sampler::AChao, Sampler::AEs] {
        let settings = wrs(Wrs { sampler, gate: None, ..Wrs::default() });
        let (mut plain, mut trusting, mut fresh) = (context(settings), context(settings), context(settings));
        let full = Some(Image::filled(SIZE, 1.0));
        for index in 0..8 {
            let input = still(noise(SIZE, &format!("trust {index}")));
            let expected = one(&mut plain, index, &input);
            assert_eq!(one(&mut trusting, index, &View { trust: full.clone(), ..input }), expected);
            assert_eq!(trusting.history().words(), plain.history().words());
        }
        let mask = columns(&[0.0, 1.0]);
        let input = View { trust: Some(mask.clone()), ..still(noise(SIZE, "trust")) };
        let expected = one(&mut plain, 8, &View { trust: None, ..input.clone() });
        let afresh = one(&mut fresh, 8, &View { trust: None, ..input.clone() });
        let (out, stats, trace) = one(&mut trusting, 8, &input);
        for (i, &t) in mask.pixels().iter().enumerate() {
            let like = if t == 0.0 { &afresh } else { &expected };
            assert_eq!(out.pixels()[i], like.0.pixels()[i]);
            assert_eq!(trace.pixels()[i].quality, like.2.pixels()[i].quality);
        }
        let half = 64 * 48 / 2;
        assert_eq!((stats.verdicts[Verdict::Distrusted as usize], stats.rejected(), stats.valid()), (half, half, half));
    }
}

#[test]
fn half_the_trust_is_half_the_weight_before_gate_and_bias() {
    let mut post = context(wrs(Wrs { gate: None, bias: Bias::None, ..Wrs::default() }));
    one(&mut post, 0, &still(noise(SIZE, "a")));
    let before: Vec<f32> = post.history().words().iter().map(|&w| stored_reservoir::unpack(w).w_sum).collect();
    let input = View { trust: Some(Image::filled(SIZE, 0.5)), ..still(noise(SIZE, "b")) };
    let (_, _, trace) = one(&mut post, 1, &input);
    for (t, w) in trace.pixels().iter().zip(before) {
        assert_eq!(16.0 * t.quality, 0.5 * w + t.weight);
    }
}

#[test]
fn h18_trust_that_is_no_number_counts_as_none_and_is_counted() {
    let mut post = context(ungated());
    one(&mut post, 0, &still(noise(SIZE, "a")));
    post.stick();
    // Eight columns each: only the last three keep anything, and with so much weight they keep all of it.
    let mask = columns(&[f32::NAN, -1.0, 0.0, -0.0, 1e-40, f32::INFINITY, 2.0, 1e-3]);
    let input = View { trust: Some(mask), ..still(noise(SIZE, "b")) };
    let (_, stats, trace) = one(&mut post, 1, &input);
    let distrusted = |x: usize| (0..48).all(|y| trace.at(x, y).verdict == Verdict::Distrusted);
    let kept = |x: usize| (0..48).all(|y| trace.at(x, y).verdict == Verdict::Valid && !trace.at(x, y).is_replaced);
    assert!((0..40).all(distrusted) && (40..64).all(kept));
    assert_eq!((stats.bad_trust, stats.rejected()), (2 * 8 * 48, 40 * 48));
    assert!(stats.warnings().any(|w| w == Warning::BadTrust { pixels: 2 * 8 * 48 }));
}

#[test]
fn reactive_masks_are_the_inverse_of_trust() {
    println!("{}", reactive_is_the_inverse_of_trust(&crate::mask_hard::on_cpu).unwrap());
}
