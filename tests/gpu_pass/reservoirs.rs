//! Reservoirs on the device: what they can hold, the law by which they choose, and damage. Hard cases H05 to H08, H11, H12, H19,
//! H22, H29.

use super::common::{self, Draws};
use super::rig::{Rig, View, noise, with_w_sum};
use afterimage::foveation::Foveation;
use afterimage::frame::{ContextDesc, Reset};
use afterimage::image::Image;
use afterimage::kernel::pack;
use afterimage::settings::{Bias, Sampler, Settings};

/// Every candidate has weight 1, and nothing but chance decides.
fn even() -> Settings {
    let foveation = Foveation { fovea_deg: 180.0, mid_deg: 180.0, ..Foveation::default() };
    Settings { foveation, gate: None, bias: Bias::None, ..Settings::paper() }
}

/// A frame of one colour.
fn plain(size: [u32; 2], light: f32) -> View {
    View::still(Image::filled(size, [light; 3]), [0.0; 2])
}

#[test]
fn h05_h06_h07_h08_weight_sums_stall_where_documented_and_never_overflow() {
    let size = [16, 4];
    let biased = Settings { bias: Bias::Bernoulli, ..even() };
    let Some(mut rig) = Rig::new(ContextDesc::new(size), biased) else { return };
    let mut words = rig.both(0, Reset::None, &[plain(size, 0.5)]).0.words;
    // With 16 significant bits a sum of ones under eq. 5 stalls between 256 and 363; a half would stall at 63.
    for start in [250.0, 100.0, 1e6, pack::MAX_W_SUM] {
        rig.restore(&with_w_sum(&words, start));
        let frames = if start == 250.0 { 1_800 } else { 20 };
        let mut sums = [0.0_f32; 2];
        for index in 1..frames {
            words = rig.both(index, Reset::None, &[plain(size, 0.5)]).0.words;
            sums = [sums[1], pack::unpack(words[5]).w_sum];
        }
        println!("from {start}: {} after {frames} frames", sums[1]);
        assert!(sums[1].is_finite() && sums[1] <= pack::MAX_W_SUM);
        if start == 250.0 {
            assert!((256.0..=363.0).contains(&sums[1]) && sums[0] == sums[1], "{sums:?}");
        } else if start == 100.0 {
            assert!(sums[1] > 100.0, "below the stall it grows");
        } else {
            assert_eq!(sums[1], start, "above the stall it stays");
        }
    }
}

#[test]
fn h11_without_bias_every_frame_is_kept_as_often() {
    let size = [256, 128];
    let counts = |bias, name: &str| -> Option<Vec<u64>> {
        let mut rig = Rig::new(ContextDesc::new(size), Settings { bias, seed: common::seed(name), ..even() })?;
        let mut counts = vec![0; 8];
        for index in 0..8 {
            let shown = rig.on_gpu(index, Reset::None, &[plain(size, index as f32)]).shown;
            if index == 7 {
                shown.iter().for_each(|c| counts[f32::from_bits(c[0]) as usize] += 1);
            }
        }
        Some(counts)
    };
    let expected = [f64::from(size[0] * size[1]) / 8.0; 8];
    let (Some(even), Some(biased)) = (counts(Bias::None, "h11"), counts(Bias::Bernoulli, "h11, biased")) else {
        return;
    };
    common::accept(&format!("kept, frame by frame: {even:?}"), common::p_of_counts(&even, &expected));
    common::reject(&format!("with bias: {biased:?}"), common::p_of_counts(&biased, &expected));
}

#[test]
fn h12_a_candidate_is_taken_in_proportion_to_its_weight() {
    let size = [256, 128];
    let Some(mut rig) = Rig::new(ContextDesc::new(size), even()) else { return };
    let words = rig.both(0, Reset::None, &[plain(size, 0.5)]).0.words;
    let pixels = u64::from(size[0] * size[1]);
    for (index, sum) in (1..).zip([1.0_f32, 2.0, 3.0, 9.0, 63.0]) {
        rig.restore(&with_w_sum(&words, sum));
        let replaced = rig.both(index, Reset::None, &[plain(size, 0.25)]).0.stats.replaced;
        let p = 1.0 / f64::from(sum + 1.0);
        common::accept(&format!("1 of {}", sum + 1.0), common::p_of_rate(replaced, pixels, p));
        common::reject(&format!("1.5 of {}", sum + 1.0), common::p_of_rate(replaced, pixels, 1.5 * p));
    }
}

#[test]
fn h19_whatever_the_history_holds_it_heals_in_one_frame() {
    let size = [64, 48];
    for sampler in [Sampler::AChao, Sampler::AEs] {
        let Some(mut rig) = Rig::new(ContextDesc::new(size), Settings { sampler, ..Settings::paper() }) else {
            return;
        };
        let mut draws = Draws::new("h19 on the device");
        rig.on_cpu(0, Reset::None, &[View::still(noise(size, "h19"), [9.0; 2])]);
        rig.on_gpu(0, Reset::None, &[View::still(noise(size, "h19"), [9.0; 2])]);
        let words: Vec<[u32; 3]> = (0..64 * 48).map(|_| [0; 3].map(|_| draws.bits())).collect();
        if sampler == Sampler::AEs {
            // Keys are floats of their own, which restoring sets on the CPU alone.
            rig.restore(&words);
            let made = rig.on_gpu(1, Reset::None, &[View::still(noise(size, "h19, 1"), [9.0; 2])]);
            assert!(made.shown.as_flattened().iter().all(|&v| f32::from_bits(v).is_finite()));
            continue;
        }
        rig.restore(&words);
        for index in 1..4 {
            let view = View::still(noise(size, &format!("h19, {index}")), [9.0; 2]);
            let (made, _) = rig.both(index, Reset::None, &[view]);
            assert!(made.shown.as_flattened().iter().all(|&v| f32::from_bits(v).is_finite()));
            assert!(made.words.iter().all(|&w| pack::unpack(w).w_sum > 0.0), "every reservoir holds a sample again");
        }
    }
}

#[test]
fn h22_h29_only_what_was_shown_is_shown_and_the_same_bytes_again() {
    let size = [65, 33];
    let run = || -> Option<Vec<Vec<[u32; 3]>>> {
        let mut rig = Rig::new(ContextDesc::new(size), Settings::paper())?;
        let mut known = std::collections::HashSet::new();
        let mut all = vec![];
        for index in 0..24 {
            let color = noise(size, &format!("h22 {index}"));
            known.extend(color.pixels().iter().map(|c| c.map(f32::to_bits)));
            let motion = Some(Image::filled(size, [1.0, -2.0]));
            let view = View { motion, ..View::still(color, [30.0, 11.0]) };
            let (made, _) = rig.both(index, Reset::None, &[view]);
            assert!(made.shown.iter().all(|c| known.contains(c)), "an invented colour");
            all.push(made.shown);
        }
        Some(all)
    };
    let first = run();
    assert!(first == run());
}
