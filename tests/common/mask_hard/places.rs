//! Where the samples lie: positions that are never sampled, odd masks, borders between rates.

use super::*;

/// A gaze that jumps with the parity of the order: some positions are in a finer pattern only in frames in which it
/// samples others.
pub fn starved_positions(make: Make) -> Option<String> {
    const FRAMES: u64 = 4 * TURN;
    let gaze_px = |index: u64| [if index.is_multiple_of(2) { 26.0 } else { 62.0 }, 35.0];
    let shot = |index| Shot::foveated(waves(SIZE, [0.0; 2]), gaze_px(index), index);
    let shots: Vec<_> = (0..FRAMES).map(shot).collect();
    let is_starved = |px: [u32; 2]| !shots.iter().any(|shot| shot.samples(px));
    let starved = Image::from_fn(SIZE, is_starved);
    let is_starved = |px: [u32; 2]| pixel(&starved, px);
    let count = starved.pixels().iter().filter(|&&s| s).count();
    assert!(count > 200, "{count} starved pixels: the case is not there");
    let mut post = make(smr(SIZE))?;
    let mut gains = [f64::INFINITY; 2];
    for (index, shot) in (0..).zip(&shots) {
        let shown = post.one(index, shot);
        assert_finite(&shown, &format!("frame {index}"));
        if index >= TURN {
            assert_eq!(wrong(&shown, &shot.color, |px| !is_starved(px)), 0, "frame {index}: the others are rebuilt");
            let foveated = none(shot);
            let gain = |counts: &dyn Fn([u32; 2]) -> bool| {
                psnr(squared_error(&shown, &shot.color, counts)) - psnr(squared_error(&foveated, &shot.color, counts))
            };
            gains[0] = gains[0].min(gain(&is_starved));
            gains[1] = gains[1].min(gain(&everywhere));
        }
    }
    assert!(gains[0] > 0.0 && gains[1] > 0.0, "worse than the foveated frame: {gains:?} dB");
    Some(format!(
        "{count} of {} pixels never sampled in {FRAMES} frames: there at least {:+.1} dB against the foveated frame, all others exact",
        SIZE[0] * SIZE[1],
        gains[0]
    ))
}

/// Degenerate masks.
pub fn degenerate_masks(make: Make) -> Option<String> {
    let full = noise(SIZE, "degenerate");
    let [right, bottom] = SIZE.map(|side| side - 1);
    let cases: [(&str, Mask); 6] = [
        ("one pixel", Image::from_fn(SIZE, |px| px == [40, 30])),
        ("one in the last corner", Image::from_fn(SIZE, |px| px == [right, bottom])),
        ("the last row and column", Image::from_fn(SIZE, |px| px[0] == right || px[1] == bottom)),
        ("every second column", Image::from_fn(SIZE, |px| px[0].is_multiple_of(2))),
        ("all but one", Image::from_fn(SIZE, |px| px != [41, 30])),
        ("all", Image::filled(SIZE, true)),
    ];
    for (name, mask) in &cases {
        let mut post = make(smr(SIZE))?;
        let shot = Shot::masked(full.clone(), mask).with(|view| view.depth = Some(Image::filled(SIZE, 3.0)));
        let shot = shot.moving([0.0; 2]);
        for index in 0..3 {
            let shown = post.one(index, &shot);
            assert_finite(&shown, name);
            for px in pixels(SIZE).filter(|&px| pixel(mask, px)) {
                let (a, b) = (pixel(&shown, px), pixel(&full, px));
                let rounding = if index == 0 { 0.0 } else { 1.0 / 511.0 };
                assert!((0..3).all(|c| (a[c] - b[c]).abs() <= rounding), "{name}: {a:?} instead of {b:?}");
            }
        }
    }
    // Frames without any sample: black at first, then what was shown.
    let nothing = Shot::masked(full.clone(), &Image::filled(SIZE, false));
    let mut post = make(smr(SIZE))?;
    assert!(post.one(0, &nothing).pixels().iter().all(|&c| c == [0.0; 3]));
    let last = post.one(1, &Shot::masked(full.clone(), &placed(SIZE, [-99.0; 2], |_| [3, 3])));
    for index in 2..6 {
        assert_eq!(wrong(&post.one(index, &nothing), &last, everywhere), 0);
    }
    // A view of one pixel.
    let mut post = make(smr([1, 1]))?;
    let dot = noise([1, 1], "dot");
    for index in 0..4 {
        let shown = post.one(index, &Shot::masked(dot.clone(), &Image::filled([1, 1], true)));
        assert_eq!(wrong(&shown, &dot, everywhere), 0);
    }
    Some(format!(
        "{} masks: samples shown bit for bit; without a sample black, or the last frame again; a view of one pixel",
        cases.len()
    ))
}

