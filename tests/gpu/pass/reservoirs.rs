//! Reservoirs on the device: range, probabilities and corruption. Hard cases H05 to H07, H11, H12,
//! H19, H22, H26, H29.

use super::rig::with_w_sum;
use super::*;

/// Settings in which every candidate has weight 1, without a gate.
fn even(bias: Bias) -> Settings {
    let foveation = Foveation { fovea_deg: 180.0, mid_deg: 180.0, ..Foveation::default() };
    Settings { foveation, ..wrs(Wrs { gate: None, bias, ..Wrs::default() }) }
}

/// A frame of one color.
fn plain(size: [u32; 2], light: f32) -> View {
    View::still(Image::filled(size, [light; 3]), [0.0; 2])
}

/// Weight sum that the pass stores, on both executors, after `frames` more candidates of weight 1 on a history of sum
/// `start`, and the one of the frame before.
fn sum_after(rig: &mut Rig, words: &[[u32; 3]], start: f32, frames: u64) -> [f32; 2] {
    let size = rig.context.size_px;
    rig.restore(&with_w_sum(words, start));
    let mut sums = [0.0, start];
    for index in 1..=frames {
        let words = rig.both(index, Reset::None, &[plain(size, 0.5)]).0.words;
        sums = [sums[1], stored_reservoir::unpack(words[5]).w_sum];
        assert!(sums[1].is_finite() && sums[1] <= stored_reservoir::MAX_W_SUM);
    }
    println!("from {start}: {} after {frames} frames", sums[1]);
    sums
}

#[test]
fn h05_h06_a_plain_sum_goes_on_where_a_half_stalls_and_never_overflows() {
    let size = [16, 4];
    let Some(mut rig) = Rig::new(ContextDesc::new(size), even(Bias::None)) else { return };
    let words = rig.both(0, Reset::None, &[plain(size, 0.5)]).0.words;
    assert_eq!(sum_after(&mut rig, &words, 2040.0, 20), [2059.0, 2060.0], "a half stalls at 2048");
    let [_, here] = sum_after(&mut rig, &words, 65_504.0, 40);
    assert_eq!(here, 65_536.0);
    let [_, top] = sum_after(&mut rig, &words, stored_reservoir::MAX_W_SUM, 5);
    assert_eq!(top, stored_reservoir::MAX_W_SUM);
    holds!("H05", Gpu, "from 65504 on to {here}, where replacement is 1/65537; 2^100 stays");
    holds!("H06", Gpu, "past 2048 in ones, stalls at {here}");
}

#[test]
fn h07_biased_sums_stall_where_documented() {
    let size = [16, 4];
    let Some(mut rig) = Rig::new(ContextDesc::new(size), even(Bias::Bernoulli)) else { return };
    let words = rig.both(0, Reset::None, &[plain(size, 0.5)]).0.words;
    // With 16 significant bits a sum of ones under eq. 5 stalls between 256 and 363; a half would stall at 63.
    let [before, stalled] = sum_after(&mut rig, &words, 255.0, 400);
    assert!((256.0..=363.0).contains(&stalled) && before == stalled, "{before} {stalled}");
    assert!(sum_after(&mut rig, &words, 100.0, 20)[1] > 100.0, "below the stall it grows");
    for start in [1e6, stored_reservoir::MAX_W_SUM] {
        assert_eq!(sum_after(&mut rig, &words, start, 20)[1], start, "above the stall it stays");
    }
    holds!("H07", Gpu, "stalls at {stalled}: replacement 1/{:.0} a frame, stated floor 1/364", stalled);
}

/// How many pixels show each of eight frames, which have a color each, after the last one.
fn shown_of_eight(rig: &mut Rig, first: u64) -> Vec<u64> {
    let size = rig.context.size_px;
    let mut counts = vec![0; 8];
    let shown = (0..8).map(|k| rig.both(first + k, Reset::None, &[plain(size, k as f32)]).0.shown).last().unwrap();
    shown.iter().for_each(|c| counts[f32::from_bits(c[0]) as usize] += 1);
    counts
}

#[test]
fn h11_without_bias_every_frame_is_kept_as_often() {
    let size = [256, 128];
    let counts = |bias, name: &str| -> Option<Vec<u64>> {
        let seed = afterimage_testing::seed(name);
        Some(shown_of_eight(&mut Rig::new(ContextDesc::new(size), Settings { seed, ..even(bias) })?, 0))
    };
    let expected = [f64::from(size[0] * size[1]) / 8.0; 8];
    let (Some(even), Some(biased)) = (counts(Bias::None, "h11"), counts(Bias::Bernoulli, "h11, biased")) else {
        return;
    };
    let p = afterimage_testing::p_of_counts(&even, &expected);
    afterimage_testing::accept(&format!("kept, frame by frame: {even:?}"), p);
    afterimage_testing::reject(&format!("with bias: {biased:?}"), afterimage_testing::p_of_counts(&biased, &expected));
    holds!("H11", Gpu, "p = {p:.2} for 8 frames through the pass, {} pixels", size[0] * size[1]);
}

