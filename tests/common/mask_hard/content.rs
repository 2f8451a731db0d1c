//! Content of the frames: lines of one pixel's width, sparkles, fast motion.

use super::*;

/// Share of pixel `x` that a line of one pixel's width covers whose left edge is at `left`.
fn covered(x: u32, left: f32) -> f32 {
    (1.0 - (x as f32 - left).abs()).max(0.0)
}

/// A vertical and a horizontal line of one pixel's width in the periphery.
pub fn thin_lines(make: Make) -> Option<String> {
    let gaze = [30.0, 25.0];
    let shot = |index: u64, speed_px: [f32; 2]| {
        let left = [70.0, 58.0];
        let edge = [0, 1].map(|i| left[i] + speed_px[i] * index as f32);
        let color = Image::from_fn(SIZE, |px| {
            let line = covered(px[0], edge[0]).max(covered(px[1], edge[1]));
            [0.15 + 0.75 * line, 0.2 + 0.5 * line, 0.3 + 0.1 * line]
        });
        Shot::foveated(color, gaze, index).moving(speed_px)
    };
    let mut post = make(smr(SIZE))?;
    for index in 0..2 * TURN {
        let shot = shot(index, [0.0; 2]);
        let wrong = wrong(&post.one(index, &shot), &shot.color, everywhere);
        assert_eq!(wrong == 0, index >= TURN - 1, "frame {index}: {wrong}");
    }
    let mut figures = vec![];
    for speed_px in [[0.1, 0.05], [0.5, -0.25], [-1.3, -0.7]] {
        let mut post = make(smr(SIZE))?;
        let mut sums = [0.0; 2];
        let mut least = f64::INFINITY;
        for index in 0..2 * TURN {
            let shot = shot(index, speed_px);
            let at_line = |[x, y]: [u32; 2]| {
                let color =
                    |x: u32, y: u32| shot.color.at(x.min(SIZE[0] - 1) as usize, y.min(SIZE[1] - 1) as usize)[0] > 0.151;
                (0..3).any(|i| color((x + i).saturating_sub(1), y) || color(x, (y + i).saturating_sub(1)))
            };
            let shown = post.one(index, &shot);
            let errors = [&shown, &none(&shot)].map(|c| squared_error(c, &shot.color, at_line));
            (0..2).for_each(|i| sums[i] += errors[i]);
            least = least.min(psnr(errors[0]) - psnr(errors[1]));
        }
        let gain = psnr(sums[0]) - psnr(sums[1]);
        assert!(gain > 0.0 && least > -0.3, "{speed_px:?}: {gain:.2} dB, at least {least:.2}");
        figures.push(format!("{gain:+.1} ({least:+.1} at least)"));
    }
    Some(format!(
        "still: exact from frame {} on; gliding by 0.1, 0.6 and 1.5 px a frame: {} dB against foveated",
        TURN - 1,
        figures.join(", ")
    ))
}

/// A pixel that is very bright in one frame, in which it is a sample.
pub fn sparkles(make: Make) -> Option<String> {
    let at = [70, 58];
    let clean = waves(SIZE, [0.0; 2]);
    let shot = |color: Color, index| Shot::foveated(color, [30.0, 25.0], index);
    let highest = 0.8;
    let mut figures = vec![];
    // In the first turn, when history is coarse, and after it, when confidence in history is high.
    for (from, light) in [(0, 2.0), (TURN, 65504.0)] {
        let bright = (from..).find(|&index| shot(clean.clone(), index).samples(at))?;
        let (mut frames, mut area, mut above) = (0, 0, 0.0_f32);
        let (mut post, mut without) = (make(smr(SIZE))?, make(smr(SIZE))?);
        for index in 0..bright + 2 * TURN {
            let is_bright = |px| index == bright && px == at;
            let sparkle = Image::from_fn(SIZE, |px| if is_bright(px) { [light; 3] } else { pixel(&clean, px) });
            let input = shot(sparkle, index);
            let shown = post.one(index, &input);
            let expected = without.one(index, &shot(clean.clone(), index));
            assert_finite(&shown, "sparkle");
            let most = peak(&shown);
            let rounding = 1.0 + 1.0 / 511.0;
            // A gain lifts history above the samples by a quarter of their range at the most.
            assert!(most <= 1.25 * light * rounding, "{most} exceeds the input {light}");
            if index == bright {
                above = above.max(most / light);
            }
            assert!(index >= bright || shown == expected);
            // Pixels that are visibly brighter than without.
            let lit = |(a, b): (&[f32; 3], &[f32; 3])| (0..3).any(|c| a[c] > b[c] + 0.02);
            let lit = shown.pixels().iter().zip(expected.pixels()).filter(|&pair| lit(pair)).count();
            if index > bright && lit > 0 {
                frames = frames.max(index - bright);
                area = area.max(lit);
            }
            if index >= bright + TURN {
                assert_eq!(lit, 0, "{light} in frame {bright}: seen {} frames later", index - bright);
                assert!(most <= highest * rounding, "{most}");
            }
        }
        figures.push(format!("{light} in frame {bright}: {frames} frames, {area} px, {above:.2} of its light"));
    }
    Some(format!(
        "trail beside 0.8, its largest area, and the most light shown: {}; all gone when its pixel is sampled again",
        figures.join("; ")
    ))
}

/// Everything moves by 20 pixels and more a frame.
pub fn fast_motion(make: Make) -> Option<String> {
    let mut figures = vec![];
    for (name, speed_px, has_vectors) in [
        ("20 px", [20.0, 0.0], true),
        ("(20.3, -7.6) px", [20.3, -7.6], true),
        ("200 px", [200.0, 0.0], true),
        ("20 px without vectors", [20.0, 0.0], false),
    ] {
        let mut post = make(smr(SIZE))?;
        let (mut sums, mut least) = ([0.0; 2], f64::INFINITY);
        for index in 0..2 * TURN {
            let full = waves(SIZE, speed_px.map(|v| v * index as f32));
            let shot = Shot::foveated(full.clone(), [40.0, 30.0], index);
            let shot = if has_vectors { shot.moving(speed_px) } else { shot };
            let shown = post.one(index, &shot);
            assert_finite(&shown, name);
            let errors = [&shown, &none(&shot)].map(|c| squared_error(c, &full, everywhere));
            (0..2).for_each(|i| sums[i] += errors[i]);
            least = least.min(psnr(errors[0]) - psnr(errors[1]));
        }
        let gain = psnr(sums[0]) - psnr(sums[1]);
        if has_vectors {
            // Positions are rounded to 1/24 pixel, which is why a frame may be a little worse.
            assert!(gain > -0.05 && least > -0.1, "{name}: {gain:.2} dB, at least {least:.2}");
        }
        // Without vectors each frame is an unannounced cut (H93).
        assert!(least > -4.6, "{name}: {least:.2}");
        figures.push(format!("{name} {gain:+.2} ({least:+.2} at least)"));
    }
    Some(format!("dB against the foveated frame: {}", figures.join("; ")))
}
