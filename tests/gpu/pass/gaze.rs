//! Gaze and eccentricity on the device: hard cases H61 to H66.

use super::*;
use crate::gaze_hard::*;
use crate::images::pixel;

gaze_laws!(Gpu, run_law);

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
                let weights = trace[0].map(|t| t.weight);
                let lowest = weights.pixels().iter().copied().fold(1.0, f32::min);
                let hfov_deg = geometry.hfov_deg();
                println!("fovea {fovea_deg}, {hfov_deg:.0} degrees, eye at {px:?}: lowest weight {lowest:.1e}");
                assert!(weights.pixels().iter().all(|w| w.is_normal() && *w <= 1.0));
                if fovea_deg == 5.0 {
                    floor = floor.min(lowest);
                } else if index < 3 {
                    // 1 at the gaze point, and nowhere else.
                    assert_eq!(weights.pixels().iter().filter(|w| **w == 1.0).count(), 1);
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
                assert!(index == 3 || pixel(&weights, px.map(|v| v as u32)) == 1.0, "{geometry:?}");
                let row: Vec<f32> = (32..64).map(|x| weights.at(x, 47)).collect();
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
        rig.forget();
        assert_eq!(known(&rig, Gaze::Lost), [31.5, 23.5]);
    }
}