#[test]
fn h12_a_candidate_is_taken_in_proportion_to_its_weight() {
    let size = [256, 128];
    let Some(mut rig) = Rig::new(ContextDesc::new(size), even(Bias::None)) else { return };
    let words = rig.both(0, Reset::None, &[plain(size, 0.5)]).0.words;
    let pixels = u64::from(size[0] * size[1]);
    let mut least = 1.0_f64;
    for (index, sum) in (1..).zip([1.0_f32, 2.0, 3.0, 9.0, 63.0]) {
        rig.restore(&with_w_sum(&words, sum));
        let replaced = rig.both(index, Reset::None, &[plain(size, 0.25)]).0.stats.replaced;
        let p = 1.0 / f64::from(sum + 1.0);
        least = least.min(afterimage_testing::p_of_rate(replaced, pixels, p));
        afterimage_testing::accept(&format!("1 of {}", sum + 1.0), afterimage_testing::p_of_rate(replaced, pixels, p));
        afterimage_testing::reject(
            &format!("1.5 of {}", sum + 1.0),
            afterimage_testing::p_of_rate(replaced, pixels, 1.5 * p),
        );
    }
    holds!("H12", Gpu, "p >= {least:.2} for 1 of 2, 3, 4, 10, 64 through the pass, {pixels} pixels each");
}

#[test]
fn h19_a_corrupt_sum_resets_its_pixel_alone_for_one_frame() {
    let size = [64, 16];
    let settings = ungated();
    let Some(mut rig) = Rig::new(ContextDesc::new(size), settings) else { return };
    let view = |i: u64| [View::still(noise(size, &format!("h19 {i}")), [9.0; 2])];
    let mut words = vec![];
    for index in 0..6 {
        words = rig.both(index, Reset::None, &view(index)).0.words;
    }
    let bad = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -1.0, f32::MAX].map(|x| x.to_bits() & 0xffff_ff00);
    let mut after = |damage: &dyn Fn(usize) -> Option<u32>| {
        let with = |(i, w): (usize, &[u32; 3])| [w[0], w[1], damage(i).unwrap_or(w[2])];
        rig.restore(&words.iter().enumerate().map(with).collect::<Vec<_>>());
        rig.both(6, Reset::None, &view(6)).0
    };
    let hit = |i: usize| i % 7 == 3;
    let hurt = after(&|i| hit(i).then_some(bad[i % 5]));
    let reset = after(&|i| hit(i).then_some(0));
    let sound = after(&|_| None);
    assert!((&hurt.shown, &hurt.words) == (&reset.shown, &reset.words), "as if reset");
    let others = (0..words.len()).filter(|&i| !hit(i));
    assert!(others.into_iter().all(|i| (hurt.shown[i], hurt.words[i]) == (sound.shown[i], sound.words[i])));
    let pixels = (0..words.len()).filter(|&i| hit(i)).count();
    holds!("H19", Gpu, "{pixels} corrupt sums as if reset after one frame, neighbours bit-equal");
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
            assert!(made.shown.iter().all(|c| known.contains(c)), "an invented color");
            all.push(made.shown);
        }
        Some(all)
    };
    let first = run();
    assert!(first == run());
    if let Some(frames) = first {
        let shown = frames.iter().map(Vec::len).sum::<usize>();
        holds!("H22", Gpu, "{shown} shown colors, each a presented one bit for bit (of colors that halves hold)");
    }
}

#[test]
fn h29_the_same_bytes_in_workgroups_of_any_size() {
    // No wider than the narrowest workgroup, so that as many as are dispatched reach every pixel.
    let (size, given) = ([32, 33], "@workgroup_size(64, 1)");
    let source = SHADERS.compose("wrs_pass").source;
    assert_eq!(source.matches(given).count(), 1);
    let groups = ["64, 1", "32, 1", "128, 1", "32, 2", "256, 1", "64, 4"];
    for group in groups {
        let text = source.replace(given, &format!("@workgroup_size({group})"));
        for _ in 0..2 {
            let Some(mut rig) = Rig::with_shader(ContextDesc::new(size), Settings::paper(), &text) else { return };
            for index in 0..8 {
                let view = View {
                    motion: Some(Image::filled(size, [1.0, -2.0])),
                    ..View::still(noise(size, "h29"), [9.0; 2])
                };
                rig.both(index, Reset::None, &[view]);
            }
        }
    }
    holds!("H29", Gpu, "8 frames twice in {} sizes of workgroup, all bit-equal to the CPU's", groups.len());
}

#[test]
fn h26_the_frame_counter_goes_on_beyond_32_bits() {
    let size = [256, 64];
    let Some(mut rig) = Rig::new(ContextDesc::new(size), even(Bias::None)) else { return };
    // The samples of eight frames around the wrap follow the same law.
    let counts = shown_of_eight(&mut rig, u64::from(u32::MAX) - 3);
    let p = afterimage_testing::p_of_counts(&counts, &[f64::from(size[0] * size[1]) / 8.0; 8]);
    afterimage_testing::accept(&format!("kept around the wrap: {counts:?}"), p);
    // The planted error: draws that start again give the same choices 2^32 frames later.
    let mut replaced = |index: u64| {
        rig.both(index, Reset::All, &[plain(size, 0.0)]);
        rig.both(index + 1, Reset::None, &[plain(size, 1.0)]).0.shown
    };
    assert_ne!(replaced(5), replaced(5 + (1 << 32)), "the choices of frame 6 come again");
    holds!("H26", Gpu, "p = {p:.2} for what is kept of 8 frames around frame 2^32, no reset");
}