/// The fovea, and the borders between rates, on a picture that glides while the gaze wanders, by planned masks.
pub fn borders(make: Make) -> Option<String> {
    /// Frames in which the even pattern visits every pixel.
    const ALL: u64 = 2 * TURN;
    let mut least = f64::INFINITY;
    let mut sums = [0.0; 2];
    for speed_px in [[0.0; 2], [0.3, -0.2]] {
        let mut post = make(smr(SIZE))?;
        let mut sampled = Image::filled(SIZE, false);
        for index in 0..ALL + 24 {
            let t = index as f32;
            let full = waves(SIZE, speed_px.map(|v| v * t));
            let px = [20.0 + t, 35.0 + 12.0 * (0.4 * t).sin()];
            let shot = Shot::planned(full.clone(), Gaze::At { px }).moving(speed_px);
            let mask = post.plan(index, &shot);
            let shown = post.one(index, &shot);
            assert_finite(&shown, &format!("frame {index}"));
            sampled = Image::from_fn(SIZE, |px| pixel(&sampled, px) || pixel(&mask, px));
            // A quad of which all is shaded is of the fovea.
            let is_fovea = |px: [u32; 2]| {
                let quad = px.map(|v| v & !1);
                pixels([2; 2]).all(|d| pixel(&mask, [0, 1].map(|i| (quad[i] + d[i]).min(SIZE[i] - 1))))
            };
            let off = |px: [u32; 2]| pixel(&shown, px) != pixel(&full, px);
            let fovea = pixels(SIZE).filter(|&px| is_fovea(px)).collect::<Vec<_>>();
            assert!(index == 0 || fovea.len() > 60, "frame {index}: {} pixels of the fovea", fovea.len());
            assert!(!fovea.iter().any(|&px| off(px)), "frame {index}: the fovea is the candidate");
            if index < ALL {
                continue;
            }
            if speed_px == [0.0; 2] {
                assert_eq!(wrong(&shown, &full, |px| pixel(&sampled, px)), 0, "frame {index}");
                continue;
            }
            let distance = |at: [u32; 2]| (at[0] as f32 - px[0]).hypot(at[1] as f32 - px[1]);
            let is_border = |at: [u32; 2]| (19.0..23.0).contains(&distance(at));
            let is_far = |at: [u32; 2]| distance(at) >= 23.0;
            let foveated = none(&Shot::masked(full.clone(), &mask));
            (0..2).for_each(|i| sums[i] += squared_error(&shown, &full, |px| [is_border(px), is_far(px)][i]));
            let errors = [&shown, &foveated].map(|c| psnr(squared_error(c, &full, is_border)));
            least = least.min(errors[0] - errors[1]);
        }
    }
    assert!(least > 0.0, "{least:.2} dB at borders");
    // At a seam, the error would exceed the error of the coarser side.
    let [seam, far] = sums;
    assert!(seam < far, "{seam} at borders, {far} in the periphery");
    Some(format!(
        "fovea bit for bit in {} frames; still: exact across borders wherever sampled; gliding: squared error at borders {:.2} of the periphery's, {least:+.1} dB against foveated at least",
        2 * (ALL + 24),
        seam / far
    ))
}
