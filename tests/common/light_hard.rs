//! Hard cases of light that changes, H72 to H75, for wrs: laws that hold on either executor.

use crate::depth_hard::{Color, Made, Make, SIZE, Steps, desc, still};
use crate::images::{View, noise, peak, times};
use crate::settings::ungated;
use afterimage::internal::{ContextDesc, Settings};
use afterimage::kernel::debug_view::PixelTrace;
use afterimage::{Exposure, Image};

/// The laws as tests of an executor. `$run_law` runs one, and returns what it measured.
macro_rules! light_laws {
    ($side:ident, $run_law:ident) => {
        crate::laws::laws! { $side, $run_law,
            h72_with_the_ratio_history_follows_the_exposure_at_once: "H72", declared_exposure;
            h72_without_the_ratio_the_gate_recovers_within_3_frames: "H72", undeclared_exposure;
            h73_a_firefly_lives_one_frame: "H73", gated_firefly;
            h73_without_the_gate_a_firefly_is_drawn_and_dies_as_the_law_says: "H73", ungated_firefly;
            h73_a_firefly_beside_a_gliding_pixel_does_not_spread: "H73", gliding_firefly;
            h74_a_strobe_leaves_nothing_behind: "H74", strobe;
            h75_black_and_white_by_turns_keep_their_mean: "H75", black_and_white;
        }
    };
}
pub(crate) use light_laws;

const EXPOSED: f32 = 256.0;

fn gated(gate: bool) -> ContextDesc {
    desc(if gate { Settings::paper() } else { ungated() })
}

/// Share of pixels.
fn share(image: &Image<PixelTrace>, f: impl Fn(usize, &PixelTrace) -> bool) -> f64 {
    let hits = image.pixels().iter().enumerate().filter(|(i, t)| f(*i, t)).count();
    hits as f64 / image.pixels().len() as f64
}

/// Noise, new every frame, as bright as `ratio`.
pub fn frame(index: u64, ratio: f32) -> Color {
    times(&noise(SIZE, &format!("light {index}")), ratio)
}

/// Exposure that changes by x256 in one frame, declared.
pub fn declared_exposure(make: Make<'_>) -> Option<String> {
    for ratio in [EXPOSED, 1.0 / EXPOSED] {
        // The same clip at one exposure, and with a change from frame 10 on. Without a gate all decisions are the same.
        let (mut plain, mut post) = (make(gated(false))?, make(gated(false))?);
        for index in 0..20 {
            let before = plain.step(index, &still(frame(index, 1.0)));
            let after = match index {
                0..10 => post.step(index, &still(frame(index, 1.0))),
                10 => post.exposed(index, &still(frame(index, ratio)), Exposure::Changed { ratio }),
                _ => post.exposed(index, &still(frame(index, ratio)), Exposure::Changed { ratio: 1.0 }),
            };
            let expected = if index < 10 { before.shown } else { times(&before.shown, ratio) };
            assert_eq!((after.shown, after.stats), (expected, before.stats), "x{ratio}, frame {index}");
            assert_eq!(after.trace, before.trace, "x{ratio}, frame {index}");
        }
        // With the gate: a still picture is unaffected by it.
        let mut post = make(gated(true))?;
        for index in 0..10 {
            post.step(index, &still(frame(0, 1.0)));
        }
        let bright = frame(0, ratio);
        let Made { shown: out, stats, trace, .. } =
            post.exposed(10, &still(bright.clone()), Exposure::Changed { ratio });
        assert_eq!((out, stats.rejected()), (bright, 0));
        assert!(trace.pixels().iter().all(|t| t.agreement == 1.0));
        assert!(share(&trace, |_, t| !t.is_replaced) > 0.7, "and is kept");
    }
    // The planted error: the inverse of the ratio.
    let mut post = make(gated(true))?;
    post.step(0, &still(frame(0, 1.0)));
    let trace = post.exposed(1, &still(frame(0, EXPOSED)), Exposure::Changed { ratio: 1.0 / EXPOSED }).trace;
    assert!(share(&trace, |_, t| t.agreement == 0.0) > 0.9);
    Some(
        "wrs, x256 and /256 declared: 10 frames the same as unexposed ones times the ratio, bit for bit; 0 rejected"
            .into(),
    )
}

/// The same, undeclared.
pub fn undeclared_exposure(make: Make<'_>) -> Option<String> {
    // Brighter: all history is too dark, and rejected at once. Darker: history that happens to look alike stays a
    // little longer. Without the gate, history is replaced only by chance.
    let mut took = vec![];
    for (ratio, gate, frames, all) in [(EXPOSED, true, 0, 0), (1.0 / EXPOSED, true, 3, 20), (EXPOSED, false, 60, 100)] {
        let mut post = make(gated(gate))?;
        for index in 0..30 {
            post.step(index, &still(frame(index, 1.0)));
        }
        let mut stale = vec![];
        for index in 30..40 + all as u64 {
            let Made { stats, trace, .. } = post.step(index, &still(frame(index, ratio)));
            assert_eq!(stats.rejected(), 0);
            stale.push(share(&trace, |_, t| u64::from(t.age) > index - 30));
        }
        let until = |limit: f64| stale.iter().rposition(|&s| s > limit).map_or(0, |last| last + 1);
        assert!(until(0.01) <= frames && until(0.0) <= all, "stated are {frames} and {all}");
        took.push(until(0.01));
    }
    Some(format!(
        "wrs, undeclared: 1 % stale after {} frames (x256), {} (/256); without a gate {}",
        took[0], took[1], took[2]
    ))
}

