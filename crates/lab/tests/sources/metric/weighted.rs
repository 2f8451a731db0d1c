//! Weighted error, Delta E 94 and ghosting against brute force and hand-calculated cases.

use super::{noise, score, source_frame};
use afterimage::Image;
use afterimage::kernel::color::srgb_decode;
use afterimage::kernel::lab::{delta_e94, lab};
use afterimage_lab::frame::SourceFrame;
use afterimage_lab::metric::{GHOST_FRAMES, Scores, error_weight};
use afterimage_testing::Draws;
use approx::assert_abs_diff_eq;
use glam::{DVec3, Vec3};

const SIZE: [u32; 2] = [160, 90];

/// Watson's cell density in f64, relative to the centre of the fovea.
fn weight64(e: f64) -> f64 {
    let density = |e: f64| (0.9851 / (1.0 + e / 1.058).powi(2) + 0.0149 * (-e / 22.14).exp()) / (1.0 + e / 41.03);
    density(e) / density(0.0)
}

#[test]
fn the_weighted_error_counts_cells() {
    let mut draws = Draws::new("weighted");
    let pairs: Vec<_> = (0..2).map(|_| [0; 2].map(|_: u32| noise(SIZE, &draws.uniform().to_string()))).collect();
    let gaze = [50.0, 60.0];
    let frame = |a: &Image<[f32; 3]>| source_frame(a.clone());
    let frames: Vec<_> = pairs.iter().map(|[a, b]| (a.clone(), b.clone(), frame(a))).collect();
    let scores = score(&frames, gaze, None);
    let tan = (35_f64.to_radians()).tan() / 80.0;
    let ray = |x: f64, y: f64| DVec3::new((x - 79.5) * tan, (y - 44.5) * tan, 1.0);
    let (mut sum, mut weights) = (0.0, 0.0);
    for [a, b] in &pairs {
        for (x, y) in (0..90).flat_map(|y| (0..160).map(move |x| (x, y))) {
            let e = ray(x as f64, y as f64).angle_between(ray(50.0, 60.0)).to_degrees();
            let (c, d) = (a.at(x, y), b.at(x, y));
            sum += weight64(e) * (0..3).map(|i| f64::from(c[i] - d[i]).powi(2)).sum::<f64>() / 3.0;
            weights += weight64(e);
        }
    }
    assert_abs_diff_eq!(scores.weighted_psnr_db.unwrap(), -10.0 * (sum / weights).log10(), epsilon = 1e-4);
    assert_abs_diff_eq!(error_weight(0.0), 1.0);
    assert_abs_diff_eq!(f64::from(error_weight(20.0)), weight64(20.0), epsilon = 1e-6);
    // The same error weighs more at the gaze.
    let grey = Image::filled(SIZE, [0.5; 3]);
    let spot = |x: usize| {
        let mut spot = grey.clone();
        spot.pixels_mut()[45 * 160 + x] = [0.6; 3];
        let scores = score(&[(grey.clone(), spot, frame(&grey))], [20.0, 45.0], None);
        (scores.weighted_psnr_db.unwrap(), scores.whole.psnr_db.unwrap())
    };
    let (near, far) = (spot(22), spot(140));
    assert_abs_diff_eq!(near.1, far.1, epsilon = 1e-9);
    assert!(far.0 > near.0 + 15.0, "{near:?} {far:?}");
}

#[test]
fn the_99th_percentile_is_that_of_sorting() {
    let (a, mut b) = (noise(SIZE, "p99 a"), noise(SIZE, "p99 b"));
    // Most pixels have small errors, so that the distribution has a tail.
    let mut draws = Draws::new("p99");
    for (p, q) in b.pixels_mut().iter_mut().zip(a.pixels()) {
        let share = draws.uniform().powi(6);
        *p = [0, 1, 2].map(|i| q[i] + share * (p[i] - q[i]));
    }
    let lab_of = |c: [f32; 3]| lab(Vec3::from(c.map(srgb_decode)));
    let mut sorted: Vec<f32> =
        a.pixels().iter().zip(b.pixels()).map(|(p, q)| delta_e94(lab_of(*p), lab_of(*q))).collect();
    sorted.sort_by(f32::total_cmp);
    let mean = sorted.iter().map(|&v| f64::from(v)).sum::<f64>() / sorted.len() as f64;
    let frame = source_frame(a.clone());
    let scores = score(&[(a.clone(), b, frame.clone())], [80.0, 45.0], None);
    let expected = f64::from(sorted[(0.99 * sorted.len() as f64).ceil() as usize - 1]);
    let got = scores.delta_e94_p99.unwrap();
    println!("99th percentile {got} against {expected}, mean {mean:.3}");
    assert!(got >= expected && got - expected <= 1.0 / 32.0 + 1e-6);
    assert_abs_diff_eq!(scores.delta_e94_mean.unwrap(), mean, epsilon = 1e-4);
    let exact = score(&[(a.clone(), a, frame)], [80.0, 45.0], None);
    assert_eq!((exact.delta_e94_mean, exact.delta_e94_p99, exact.weighted_psnr_db), (Some(0.0), Some(0.0), None));
}

