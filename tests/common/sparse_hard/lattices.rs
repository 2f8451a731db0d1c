//! Where the samples lie: positions that are never sampled, odd lattices, borders between rates.

use super::*;
use afterimage::Lattice;

/// A gaze that jumps with the parity of the order: some positions are in a lattice only in frames in which it samples
/// others.
pub fn starved_positions(make: Make) -> Option<String> {
    const FRAMES: u64 = 4 * TURN;
    let gaze_px = |index: u64| [if index.is_multiple_of(2) { 26.0 } else { 62.0 }, 35.0];
    let shot = |index| Shot::foveated(waves(SIZE, [0.0; 2]), &foveation(), gaze_px(index), index);
    let shots: Vec<_> = (0..FRAMES).map(shot).collect();
    let is_starved = |px: [u32; 2]| shots.iter().all(|shot| !shot.lattices().at(px).unwrap().samples(px));
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

/// Degenerate lattices.
pub fn degenerate_lattices(make: Make) -> Option<String> {
    let far = |offset| Lattice::covering(8, [0, 0], SIZE, offset);
    let stack = |lattices: &[Lattice]| Lattices::new(lattices).unwrap();
    let one = |step, first_px| Lattice { step, first_px, points: [1, 1], atlas_texel: None };
    let full = noise(SIZE, "degenerate");
    let cases = [
        ("a step larger than the view", stack(&[Lattice::covering(128, [0, 0], SIZE, [50, 20])])),
        ("the largest step", stack(&[Lattice::covering(256, [0, 0], SIZE, [0, 69])])),
        ("a lattice of one pixel", stack(&[one(1, [40, 30]), far([3, 6])])),
        ("one sample in the last corner", stack(&[one(2, [93, 69]), far([0, 0])])),
        (
            "three of one pixel above each other",
            stack(&[one(1, [40, 30]), one(2, [40, 30]), one(4, [41, 30]), far([7, 7])]),
        ),
        ("an empty rectangle", stack(&[Lattice::covering(2, [10, 10], [10, 10], [1, 1]), far([2, 1])])),
    ];
    for (name, lattices) in cases {
        for at_samples in [false, true] {
            let mut post = make(smr(SIZE))?;
            let lattices = if at_samples { lattices.with_geometry_at_samples() } else { lattices };
            let shot = Shot::new(full.clone(), lattices).with(|view| view.depth = Some(Image::filled(SIZE, 3.0)));
            let shot = shot.moving([0.0; 2]);
            for index in 0..3 {
                let shown = post.one(index, &shot);
                assert_finite(&shown, name);
                let mut samples = 0;
                for px in pixels(SIZE).filter(|&px| lattices.at(px).unwrap().samples(px)) {
                    let (a, b) = (pixel(&shown, px), pixel(&full, px));
                    let rounding = if index == 0 { 0.0 } else { 1.0 / 511.0 };
                    assert!((0..3).all(|c| (a[c] - b[c]).abs() <= rounding), "{name}: {a:?} instead of {b:?}");
                    samples += 1;
                }
                assert!(samples > 0, "{name}");
            }
        }
    }
    // A finer lattice off the view changes nothing.
    let beyond = Lattice::covering(2, [200, 300], [240, 320], [1, 0]);
    let (mut with, mut without) = (make(smr(SIZE))?, make(smr(SIZE))?);
    for index in 0..3 {
        let offset = [index as u32, 2];
        let shot = |lattices: &[Lattice]| Shot::new(full.clone(), stack(lattices));
        assert_eq!(with.one(index, &shot(&[beyond, far(offset)])), without.one(index, &shot(&[far(offset)])));
    }
    // Frames without any sample: black at first, then what was shown.
    let nothing = Shot::new(full.clone(), stack(&[Lattice::covering(256, [0, 0], SIZE, [200, 100])]));
    let mut post = make(smr(SIZE))?;
    assert!(post.one(0, &nothing).pixels().iter().all(|&c| c == [0.0; 3]));
    let last = post.one(1, &Shot::new(full.clone(), stack(&[far([3, 3])])));
    for index in 2..6 {
        assert_eq!(wrong(&post.one(index, &nothing), &last, everywhere), 0);
    }
    // A view of one pixel.
    let mut post = make(smr([1, 1]))?;
    let dot = noise([1, 1], "dot");
    for index in 0..4 {
        let shown = post.one(index, &Shot::foveated(dot.clone(), &foveation(), [0.0, 0.0], index));
        assert_eq!(wrong(&shown, &dot, everywhere), 0);
    }
    for empty in [[0, 1], [1, 0], [0, 0]] {
        assert!(Lattices::new(&[Lattice { points: empty, ..far([0, 0]) }]).is_err());
    }
    Some(format!(
        "{} stacks: samples shown bit for bit, off the view no effect, without a sample the last frame again; no points: refused",
        cases.len()
    ))
}

/// Pixels with a neighbour of another lattice within two pixels to the right or below.
fn border(lattices: Lattices) -> Image<bool> {
    let step = |[x, y]: [u32; 2]| lattices.at([x.min(SIZE[0] - 1), y.min(SIZE[1] - 1)]).unwrap().step;
    Image::from_fn(SIZE, |[x, y]| (1..3).any(|i| step([x + i, y]) != step([x, y]) || step([x, y + i]) != step([x, y])))
}

/// The fovea, and the borders between rates, on a picture that glides while the gaze wanders.
pub fn borders(make: Make) -> Option<String> {
    let mut least = f64::INFINITY;
    let mut sums = [0.0; 4];
    for speed_px in [[0.0; 2], [0.3, -0.2]] {
        let mut post = make(smr(SIZE))?;
        let mut sampled = Image::filled(SIZE, false);
        for index in 0..40 {
            let t = index as f32;
            let full = waves(SIZE, speed_px.map(|v| v * t));
            let gaze = [20.0 + 1.5 * t, 35.0 + 12.0 * (0.4 * t).sin()];
            let shot = Shot::foveated(full.clone(), &foveation(), gaze, index).moving(speed_px);
            let shown = post.one(index, &shot);
            assert_finite(&shown, &format!("frame {index}"));
            let lattices = shot.lattices();
            let is_sample = |px: [u32; 2]| lattices.at(px).unwrap().samples(px);
            sampled = Image::from_fn(SIZE, |px| pixel(&sampled, px) || is_sample(px));
            let is_fovea = |px: [u32; 2]| lattices.at(px).unwrap().step == 1;
            assert_eq!(squared_error(&shown, &full, is_fovea), 0.0, "frame {index}: the fovea is the candidate");
            if index < TURN {
                continue;
            }
            let border = border(lattices);
            let is_border = |px: [u32; 2]| pixel(&border, px);
            if speed_px == [0.0; 2] {
                let was_sampled = |px: [u32; 2]| pixel(&sampled, px);
                assert_eq!(wrong(&shown, &full, was_sampled), 0, "frame {index}");
                continue;
            }
            let far = |px: [u32; 2]| !is_border(px) && lattices.at(px).unwrap().step == 4;
            let foveated = none(&shot);
            let errors = [
                squared_error(&shown, &full, is_border),
                squared_error(&foveated, &full, is_border),
                squared_error(&shown, &full, far),
                squared_error(&foveated, &full, far),
            ];
            (0..4).for_each(|i| sums[i] += errors[i]);
            least = least.min(psnr(errors[0]) - psnr(errors[1]));
        }
    }
    let [seam, _, far, _] = sums;
    assert!(least > 0.0, "{least:.2} dB at borders");
    // At a seam, the error would exceed the error of the coarser side.
    assert!(seam < far, "{seam} at borders, {far} in the periphery");
    Some(format!(
        "fovea bit for bit in 80 frames; still: exact across borders wherever sampled; gliding: squared error at borders {:.2} of the periphery's, {least:+.1} dB against foveated at least",
        seam / far
    ))
}
