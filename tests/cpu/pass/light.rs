//! Light that changes: exposure, fireflies, strobes, flicker; hard cases H72 to H75.

use super::*;
use afterimage_testing::holds;

const EXPOSED: f32 = 256.0;

fn scaled(color: &Color, ratio: f32) -> Color {
    color.map(|c| c.map(|v| v * ratio))
}

fn exposed(post: &mut CpuAfterimage, index: u64, ratio: f32, color: &Color) -> (Color, FrameStats, Image<PixelTrace>) {
    let input = Input::still(color.clone());
    let mut out = [Image::filled(SIZE, [f32::NAN; 3])];
    let mut trace = [Image::filled(SIZE, PixelTrace::default())];
    let views = [input.view()];
    let images = Images::of(&views);
    let frame = Frame { exposure: Exposure::Changed { ratio }, ..images.frame(index) };
    let stats = post.process_traced(&frame, &mut out, &mut trace).unwrap();
    let ([out], [trace]) = (out, trace);
    (out, stats, trace)
}

/// Share of pixels.
fn share(image: &Image<PixelTrace>, f: impl Fn(usize, &PixelTrace) -> bool) -> f64 {
    let hits = image.pixels().iter().enumerate().filter(|(i, t)| f(*i, t)).count();
    hits as f64 / image.pixels().len() as f64
}

fn gated(gate: bool) -> CpuAfterimage {
    context(if gate { Settings::paper() } else { ungated() })
}

/// Noise, new every frame, as bright as `ratio`.
fn frame(index: u64, ratio: f32) -> Color {
    scaled(&noise(SIZE, &format!("light {index}")), ratio)
}

#[test]
fn h72_with_the_ratio_history_follows_the_exposure_at_once() {
    for ratio in [EXPOSED, 1.0 / EXPOSED] {
        // The same clip at one exposure, and with a change from frame 20 on. Without a gate all decisions are the same.
        let (mut plain, mut post) = (gated(false), gated(false));
        for index in 0..40 {
            let before = one(&mut plain, index, &Input::still(frame(index, 1.0)));
            let after = match index {
                0..20 => one(&mut post, index, &Input::still(frame(index, 1.0))),
                20 => exposed(&mut post, index, ratio, &frame(index, ratio)),
                _ => exposed(&mut post, index, 1.0, &frame(index, ratio)),
            };
            let expected = if index < 20 { before.0 } else { scaled(&before.0, ratio) };
            assert_eq!((after.0, after.1, after.2), (expected, before.1, before.2), "x{ratio}, frame {index}");
        }
        // With the gate: a still picture is unaffected by it.
        let mut post = gated(true);
        for index in 0..10 {
            one(&mut post, index, &Input::still(frame(0, 1.0)));
        }
        let bright = frame(0, ratio);
        let (out, stats, trace) = exposed(&mut post, 10, ratio, &bright);
        assert_eq!((out, stats.rejected()), (bright, 0));
        assert!(trace.pixels().iter().all(|t| t.gate == 1.0));
        assert!(share(&trace, |_, t| !t.take) > 0.7, "and is kept");
    }
    // The planted error: the inverse of the ratio.
    let mut post = gated(true);
    one(&mut post, 0, &Input::still(frame(0, 1.0)));
    let (_, _, trace) = exposed(&mut post, 1, 1.0 / EXPOSED, &frame(0, EXPOSED));
    assert!(share(&trace, |_, t| t.gate == 0.0) > 0.9);
    holds!(
        "H72",
        Cpu,
        "wrs, x256 and /256 declared: 20 frames the same as unexposed ones times the ratio, bit for bit; 0 rejected"
    );
}