/// A frame of the brightest half, with the gate.
pub fn gated_firefly(make: Make<'_>) -> Option<String> {
    // The gate rejects history that differs so much, and then the firefly: the output is the input.
    let lit = flash(make(gated(true))?, 65504.0, 20);
    assert_eq!((lit[0], lit[1..].iter().sum()), (64 * 48, 0_u64));
    Some("wrs, gated: 65504 in 1/32 is shown for 1 frame of 20, in all 3072 pixels".into())
}

/// A frame of the brightest half, without the gate.
pub fn ungated_firefly(make: Make<'_>) -> Option<String> {
    // Constant weights w: in units of w the sum follows a = a^2 / (a + 1) + 1 (eq. 5), whatever w; a frame is taken
    // with 1 / a.
    let lit = flash(make(gated(false))?, 65504.0, 100);
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
    assert!(energy > 1.0 && energy < 1.15, "what a stream of constant light keeps is within 15 % of what it brings");
    assert!(lit[70..].iter().all(|&n| n == 0), "gone within 70 frames");
    let last = lit.iter().rposition(|&n| n > 0).unwrap() + 1;
    Some(format!(
        "wrs, no gate: light shown over light brought {shown:.3} (by the law {energy:.3}), gone after {last} frames"
    ))
}

/// A firefly of one frame in means of weighted samples, while everything glides by a part of a pixel.
pub fn gliding_firefly(make: Make<'_>) -> Option<String> {
    let mut worst = 0.0_f32;
    for light in [10.0, 65504.0] {
        let mut post = make(desc(Settings::weighted()))?;
        for index in 0..17 {
            let mut color = Image::filled(SIZE, [0.5; 3]);
            if index == 5 {
                color.pixels_mut()[16 * SIZE[0] as usize + 50] = [light; 3];
            }
            let view = View { motion: Some(Image::filled(SIZE, [0.37, 0.0])), ..still(color) };
            let shown = post.step(index, &view).shown;
            let brightest = peak(&shown);
            // The planted error: the firefly's own frame.
            assert_eq!(index == 5, brightest >= light, "{brightest} of {light} in frame {index}");
            worst = if index == 15 { worst.max(brightest) } else { worst };
        }
    }
    assert!(worst < 0.6, "{worst}");
    Some(format!("wrs, means, gliding: {worst:.3} in a picture of 0.5, ten frames after fireflies of 10 to 65504"))
}

/// A strobe of one frame on and one off.
pub fn strobe(make: Make<'_>) -> Option<String> {
    // One frame on, one off, for 60 frames, by a lot and by a stop; then dark again, and exactly so after the frames
    // stated.
    let mut left = vec![];
    for (gate, on, frames) in [(true, 1.0, 6), (true, 0.0625, 40), (false, 1.0, 100)] {
        let mut post = make(gated(gate))?;
        let dark = 0.031_25;
        let mut last_lit = None;
        for index in 0..70 + frames {
            let light = if index < 60 && index % 2 == 1 { on } else { dark };
            let out = post.step(index, &still(Image::filled(SIZE, [light; 3]))).shown;
            assert!(out.pixels().iter().all(|&c| c == [dark; 3] || c == [on; 3]));
            if index >= 60 && out.pixels().iter().any(|&c| c != [dark; 3]) {
                last_lit = Some(index - 60);
            }
        }
        let frames_lit = last_lit.map_or(0, |frame| frame + 1);
        assert!(frames_lit <= frames, "{frames_lit} frames, stated are {frames}");
        left.push(frames_lit);
    }
    Some(format!(
        "wrs, 60 frames of strobe: gone exactly after {} frames (by 1 stop {}, no gate {})",
        left[0], left[1], left[2]
    ))
}

/// Black and white by turns.
pub fn black_and_white(make: Make<'_>) -> Option<String> {
    let picture = |index: u64| Image::filled(SIZE, [(index % 2) as f32; 3]);
    // Through the gate each frame replaces the last one.
    let mut post = make(gated(true))?;
    for index in 0..40 {
        assert_eq!(post.step(index, &still(picture(index))).shown, picture(index));
    }
    // Without a gate: every pixel is one of the two, and in the long run each for half of the time.
    let mut post = make(gated(false))?;
    let mut white = vec![0_u32; 64 * 48];
    let measured = 64;
    for index in 0..200 + measured {
        let out = post.step(index, &still(picture(index))).shown;
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
    Some(format!("wrs: black or white only; gated the frame itself, else mean over time {mean:.4} (p = {p:.2})"))
}

/// Pixels that are not `dark`, frame after frame, if all of them flash once at frame 30.
fn flash(mut post: Box<dyn Steps>, light: f32, frames: u64) -> Vec<u64> {
    let dark = 0.031_25;
    let lit = |index: u64| {
        let color = Image::filled(SIZE, [if index == 30 { light } else { dark }; 3]);
        let out = post.step(index, &still(color)).shown;
        out.pixels().iter().filter(|&&c| c != [dark; 3]).count() as u64
    };
    (0..30 + frames).map(lit).skip(30).collect()
}
