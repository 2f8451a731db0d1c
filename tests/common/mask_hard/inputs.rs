//! Inputs beside the color: invalid ones, exposure, trust, several views, gaze, settings that change.

use super::*;

/// NaN in one sample of the periphery, in one frame.
pub fn invalid_samples(make: Make) -> Option<String> {
    let at = [70, 58];
    let full = waves(SIZE, [0.0; 2]);
    let shot = |color: Color, index| Shot::foveated(color, [30.0, 25.0], index);
    let holed = |value: f32| Image::from_fn(SIZE, |px| if px == at { [value; 3] } else { pixel(&full, px) });
    let mut reach = 0;
    let mut after = 0;
    for (from, value) in [(0, f32::NAN), (0, f32::NEG_INFINITY), (TURN, f32::NAN), (TURN, f32::INFINITY)] {
        let bad = (from..).find(|&index| shot(full.clone(), index).samples(at))?;
        let (mut post, mut clean) = (make(smr(SIZE))?, make(smr(SIZE))?);
        for index in 0..bad + TURN + 4 {
            let color = if index == bad { holed(value) } else { full.clone() };
            let shown = post.one(index, &shot(color, index));
            let expected = clean.one(index, &shot(full.clone(), index));
            assert_finite(&shown, "a sample that is NaN");
            // Pixels that the sample is interpolated for: nearer than a step.
            let apart = |px: [u32; 2]| (0..2).map(|i| px[i].abs_diff(at[i])).max().unwrap();
            let differs = |&px: &[u32; 2]| pixel(&shown, px) != pixel(&expected, px);
            let farthest = pixels(SIZE).filter(differs).map(apart).max();
            if index == bad {
                reach = reach.max(farthest.unwrap_or(0));
            } else if let Some(far) = farthest {
                after = after.max(far);
            }
            if index >= (bad + TURN) || from == TURN && index >= TURN {
                assert_eq!(wrong(&shown, &full, everywhere), 0, "frame {index}: complete history, or sampled again");
            }
        }
    }
    // Interpolation reaches a step, and estimates of light a step further.
    assert!(reach < 8 && after < 8, "pixels {reach} and {after} px away are changed by an invalid sample");
    // The only sample of a view.
    let only = |index: u64| Image::from_fn(SIZE, |px| px == [40 + index as u32, 30]);
    let mut post = make(smr(SIZE))?;
    let mut last = post.one(0, &Shot::masked(full.clone(), &only(0)));
    for index in 1..4 {
        let color = if index == 2 { Image::filled(SIZE, [f32::NAN; 3]) } else { full.clone() };
        let shown = post.one(index, &Shot::masked(color, &only(index)));
        assert_finite(&shown, "the only sample");
        if index == 2 {
            // Where history had a share below 1, the stored color differs a little from the output.
            assert!(squared_error(&shown, &last, everywhere) < 1e-6, "the last frame again");
        }
        last = shown;
    }
    Some(format!(
        "NaN, +Inf, -Inf in one sample of sixteen pixels: never shown; with complete history nothing changes, without it pixels up to {reach} px away, then {after}, until it is sampled again; the only sample: the last frame again"
    ))
}

fn gliding(index: u64, gaze_px: [f32; 2], phase: f32) -> Shot {
    let speed = [0.4, -0.3];
    let full = waves(SIZE, speed.map(|v| v * index as f32 + phase));
    Shot::foveated(full, gaze_px, index).moving(speed)
}

