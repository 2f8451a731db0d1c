//! Gaze and eccentricity on the device: hard cases H61 to H66.

use super::rig::{Rig, View, noise};
use crate::settings::ungated;
use afterimage::{ContextDesc, Foveation, Gaze, Image, Method, MethodKind, Reset, Settings, Smr, ViewGeometry};
use afterimage_testing::holds;

const SIZE: [u32; 2] = [64, 48];

#[test]
fn h61_h62_h64_h65_weights_follow_rays_in_any_view() {
    // 170 degrees wide, one eye of a headset, a fovea of 0 degrees, a gaze in a corner.
    let views = [
        ViewGeometry::flat(SIZE, 110.0).unwrap(),
        ViewGeometry::flat(SIZE, 170.0).unwrap(),
        ViewGeometry::flat(SIZE, 1.0).unwrap(),
        ViewGeometry::off_axis(SIZE, [-1.2, 0.9], [-1.1, 1.1]).unwrap(),
    ];
    let (mut only, mut floor, mut worst_rad) = (0, f32::MAX, 0.0_f64);
    for fovea_deg in [0.0, 5.0] {
        let foveation = Foveation { fovea_deg, ..Foveation::default() };
        let settings = Settings { foveation, ..ungated() };
        for geometry in views {
            let Some(mut rig) = Rig::new(ContextDesc::new(SIZE), settings) else { return };
            for (index, px) in (0..).zip([[31.0, 23.0], [1.0, 2.0], [63.0, 47.0], [-40.0, 200.0]]) {
                let mut view = View::still(noise(SIZE, &format!("wide {index}")), px);
                view.facts.geometry = geometry;
                let (_, trace) = rig.both(index, Reset::None, &[view]);
                let weight = |x: usize, y: usize| trace[0].at(x, y).weight;
                let lowest = trace[0].pixels().iter().map(|t| t.weight).fold(1.0, f32::min);
                println!(
                    "fovea {fovea_deg}, {:.0} degrees, eye at {px:?}: lowest weight {lowest:.1e}",
                    geometry.hfov_deg()
                );
                assert!(trace[0].pixels().iter().all(|t| t.weight.is_normal() && t.weight <= 1.0));
                if fovea_deg == 5.0 {
                    floor = floor.min(lowest);
                } else if index < 3 {
                    // 1 at the gaze point, and nowhere else.
                    assert_eq!(trace[0].pixels().iter().filter(|t| t.weight == 1.0).count(), 1);
                    only += 1;
                }
                // Angles from weights, by bisection in f64, for a fovea of 0 degrees, where weights fall everywhere.
                if fovea_deg == 0.0 {
                    for (i, t) in trace[0].pixels().iter().enumerate().step_by(97) {
                        let [g, r] = [px, [(i % 64) as f32, (i / 64) as f32]]
                            .map(|p| glam::DVec3::from(geometry.ray(p).map(f64::from)));
                        let exact = r.cross(g).length().atan2(r.dot(g));
                        let (mut low, mut high) = (0.0_f64, 180.0_f64);
                        for _ in 0..60 {
                            let middle = 0.5 * (low + high);
                            let above = density64(middle) / density64(0.0) > f64::from(t.weight);
                            (low, high) = if above { (middle, high) } else { (low, middle) };
                        }
                        worst_rad = worst_rad.max((low.to_radians() - exact).abs());
                    }
                }
                if index < 3 {
                    let at = px.map(|v| v as usize);
                    assert_eq!(weight(at[0], at[1]), 1.0, "{geometry:?}");
                }
                let row: Vec<f32> = (32..64).map(|x| weight(x, 47)).collect();
                let falls = row.windows(2).all(|w| w[1] <= w[0]);
                assert!(index != 1 || falls, "to the right of an eye on the left: {row:?}");
            }
        }
    }
    println!("angles off by {worst_rad:.1e} rad, lowest weight {floor:.1e}");
    assert!(worst_rad < 1e-6, "{worst_rad}");
    assert!(floor > 6.1e-5, "{floor}");
    holds!(
        "H61",
        Gpu,
        "views of 1 to 170 degrees: angles read back from weights are off by {worst_rad:.1e} rad at the most"
    );
    holds!(
        "H64",
        Gpu,
        "r_f = 0: weight 1 at the gaze point alone, of 3072 pixels, in {only} frames; all normal and above 0"
    );
    holds!(
        "H65",
        Gpu,
        "5 degrees of fovea, to 170 degrees of view: lowest weight {floor:.1e}, a half's least normal is 6.1e-5"
    );
}

