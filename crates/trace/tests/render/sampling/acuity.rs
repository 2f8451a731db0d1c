//! Continuous density: number, position and timing of sampled pixels.

use afterimage::ViewGeometry;
use afterimage_trace::sampling::{Acuity, Regions, Sampling};

fn view() -> ViewGeometry {
    ViewGeometry::flat([640, 360], 90.0).unwrap()
}

#[test]
fn there_are_as_many_targets_as_expected_in_every_frame() {
    let acuity = Acuity::default();
    for gaze in [[320.0, 180.0], [40.0, 300.0]] {
        let expected = acuity.expected(&view(), gaze);
        for frame in 0..20 {
            let count = Sampling::Acuity(acuity).plan(&view(), gaze, 1, frame).samples()[0] as f64;
            // Much more even than independent draws, whose standard deviation is at most sqrt(expected).
            assert!((count - expected).abs() < 0.25 * expected.sqrt() + 20.0, "frame {frame}: {count} of {expected}");
        }
    }
}

/// Sampled pixels of a frame as a mask.
fn mask(share: f32, frame: u64) -> Vec<bool> {
    // No fovea and a floor of `share`: constant density.
    let acuity = Acuity { fovea_deg: 0.01, least: share, falloff: 1e3 };
    let plan = Sampling::Acuity(acuity).plan(&view(), [-1e4, -1e4], 1, frame);
    let mut mask = vec![false; 640 * 360];
    for [x, y] in plan.targets() {
        mask[(y * 640 + x) as usize] = true;
    }
    mask
}

#[test]
fn every_pixel_has_its_turn() {
    let share = 1.0 / 16.0;
    let (mut last, mut gap) = (vec![0_u64; 640 * 360], 0);
    for frame in 0..200 {
        for (last, _) in last.iter_mut().zip(mask(share, frame)).filter(|(_, is_sampled)| *is_sampled) {
            gap = gap.max(frame - *last);
            *last = frame;
        }
    }
    let longest = last.iter().map(|&f| 200 - f).max().unwrap().max(gap);
    // The golden ratio leaves no gap longer than a few times the mean.
    assert!(longest <= 48, "a pixel waited {longest} frames");
}

#[test]
fn targets_keep_their_distance() {
    // Counts in 8x8 squares vary less than a binomial, whose variance is n p (1 - p).
    for share in [1.0 / 16.0, 1.0 / 8.0, 0.3] {
        let mask = mask(share, 7);
        let square = |i: usize| (0..64).map(move |k| (i / 80 * 8 + k / 8) * 640 + i % 80 * 8 + k % 8);
        let counts: Vec<_> = (0..45 * 80).map(|i| square(i).filter(|&px| mask[px]).count() as f64).collect();
        let mean = counts.iter().sum::<f64>() / counts.len() as f64;
        let variance = counts.iter().map(|c| (c - mean) * (c - mean)).sum::<f64>() / counts.len() as f64;
        let by_chance = 64.0 * f64::from(share) * (1.0 - f64::from(share));
        println!("share {share}: variance {variance:.3}, by chance {by_chance:.3}");
        assert!(variance < 0.35 * by_chance, "share {share}: {variance} of {by_chance}");
    }
}

#[test]
fn the_fovea_is_sampled_in_full() {
    let plan = Sampling::Acuity(Acuity::default()).plan(&view(), [320.0, 180.0], 1, 3);
    let targets: std::collections::HashSet<[u32; 2]> = plan.targets().collect();
    let mut pixels = 0;
    for (y, x) in (170..190).flat_map(|y| (310..330).map(move |x| (y, x))) {
        if view().eccentricity_deg([x as f32, y as f32], [320.0, 180.0]) <= Acuity::default().fovea_deg {
            assert!(targets.contains(&[x, y]), "{x}, {y}");
            pixels += 1;
        }
    }
    assert!(pixels > 60, "{pixels}");
}

#[test]
fn it_takes_as_many_samples_as_the_papers_regions() {
    let view = ViewGeometry::flat([640, 360], 70.0).unwrap();
    let count = |sampling: Sampling| sampling.plan(&view, [319.5, 179.5], 32, 0).samples().iter().sum::<u64>() as f64;
    let (regions, acuity) = (count(Sampling::Regions(Regions::default())), count(Sampling::Acuity(Acuity::default())));
    println!("regions {regions}, acuity {acuity}");
    assert!((acuity / regions - 1.0).abs() < 0.05);
}