/// Exposure, trust, two views, lost gaze, and a foveation that changes in every frame.
pub fn light_trust_views_gaze_and_foveation(make: Make) -> Option<String> {
    // An exposure of a power of two that is declared keeps what was rebuilt.
    let full = waves(SIZE, [0.0; 2]);
    let exposures = [256.0_f32, 1.0 / 256.0, 4.0, 0.25];
    let mut post = make(smr(SIZE))?;
    let (mut exposure, mut index, mut off) = (1.0, 0, 0.0);
    for ratio in [1.0; TURN as usize].into_iter().chain(exposures.into_iter().flat_map(|ratio| [ratio, 1.0, 1.0])) {
        exposure *= ratio;
        let color = times(&full, exposure);
        let shot = Shot::foveated(color.clone(), [40.0, 30.0], index);
        let shown = post.one(index, &Shot { exposure: Exposure::Changed { ratio }, ..shot });
        assert_finite(&shown, "exposure");
        if index >= TURN - 1 {
            let relative = |(a, b): (&[f32; 3], &[f32; 3])| {
                let largest = b.iter().fold(0.0_f32, |m, &v| m.max(v));
                (0..3).map(|c| (a[c] - b[c]).abs() / largest).fold(0.0_f32, f32::max)
            };
            off = shown.pixels().iter().zip(color.pixels()).map(relative).fold(off, f32::max);
        }
        index += 1;
    }
    // A gain follows where rounding to 9 bits exceeds its expected error, as it does in bright light.
    assert!(off < 0.01, "{off}: detail is lost");
    // A trust of 0 gives the same output as a reset. It does not change other pixels.
    let gaze = |index: u64| [40.0 + index as f32, 30.0];
    let (mut post, mut plain) = (make(smr(SIZE))?, make(smr(SIZE))?);
    let is_distrusted = |px: [u32; 2]| (px[0] / 5).is_multiple_of(3);
    for index in 0..6 {
        post.one(index, &gliding(index, gaze(index), 0.0));
        plain.one(index, &gliding(index, gaze(index), 0.0));
    }
    let shot = gliding(6, gaze(6), 0.0);
    let fresh = make(smr(SIZE))?.one(6, &shot);
    let trust = Image::from_fn(SIZE, |px| if is_distrusted(px) { 0.0 } else { 1.0 });
    let shown = post.one(6, &shot.clone().with(|view| view.trust = Some(trust)));
    let other = plain.one(6, &shot);
    assert_eq!(squared_error(&shown, &fresh, is_distrusted), 0.0, "no trust: the candidate");
    let trusted = squared_error(&shown, &other, |px| !is_distrusted(px));
    let history = squared_error(&other, &fresh, |px| !is_distrusted(px));
    assert!(trusted < 0.1 * history, "fewer samples are compared, no more");
    // Two views do not affect each other.
    let both = ContextDesc { view_count: 2, ..smr(SIZE) };
    let (mut pair, mut left, mut right) = (make(both)?, make(smr(SIZE))?, make(smr(SIZE))?);
    for index in 0..8 {
        let shots = [gliding(index, gaze(index), 0.0), gliding(index, [20.0, 60.0 - index as f32], 9.0)];
        let alone = vec![left.one(index, &shots[0]), right.one(index, &shots[1])];
        assert_eq!(pair.show(index, &shots), alone, "frame {index}");
    }
    // The masks say where samples are; a gaze that is lost, off the view or NaN changes nothing.
    let gazes =
        [Gaze::Lost, Gaze::At { px: [f32::NAN, 3.0] }, Gaze::At { px: [-1e9, 1e9] }, Gaze::Uv { uv: [0.1, 0.9] }];
    let (mut lost, mut known) = (make(smr(SIZE))?, make(smr(SIZE))?);
    for index in 0..8 {
        let shot = gliding(index, gaze(index), 0.0);
        let mut blind = shot.clone();
        blind.facts.gaze = gazes[index as usize % gazes.len()];
        assert_eq!(lost.one(index, &blind), known.one(index, &shot), "frame {index}");
    }
    // Another foveation in each frame, whose masks are planned.
    let mut post = make(smr(SIZE))?;
    let mut draws = Draws::new("another foveation in each frame");
    let (mut gain, mut mean) = (f64::INFINITY, 0.0);
    for index in 0..3 * TURN {
        let [mid, far] = [[2, 2], [2, 4], [2, 8], [4, 8], [4, 4], [8, 8]][draws.bits() as usize % 6];
        let foveation = Foveation { rate_mid: mid, rate_far: far, mid_deg: draws.range(10.0, 60.0), ..foveation() };
        post.set_settings(Settings { foveation, ..smr(SIZE).settings });
        let px = [draws.range(-20.0, 110.0), draws.range(-20.0, 90.0)];
        let shot = Shot::planned(full.clone(), Gaze::At { px });
        let foveated = none(&Shot::masked(full.clone(), &post.plan(index, &shot)));
        let shown = post.one(index, &shot);
        assert_finite(&shown, "foveation");
        let errors = [&shown, &foveated].map(|c| psnr(squared_error(c, &full, everywhere)));
        gain = gain.min(errors[0] - errors[1]);
        mean += (errors[0] - errors[1]) / (3 * TURN) as f64;
    }
    assert!(gain > -0.01, "{gain:.3} dB against the foveated frame");
    Some(format!(
        "exposure x256, /256, x4, /4 declared: detail kept within {off:.4}; trust 0: the candidate; two views, and any gaze: bit for bit as alone; {} foveations: {mean:+.1} dB against foveated, never below",
        3 * TURN
    ))
}
