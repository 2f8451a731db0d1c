//! Offsets that repeat, and offsets that are not those of the samples.

use super::*;

const GAZE: [f32; 2] = [40.0, 30.0];

/// Masks that stand still, and masks that show every place three times.
pub fn repeated_offsets(make: Make) -> Option<String> {
    let (mut least, mut mean) = ([f64::INFINITY; 3], [0.0; 3]);
    for (i, speed_px) in [[0.0; 2], [0.37, 0.21], [1.6, -0.7]].into_iter().enumerate() {
        let mut post = make(smr(SIZE))?;
        let mut last = None;
        for index in 0..3 * TURN {
            let full = waves(SIZE, speed_px.map(|v| v * index as f32));
            let shot = Shot::masked(full.clone(), &placed(SIZE, GAZE, |_| [1, 0])).moving(speed_px);
            let shown = post.one(index, &shot);
            assert_finite(&shown, "standing");
            let [smr, none] = [&shown, &none(&shot)].map(|c| psnr(squared_error(c, &full, everywhere)));
            least[i] = least[i].min(smr - none);
            if index >= TURN {
                mean[i] += (smr - none) / (2 * TURN) as f64;
            }
            if i == 0 && index >= TURN {
                assert_eq!(last, Some(shown.clone()), "frame {index}: nothing drifts");
            }
            last = Some(shown);
        }
    }
    let full = noise(SIZE, "thrice");
    for frames in [1, 3] {
        let mut post = make(smr(SIZE))?;
        for index in 0..frames * TURN + frames {
            let shown = post.one(index, &Shot::foveated(full.clone(), GAZE, index / frames));
            let wrong = wrong(&shown, &full, everywhere);
            assert_eq!(wrong == 0, index >= frames * (TURN - 1), "{frames}, frame {index}: {wrong}");
        }
    }
    // With motion, samples at fixed places show other points of the surfaces.
    assert!(mean[1] > 6.0 && mean[2] > 6.0, "{mean:?}");
    // Storage rounds to 9 bits.
    assert!(least.iter().all(|&gain| gain > -0.01), "worse than the foveated frame: {least:?}");
    Some(format!(
        "standing for {} frames: still {:+.3} dB against foveated at least, and constant; gliding by 0.4 and 1.7 px a frame {:+.1} and {:+.1} on average; each offset once or thrice: exact after as many turns",
        3 * TURN,
        least[0],
        mean[1],
        mean[2]
    ))
}

/// From the claimed place of a sample of a pattern of `step` to its true one, in pixels.
fn beside(claim: &str, index: u64, step: u32) -> [i32; 2] {
    let claimed = offset_px(index, step).map(u32::cast_signed);
    match claim {
        "right" => [1, 0],
        "by turns" => [1 - 2 * (index as i32 % 2), 0],
        "mirrored" => claimed.map(|v| step.cast_signed() - 1 - 2 * v),
        _ => {
            let late = offset_px(index.saturating_sub(1), step).map(u32::cast_signed);
            [late[0] - claimed[0], late[1] - claimed[1]]
        }
    }
}

/// Samples that lie one pixel beside the claimed place, at the mirrored place, or at that of the last frame.
pub fn offsets_off_by_one(make: Make) -> Option<String> {
    let claims = ["right", "by turns", "mirrored", "late"];
    let mut figures = vec![];
    for claim in claims {
        let mut worst = [f64::NEG_INFINITY; 2];
        for (worst, speed_px) in worst.iter_mut().zip([[0.0; 2], [0.37, 0.21]]) {
            let mut post = make(smr(SIZE))?;
            for index in 0..2 * TURN {
                let shift = speed_px.map(|v| v * index as f32);
                let full = waves(SIZE, shift);
                let color = Image::from_fn(SIZE, |px| {
                    let step = step_at(GAZE, px);
                    let error = if step == 1 { [0, 0] } else { beside(claim, index, step) };
                    wave([0, 1].map(|i| px[i] as f32 + error[i] as f32 - shift[i]))
                });
                let shot = Shot::foveated(color, GAZE, index).moving(speed_px);
                let shown = post.one(index, &shot);
                assert_finite(&shown, claim);
                let [smr, none] = [&shown, &none(&shot)].map(|c| psnr(squared_error(c, &full, everywhere)));
                *worst = worst.max(none - smr);
            }
        }
        // Scrambled detail costs more than blur. Measured, and a margin of a quarter.
        assert!(worst[0] < 3.1 && worst[1] < 1.0, "{claim}: {worst:?}");
        figures.push(format!("{claim} {:.1}, {:.1}", worst[0], worst[1]));
    }
    Some(format!("at the most so many dB below the foveated frame, still and moving: {}", figures.join("; ")))
}