#[test]
fn h72_an_exposed_color_stays_within_halves() {
    for ratio in [f32::MAX, f32::MIN_POSITIVE, 1e-45] {
        let mut post = gated(false);
        one(&mut post, 0, &Input::still(frame(0, 1.0)));
        sticky(&mut post);
        let (out, ..) = exposed(&mut post, 1, ratio, &frame(1, 1.0));
        let limit = if ratio > 1.0 { 65504.0 } else { 1e-12 };
        assert!(out.pixels().iter().flatten().all(|&v| v == 0.0 || if ratio > 1.0 { v == limit } else { v < limit }));
    }
}

#[test]
fn h72_without_the_ratio_the_gate_recovers_within_3_frames() {
    // Brighter: all history is too dark, and rejected at once. Darker: history that happens to look alike stays a
    // little longer. Without the gate, history is replaced only by chance.
    let mut took = vec![];
    for (ratio, gate, frames, all) in [(EXPOSED, true, 0, 0), (1.0 / EXPOSED, true, 3, 20), (EXPOSED, false, 60, 100)] {
        let mut post = gated(gate);
        for index in 0..30 {
            one(&mut post, index, &Input::still(frame(index, 1.0)));
        }
        let mut stale = vec![];
        for index in 30..180 {
            let (_, stats, trace) = one(&mut post, index, &Input::still(frame(index, ratio)));
            assert_eq!(stats.rejected(), 0);
            stale.push(share(&trace, |_, t| u64::from(t.age) > index - 30));
        }
        let until = |limit: f64| stale.iter().rposition(|&s| s > limit).map_or(0, |last| last + 1);
        println!(
            "x{ratio}, gate {gate}: stale pixels below 1 % after {} frames, none after {}",
            until(0.01),
            until(0.0)
        );
        assert!(until(0.01) <= frames && until(0.0) <= all, "stated are {frames} and {all}");
        took.push(until(0.01));
    }
    holds!(
        "H72",
        Cpu,
        "wrs, undeclared: 1 % stale after {} frames (x256), {} (/256); without a gate {}",
        took[0],
        took[1],
        took[2]
    );
}

/// Pixels that are not `dark`, frame after frame, if all of them flash once at frame 30.
fn flash(gate: bool, light: f32, frames: u64) -> Vec<u64> {
    let mut post = gated(gate);
    let dark = 0.031_25;
    let lit = |index| {
        let color = Image::filled(SIZE, [if index == 30 { light } else { dark }; 3]);
        let (out, ..) = one(&mut post, index, &Input::still(color));
        out.pixels().iter().filter(|&&c| c != [dark; 3]).count() as u64
    };
    (0..30 + frames).map(lit).skip(30).collect()
}

#[test]
fn h73_a_firefly_lives_one_frame() {
    // The gate rejects history that differs so much, and then the firefly: the output is the input.
    let lit = flash(true, 65504.0, 100);
    assert_eq!((lit[0], lit[1..].iter().sum()), (64 * 48, 0_u64));
    holds!("H73", Cpu, "wrs, gated: 65504 in 1/32 is shown for 1 frame of 101, in all 3072 pixels");
}

#[test]
fn h73_without_the_gate_a_firefly_is_drawn_and_dies_as_the_law_says() {
    // Constant weights w: in units of w the sum follows a = a^2 / (a + 1) + 1 (eq. 5), whatever w; a frame is taken
    // with 1 / a.
    let lit = flash(false, 65504.0, 100);
    let (mut sum, mut alive) = (0.0_f64, 0.0_f64);
    let mut energy = 0.0;
    for frame in 0..130 {
        sum = if frame == 0 { 1.0 } else { sum * sum / (sum + 1.0) + 1.0 };
        if frame < 30 {
            continue;
        }
        alive = if frame == 30 { 1.0 / sum } else { alive * (1.0 - 1.0 / sum) };
        energy += alive;
        let n = lit[frame - 30];
        if [30, 33, 40, 50].contains(&frame) {
            afterimage_testing::accept(
                &format!("frame {frame}, {n} lit"),
                afterimage_testing::p_of_rate(n, 64 * 48, alive),
            );
        }
    }
    let shown = lit.iter().sum::<u64>() as f64 / (64.0 * 48.0);
    println!(
        "light shown over light put in: {shown:.3}, by the law {energy:.3}; the last one dies after {} frames",
        lit.iter().rposition(|&n| n > 0).unwrap() + 1
    );
    assert!(energy > 1.0 && energy < 1.15, "what a stream of constant light keeps is within 15 % of what it brings");
    assert!(lit[70..].iter().all(|&n| n == 0), "gone within 70 frames");
    let last = lit.iter().rposition(|&n| n > 0).unwrap() + 1;
    holds!(
        "H73",
        Cpu,
        "wrs, no gate: light shown over light brought {shown:.3} (by the law {energy:.3}), gone after {last} frames"
    );
}