/// Watson's density in f64, up to constant factors.
fn density64(e_deg: f64) -> f64 {
    (0.9851 / (1.0 + e_deg / 1.058).powi(2) + 0.0149 * (-e_deg / 22.14).exp()) / (1.0 + e_deg / 41.03)
}

#[test]
fn the_gaze_of_the_next_frame_is_known_before_it() {
    let at = |px| Gaze::At { px };
    for method in MethodKind::ALL {
        let settings = Settings { method: method.into(), ..Settings::paper() };
        let Some(mut rig) = Rig::new(ContextDesc::new(SIZE), settings) else { return };
        let geometry = View::still(noise(SIZE, "gaze"), [0.0; 2]).facts.geometry;
        let known = |rig: &Rig, gaze| {
            let (cpu, gpu) = (rig.cpu.gaze_px(0, &geometry, gaze), rig.gpu.gaze_px(0, &geometry, gaze));
            assert_eq!(cpu, gpu, "{method:?}");
            cpu
        };
        assert_eq!(known(&rig, Gaze::Lost), [31.5, 23.5]);
        let steps = [
            (at([9.0, 8.0]), Reset::None, [9.0, 8.0]),
            (Gaze::Lost, Reset::None, [9.0, 8.0]),
            (Gaze::Uv { uv: [0.5, 0.25] }, Reset::None, [31.5, 11.5]),
            // A cut is no reason to forget where the eye looks.
            (Gaze::Lost, Reset::All, [31.5, 11.5]),
        ];
        for (index, (gaze, reset, expected)) in (0..).zip(steps) {
            assert_eq!(known(&rig, gaze), expected, "{method:?}, frame {index}");
            let mut view = View::still(noise(SIZE, "gaze"), [0.0; 2]);
            view.facts.gaze = gaze;
            rig.both(index, reset, &[view]);
        }
        rig.cpu.forget();
        rig.gpu.forget();
        assert_eq!(known(&rig, Gaze::Lost), [31.5, 23.5]);
    }
}

#[test]
fn h63_a_lost_gaze_is_held_then_centred_at_the_start() {
    let at = |px| Gaze::At { px };
    let weights = |gazes: &[Gaze]| -> Option<Vec<f32>> {
        let mut rig = Rig::new(ContextDesc::new(SIZE), Settings::paper())?;
        let mut weights = vec![];
        for (index, &gaze) in (0..).zip(gazes) {
            let mut view = View::still(noise(SIZE, "gaze"), [0.0; 2]);
            view.facts.gaze = gaze;
            let (_, trace) = rig.both(index, Reset::None, &[view]);
            weights = trace[0].pixels().iter().map(|t| t.weight).collect();
            assert!(weights.iter().all(|w| w.is_finite() && *w > 0.0));
        }
        Some(weights)
    };
    let Some(there) = weights(&[at([9.0, 9.0])]) else { return };
    assert_eq!(weights(&[at([9.0, 9.0]), Gaze::Lost, Gaze::Lost]).as_ref(), Some(&there));
    assert_eq!(weights(&[at([9.0, 9.0]), at([f32::NAN, 3.0]), at([f32::INFINITY, 3.0])]).as_ref(), Some(&there));
    assert_eq!(weights(&[Gaze::Lost]), weights(&[at([31.5, 23.5])]));
    assert_ne!(weights(&[at([-5000.0, 1e30])]), Some(there));
    // smr: its output depends on the held gaze.
    let shown = |gazes: &[Gaze]| -> Option<Vec<_>> {
        let mut rig =
            Rig::new(ContextDesc::new(SIZE), Settings { method: Method::Smr(Smr::default()), ..Settings::paper() })?;
        let frame = |(index, &gaze): (usize, &Gaze)| {
            let mut view = View::still(noise(SIZE, &format!("gaze {index}")), [0.0; 2]);
            view.facts.gaze = gaze;
            rig.both(index as u64, Reset::None, &[view]).0.shown
        };
        Some(gazes.iter().enumerate().map(frame).collect())
    };
    let known = shown(&[at([31.5, 23.5]), at([9.0, 9.0]), at([9.0, 9.0]), at([9.0, 9.0])]);
    assert!(shown(&[Gaze::Lost, at([9.0, 9.0]), Gaze::Lost, at([3.0, f32::NAN])]) == known);
    holds!(
        "H63",
        Gpu,
        "wrs and smr: lost, NaN and infinite are held, the middle before any; 1e30 px off: weights finite"
    );
}

