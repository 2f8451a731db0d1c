//! Content of the frames: lines of one pixel's width, sparkles, fast motion, silhouettes.

use super::*;

/// Share of pixel `x` that a line of one pixel's width covers whose left edge is at `left`.
fn covered(x: u32, left: f32) -> f32 {
    (1.0 - (x as f32 - left).abs()).max(0.0)
}

/// A vertical and a horizontal line of one pixel's width in the periphery.
pub fn thin_lines(make: Make) -> Option<String> {
    let foveation = foveation();
    let gaze = [30.0, 25.0];
    let shot = |index: u64, speed_px: [f32; 2]| {
        let left = [70.0, 58.0];
        let edge = [0, 1].map(|i| left[i] + speed_px[i] * index as f32);
        let color = Image::from_fn(SIZE, |px| {
            let line = covered(px[0], edge[0]).max(covered(px[1], edge[1]));
            [0.15 + 0.75 * line, 0.2 + 0.5 * line, 0.3 + 0.1 * line]
        });
        Shot::foveated(color, &foveation, gaze, index).moving(speed_px)
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
    let foveation = foveation();
    let shot = |color: Color, index| Shot::foveated(color, &foveation, [30.0, 25.0], index);
    let highest = 0.8;
    let mut figures = vec![];
    // In the first turn, when history is coarse, and after it, when confidence in history is high.
    for (from, light) in [(0, 2.0), (TURN, 65504.0)] {
        let bright = (from..).find(|&index| shot(clean.clone(), index).lattices().at(at).unwrap().samples(at))?;
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
            let shot = Shot::foveated(full.clone(), &foveation(), [40.0, 30.0], index);
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

/// A near square in front of a wall that moves in another way.
fn square(index: u64) -> Shot {
    let t = index as f32;
    let (near_px, wall_px) = ([1.3 * t, 0.5 * t], [-0.4 * t, 0.2 * t]);
    let is_near = |px: [u32; 2]| {
        let at = [0, 1].map(|i| px[i] as f32 - near_px[i]);
        (20.0..44.0).contains(&at[0]) && (14.0..40.0).contains(&at[1])
    };
    let shift = |px: [u32; 2]| if is_near(px) { near_px } else { wall_px };
    let color = Image::from_fn(SIZE, |px| {
        let [r, g, b] = wave([0, 1].map(|i| px[i] as f32 - shift(px)[i]));
        if is_near(px) { [r, 0.3 * g, 0.2 * b] } else { [0.3 * r, g, b] }
    });
    let speed = |px| if is_near(px) { [-1.3, -0.5] } else { [0.4, -0.2] };
    let depth = Image::from_fn(SIZE, |px| if is_near(px) { 2.0 } else { 6.5 });
    let motion = Image::from_fn(SIZE, speed);
    Shot::foveated(color, &foveation(), [75.0, 20.0], index)
        .with(|view| (view.depth, view.motion) = (Some(depth), Some(motion)))
}

/// Whether a pixel within a coarse step of `px` is of another surface.
fn is_silhouette(depth: &Image<f32>, px: [u32; 2]) -> bool {
    let beside = |d: [u32; 2]| [0, 1].map(|i| (px[i] + d[i]).saturating_sub(4).min(SIZE[i] - 1));
    pixels([9, 9]).any(|d| pixel(depth, beside(d)) != pixel(depth, px))
}

/// Depth and motion at the samples only, across silhouettes.
pub fn silhouettes(make: Make) -> Option<String> {
    let (mut full, mut sparse) = (make(smr(SIZE))?, make(smr(SIZE))?);
    let mut sums = [[0.0; 3]; 2];
    for index in 0..2 * TURN {
        let shot = square(index);
        let at_samples = shot.clone().with(|view| {
            // What lies between the samples must not be read.
            view.depth = view.depth.as_ref().map(|depth| view.read_of(depth, f32::NAN));
            view.facts.lattices = view.facts.lattices.map(Lattices::with_geometry_at_samples);
        });
        let shown = [full.one(index, &shot), sparse.one(index, &at_samples), none(&shot)];
        shown.iter().for_each(|shown| assert_finite(shown, "silhouettes"));
        if index < TURN {
            continue;
        }
        let depth = shot.depth.as_ref().unwrap();
        let near = Image::from_fn(SIZE, |px| is_silhouette(depth, px));
        for (part, sums) in sums.iter_mut().enumerate() {
            let counts = |px: [u32; 2]| pixel(&near, px) == (part == 0);
            (0..3).for_each(|i| sums[i] += squared_error(&shown[i], &shot.color, counts) / TURN as f64);
        }
    }
    let [edges, inside] = sums.map(|sums| sums.map(psnr));
    assert!(edges[1] > edges[2], "worse than the foveated frame at silhouettes: {edges:?}");
    assert!(inside[1] > inside[2], "{inside:?}");
    Some(format!(
        "within 4 px of silhouettes {:.1} dB with full geometry, {:.1} at samples, foveated {:.1}; elsewhere {:.1}, {:.1}, {:.1}",
        edges[0], edges[1], edges[2], inside[0], inside[1], inside[2]
    ))
}
