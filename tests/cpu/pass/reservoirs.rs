//! Reservoirs through the whole pass: corruption, non-finite candidates, and no color that was not an input.

use super::*;
use crate::settings::wrs;
use afterimage::kernel::{pack, stored_reservoir};
use afterimage_testing::holds;

/// Words with an impossible weight sum or color.
fn corrupt(words: [u32; 3], kind: usize) -> [u32; 3] {
    let [rg, bd, age] = [words[0], words[1], words[2] & 0xff];
    match kind {
        0 => [rg, bd, f32::NAN.to_bits() | age],
        1 => [rg, bd, f32::INFINITY.to_bits() | age],
        2 => [rg, bd, f32::NEG_INFINITY.to_bits() | age],
        3 => [rg, bd, (-1.0_f32).to_bits() | age],
        4 => [rg, bd, f32::MAX.to_bits() & 0xffff_ff00 | age],
        _ => [rg | 0x7c00, bd, words[2]],
    }
}

#[test]
fn h19_a_corrupt_sum_resets_its_pixel_alone_for_one_frame() {
    let mut pixels = 0;
    for sampler in [Sampler::AChao, Sampler::AEs] {
        let frame = |i: u64| still(noise(SIZE, &format!("h19 {i}")));
        let mut sound = context(wrs(Wrs { sampler, gate: None, ..Wrs::default() }));
        for i in 0..6 {
            one(&mut sound, i, &frame(i));
        }
        let words = sound.history().words().to_vec();
        let with = |damage: &dyn Fn(usize) -> [u32; 3]| {
            let mut post = sound.clone();
            let hit = |i: usize| i % 7 == 3;
            post.restore_history(
                &(0..words.len()).map(|i| if hit(i) { damage(i) } else { words[i] }).collect::<Vec<_>>(),
            );
            post
        };
        let (mut hurt, mut reset) = (with(&|i| corrupt(words[i], i % 6)), with(&|_| [0; 3]));
        sound.restore_history(&words);
        let (undisturbed, ..) = one(&mut sound, 6, &frame(6));
        let (out, _, trace) = one(&mut hurt, 6, &frame(6));
        assert_eq!(out, one(&mut reset, 6, &frame(6)).0, "as if reset");
        assert_eq!(hurt.history().words(), reset.history().words());
        for i in 0..words.len() {
            let at = (i % 64, i / 64);
            if i % 7 == 3 {
                assert_eq!(out.at(at.0, at.1), frame(6).color.at(at.0, at.1), "the candidate");
                let (t, now) = (trace.at(at.0, at.1), stored_reservoir::unpack(hurt.history().words()[i]));
                assert!((now.w_sum / t.weight - 1.0).abs() < 2.0_f32.powi(-16) && t.verdict == Verdict::Empty);
                pixels += 1;
            } else {
                assert_eq!(out.at(at.0, at.1), undisturbed.at(at.0, at.1), "its neighbours are as they were");
            }
        }
    }
    holds!("H19", Cpu, "{pixels} corrupt pixels of 6 kinds as if reset after one frame, neighbours bit-equal");
}

#[test]
fn h17_h18_broken_candidates_leave_the_reservoir_as_it_was_and_are_counted() {
    let mut post = context(Settings::paper());
    for index in 0..5 {
        one(&mut post, index, &still(noise(SIZE, "sound")));
    }
    let before: Vec<_> = post.history().words().iter().map(|&w| stored_reservoir::unpack(w)).collect();
    for (index, bad) in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY].into_iter().enumerate() {
        let broken = still(Image::filled(SIZE, [0.5, bad, 0.5]));
        let (_, stats, trace) = one(&mut post, 5 + index as u64, &broken);
        assert!(trace.pixels().iter().all(|t| t.weight == 0.0 && !t.is_replaced));
        assert!(stats.warnings().any(|w| w == Warning::NonfiniteColor { pixels: 64 * 48 }));
        for (was, &word) in before.iter().zip(post.history().words()) {
            let is = stored_reservoir::unpack(word);
            assert_eq!((is.color, is.w_sum, is.age), (was.color, was.w_sum, was.age + index as u32 + 1));
        }
    }
    holds!("H17", Cpu, "weight 0 for unusable candidates, 3072 counted and warned of");
    holds!("H18", Cpu, "color and w_sum of 3072 reservoirs bit-equal after NaN, Inf and -Inf");
}

#[test]
fn h22_every_shown_color_was_presented() {
    let mut shown = 0;
    for (sampler, bias) in [(Sampler::AChao, Bias::Bernoulli), (Sampler::AEs, Bias::Exponential { lambda: 0.05 })] {
        let mut post = context(wrs(Wrs { sampler, bias, ..Wrs::default() }));
        let mut known = std::collections::HashSet::new();
        for index in 0..30 {
            let motion = Some(Image::filled(SIZE, [2.0, -1.0]));
            let input = View { motion, ..still(noise(SIZE, &format!("h22 {index}"))) };
            known.extend(input.color.pixels().iter().map(|c| c.map(f32::to_bits)));
            let (out, stats, _) = one(&mut post, index, &input);
            assert!(out.pixels().iter().all(|c| known.contains(&c.map(f32::to_bits))), "an invented color");
            shown += out.pixels().len();
            assert!(index == 0 || stats.replaced < stats.valid(), "some history is shown");
        }
        // Planted error: a mean of two input colors is not an input color.
        let mean = std::array::from_fn::<_, 3, _>(|k| f32::midpoint(noise(SIZE, "h22 0").at(0, 0)[k], 0.123));
        assert!(!known.contains(&mean.map(f32::to_bits)));
        // A color that halves do not represent exactly is stored as the nearest half.
        let (third, stored) = (1.0_f32 / 3.0, pack::half_value(pack::half_bits(1.0 / 3.0)));
        let mut post = context(wrs(Wrs { sampler, bias, ..Wrs::default() }));
        assert_eq!(one(&mut post, 0, &still(Image::filled(SIZE, [third; 3]))).0.at(9, 9), [third; 3]);
        let (out, ..) = one(&mut post, 1, &still(Image::filled(SIZE, [f32::NAN; 3])));
        assert_eq!(out.at(9, 9), [stored; 3]);
    }
    holds!("H22", Cpu, "{shown} shown colors, each a presented one bit for bit (of colors that halves hold)");
}