/// A dark image that becomes bright at frame 3. The output keeps a share `keep` of its error in each frame.
fn after_a_change(keep: f32, frames: usize) -> Scores {
    let at = |v: f32| Image::filled(SIZE, [v; 3]);
    let mut shown = 0.2;
    let clip: Vec<_> = (0..frames)
        .map(|i| {
            let new = if i < 3 { 0.2 } else { 0.7 };
            shown = if i < 3 { new } else { new + keep * (shown - new) };
            (at(new), at(shown), SourceFrame { cut: i == 0, ..source_frame(at(new)) })
        })
        .collect();
    score(&clip, [80.0, 45.0], None)
}

#[test]
fn ghosts_fade_as_the_method_forgets() {
    // The share of the old color is keep^(age + 1).
    let scores = after_a_change(0.8, 3 + GHOST_FRAMES);
    let energy: f64 = (1..=GHOST_FRAMES as i32).map(|k| 0.64_f64.powi(k)).sum();
    assert_abs_diff_eq!(scores.ghost_energy.unwrap(), energy, epsilon = 1e-3);
    // 0.8^4 is the first at most half of 0.8, three frames later.
    assert_eq!(scores.ghost_half_frames, Some(4));
    // Output that follows at once has no ghosting; output that never follows keeps the old color.
    let scores = after_a_change(0.0, 20);
    assert_eq!((scores.ghost_energy, scores.ghost_half_frames), (Some(0.0), None));
    let scores = after_a_change(1.0, 3 + 20);
    assert_abs_diff_eq!(scores.ghost_energy.unwrap(), 20.0, epsilon = 1e-3);
    assert_eq!(scores.ghost_half_frames, None);
    // No change, and changes below the threshold.
    assert_eq!(after_a_change(0.5, 3).ghost_energy, None);
}

#[test]
fn ghosts_are_followed_along_motion_and_end_at_cuts() {
    // Stripes move right by 2 px a frame, and from frame 1 on a bright panel with them; the method never shows the
    // panel.
    let stripes = |x: u32, frame: u32| 0.35 + 0.15 * (0.4 * (x as f32 - 2.0 * frame as f32)).sin();
    let inside = |x: u32, y: u32, left: u32| (left..left + 20).contains(&x) && (40..50).contains(&y);
    let with_panel = |[x, y]: [u32; 2], i| if i > 0 && inside(x, y, 20 + 2 * i) { 0.9 } else { stripes(x, i) };
    let clip = |cut_at: u32| {
        let frame = |i: u32| {
            let without = Image::from_fn(SIZE, |[x, _]| [stripes(x, i); 3]);
            let with = Image::from_fn(SIZE, |px| [with_panel(px, i); 3]);
            let motion = Some(Image::filled(SIZE, [-2.0, 0.0]));
            let frame = SourceFrame { motion, cut: i == 0 || i == cut_at, ..source_frame(with.clone()) };
            (with, without, frame)
        };
        (0..6).map(frame).collect::<Vec<_>>()
    };
    let scores = score(&clip(9), [150.0, 10.0], None);
    assert_abs_diff_eq!(scores.ghost_energy.unwrap(), 5.0, epsilon = 1e-3);
    let scores = score(&clip(3), [150.0, 10.0], None);
    assert_abs_diff_eq!(scores.ghost_energy.unwrap(), 2.0, epsilon = 1e-3);
}

#[test]
fn what_moves_by_parts_of_pixels_has_not_changed() {
    let clip: Vec<_> = (0..4)
        .map(|i| {
            let wave = |x: u32| 0.5 + 0.35 * (0.4 * (x as f32 - 2.5 * i as f32)).sin();
            let reference = Image::from_fn(SIZE, |[x, _]| [wave(x); 3]);
            let motion = Some(Image::filled(SIZE, [-2.5, 0.0]));
            let frame = SourceFrame { motion, cut: i == 0, ..source_frame(reference.clone()) };
            (reference, Image::filled(SIZE, [0.5; 3]), frame)
        })
        .collect();
    assert_eq!(score(&clip, [150.0, 10.0], None).ghost_energy, None);
}