#[test]
fn h66_a_saccade_keeps_the_old_fovea() {
    let Some(mut rig) = Rig::new(ContextDesc::new(SIZE), ungated()) else {
        return;
    };
    let sharp = noise(SIZE, "sharp");
    for index in 0..18 {
        rig.both(index, Reset::None, &[View::still(sharp.clone(), [10.0, 24.0])]);
    }
    let (made, _) = rig.both(18, Reset::None, &[View::still(Image::filled(SIZE, [0.5; 3]), [55.0, 24.0])]);
    let old_fovea = (5..15).flat_map(|x| (20..28).map(move |y| (x, y)));
    let kept = old_fovea.filter(|&(x, y)| made.shown[y * 64 + x] == sharp.at(x, y).map(f32::to_bits)).count();
    assert!(kept >= 78, "{kept} of 80 sharp samples kept the first frame after");
    // Decay: sums and survival of a pixel in f64, 18 candidates of weight 1 and then those of its new eccentricity.
    let geometry = ViewGeometry::flat(SIZE, 70.0).unwrap();
    let fovea: Vec<usize> = (0..64 * 48)
        .filter(|i| geometry.eccentricity_deg([(i % 64) as f32, (i / 64) as f32], [10.0, 24.0]) < 2.5)
        .collect();
    let weight = |i: usize| {
        let e = geometry.eccentricity_deg([(i % 64) as f32, (i / 64) as f32], [55.0, 24.0]);
        (density64(e.into()) / density64(2.5)).min(1.0)
    };
    let mut sums = vec![(0..17).fold(1.0_f64, |a, _| a * a / (a + 1.0) + 1.0); fovea.len()];
    let mut alive = vec![1.0; fovea.len()];
    let (mut kept, frames) = (0, 150);
    for n in 1..=frames {
        let view = View::still(noise(SIZE, &format!("after {n}")), [55.0, 24.0]);
        let trace = if n == 1 { None } else { Some(rig.both(17 + n, Reset::None, &[view]).1) };
        for ((a, s), &i) in sums.iter_mut().zip(&mut alive).zip(&fovea) {
            *a = *a * *a / (*a + weight(i)) + weight(i);
            *s *= 1.0 - weight(i) / *a;
        }
        let Some(trace) = trace else { continue };
        kept = fovea.iter().filter(|&&i| u64::from(trace[0].pixels()[i].age) >= n).count();
    }
    let (mean, variance) = alive.iter().fold((0.0, 0.0), |(m, v), s| (m + s, v + s * (1.0 - s)));
    afterimage_testing::accept(
        "150 frames after",
        afterimage_testing::p_of_z((kept as f64 - mean) / f64::sqrt(variance)),
    );
    holds!(
        "H66",
        Gpu,
        "wrs: {kept} of {} px of the old fovea left {frames} frames after, by theory {mean:.1}",
        fovea.len()
    );
}
