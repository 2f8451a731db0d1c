//! Light that changes for smr and taa: hard cases H72 to H75.

use super::rig::*;
use afterimage::Smr;
use afterimage_testing::holds;

#[test]
fn h72_an_exposure_of_256_in_one_frame_loses_nothing_if_it_is_declared() {
    let mut worst_undeclared = 0.0_f32;
    for ratio in [256.0, 1.0 / 256.0] {
        let mut post = context(MethodKind::Smr);
        let made = step(&mut post, 0, &Input::sharp(noise(SIZE, "h72").map(|c| c.map(|v| 0.25 + 0.5 * v))));
        let coarse = LowPass::new(&made.stored(), 4).render(&Image::filled(SIZE, 2.0));
        let exposed =
            Input { exposure: Exposure::Changed { ratio }, ..Input::at_lod(coarse.map(|c| c.map(|v| v * ratio)), 2.0) };
        let declared = step(&mut post.clone(), 1, &exposed);
        assert_eq!(declared.shown, made.stored().map(|c| c.map(|v| v * ratio)), "x{ratio}");
        assert_eq!(declared.stats.rejected(), 0);
        // Undeclared, it is another picture: the new one is shown at once.
        let undeclared = Input { exposure: Exposure::Same, ..exposed };
        for index in 1..20 {
            let shown = step(&mut post, index, &undeclared).shown;
            let pairs = shown.pixels().iter().flatten().zip(undeclared.color.pixels().iter().flatten());
            worst_undeclared = pairs.fold(worst_undeclared, |w, (a, b)| w.max((a / b - 1.0).abs()));
        }
    }
    println!("undeclared: off by {worst_undeclared}");
    assert!(worst_undeclared < 0.05, "{worst_undeclared}");
    holds!(
        "H72",
        Cpu,
        "smr, x256 and /256 declared: detail kept bit for bit; undeclared: within {worst_undeclared:.3} at once"
    );
}

#[test]
fn h73_a_firefly_is_gone_with_the_frame_after() {
    let mut worst = vec![];
    for method in METHODS {
        let mut post = context(method);
        let dark = Image::filled(SIZE, [0.01; 3]);
        let mut firefly = dark.clone();
        firefly.pixels_mut()[20 * 52 + 26] = [65504.0; 3];
        step(&mut post, 0, &Input::at_lod(firefly, 2.0));
        let made = step(&mut post, 1, &Input::at_lod(dark.clone(), 2.0));
        let brightest = made.shown.pixels().iter().flatten().fold(0.0_f32, |m, &v| m.max(v));
        println!("{method:?}: at the most {brightest} a frame after 65504");
        assert!(brightest < 0.011);
        // Remaining light of the firefly, over all pixels and the following frames.
        let mut extra = 0.0_f64;
        for index in 2..30 {
            let made = step(&mut post, index, &Input::at_lod(dark.clone(), 2.0));
            extra += made.shown.pixels().iter().flatten().map(|&v| f64::from(v - 0.01).abs()).sum::<f64>();
        }
        worst.push((brightest, extra / (3.0 * 65504.0)));
    }
    assert!(worst.iter().all(|w| w.1 < 1e-3), "{worst:?}");
    let (brightest, left) = worst[0];
    holds!(
        "H73",
        Cpu,
        "smr: at the most {brightest:.4} for 0.01 a frame after 65504; of its light {left:.1e} is left in 28 frames"
    );
}

#[test]
fn h74_a_strobe_leaves_nothing_behind() {
    let dark = 0.031_25;
    let mut worst = vec![];
    for method in METHODS {
        for on in [1.0, 0.0625] {
            let mut post = context(method);
            let mut off = vec![];
            for index in 0..160_u64 {
                let light = if index < 60 && index % 2 == 1 { on } else { dark };
                let made = step(&mut post, index, &Input::at_lod(Image::filled(SIZE, [light; 3]), 2.0));
                if index >= 60 {
                    let furthest = |m: f32, v: &f32| m.max((v / dark - 1.0).abs());
                    off.push(made.shown.pixels().iter().flatten().fold(0.0, furthest));
                }
            }
            // Accumulation stalls where a tenth of the difference is less than half a step of storage.
            let stall = 1.5 / 1024.0 / (1.0 - Smr::default().accumulate);
            let frames = off.iter().rposition(|&v| v > stall).map_or(0, |last| last + 1);
            let last = off[99];
            println!(
                "{method:?}, {dark} to {on}: within {stall:.4} after {frames} frames, off by {last:.1e} after 100"
            );
            assert!(frames <= 40, "{method:?}: {frames}");
            worst.push((frames, last));
        }
    }
    let [full, stop] = [worst[0], worst[1]];
    holds!(
        "H74",
        Cpu,
        "smr: nothing left after {} frames; by 1 stop within 0.0146 after {}, {:.4} for ever",
        full.0,
        stop.0,
        stop.1
    );
}

#[test]
fn h75_black_and_white_in_turn_show_what_came() {
    let mut post = context(MethodKind::Smr);
    let mut mean = 0.0;
    for index in 0..20 {
        let color = Image::filled(SIZE, [(index % 2) as f32; 3]);
        assert_eq!(step(&mut post, index, &Input::at_lod(color.clone(), 2.0)).shown, color, "frame {index}");
        mean += f64::from(color.pixels()[0][0]) / 20.0;
    }
    holds!("H75", Cpu, "smr: 20 frames shown as they came, bit for bit; mean over time {mean:.3}");
}