#[test]
fn h74_a_strobe_leaves_nothing_behind() {
    // One frame on, one off, for 60 frames, by a lot and by a stop; then dark again, and exactly so after the frames
    // stated.
    let mut left = vec![];
    for (gate, on, frames) in [(true, 1.0, 6), (true, 0.0625, 40), (false, 1.0, 100)] {
        let mut post = gated(gate);
        let dark = 0.031_25;
        let mut last_lit = None;
        for index in 0..260_u64 {
            let light = if index < 60 && index % 2 == 1 { on } else { dark };
            let (out, ..) = one(&mut post, index, &Input::still(Image::filled(SIZE, [light; 3])));
            assert!(out.pixels().iter().all(|&c| c == [dark; 3] || c == [on; 3]));
            if index >= 60 && out.pixels().iter().any(|&c| c != [dark; 3]) {
                last_lit = Some(index - 60);
            }
        }
        let frames_lit = last_lit.map_or(0, |frame| frame + 1);
        println!("strobe {dark} to {on}, gate {gate}: nothing left after {frames_lit} frames");
        assert!(frames_lit <= frames, "{frames_lit} frames, stated are {frames}");
        left.push(frames_lit);
    }
    holds!(
        "H74",
        Cpu,
        "wrs, 60 frames of strobe: gone exactly after {} frames (by 1 stop {}, no gate {})",
        left[0],
        left[1],
        left[2]
    );
}

#[test]
fn h75_black_and_white_by_turns_keep_their_mean() {
    let picture = |index: u64| Image::filled(SIZE, [(index % 2) as f32; 3]);
    // Through the gate each frame replaces the last one.
    let mut post = gated(true);
    for index in 0..40 {
        assert_eq!(one(&mut post, index, &Input::still(picture(index))).0, picture(index));
    }
    // Without a gate: every pixel is one of the two, and in the long run each for half of the time.
    let mut post = gated(false);
    let mut white = vec![0_u32; 64 * 48];
    let measured = 64;
    for index in 0..200 + measured {
        let (out, ..) = one(&mut post, index, &Input::still(picture(index)));
        for (n, &c) in white.iter_mut().zip(out.pixels()) {
            assert!(c == [0.0; 3] || c == [1.0; 3]);
            *n += u32::from(index >= 200 && c[0] == 1.0);
        }
    }
    // Pixels are independent; their own means over time give the spread.
    let means: Vec<f64> = white.iter().map(|&n| f64::from(n) / measured as f64).collect();
    let n = means.len() as f64;
    let mean = means.iter().sum::<f64>() / n;
    let variance = means.iter().map(|m| (m - mean).powi(2)).sum::<f64>() / (n - 1.0);
    afterimage_testing::accept(
        &format!("mean over time {mean:.4}"),
        afterimage_testing::p_of_z((mean - 0.5) / (variance / n).sqrt()),
    );
    afterimage_testing::reject(
        "the same against 0.55",
        afterimage_testing::p_of_z((mean - 0.55) / (variance / n).sqrt()),
    );
    let p = afterimage_testing::p_of_z((mean - 0.5) / (variance / n).sqrt());
    holds!("H75", Cpu, "wrs: black or white only; gated the frame itself, else mean over time {mean:.4} (p = {p:.2})");
}
