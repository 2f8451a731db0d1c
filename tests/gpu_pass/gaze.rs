//! Where the eye looks, on the device: hard cases H61 to H66.

use super::rig::{Rig, View, noise};
use afterimage::display::ViewGeometry;
use afterimage::foveation::Foveation;
use afterimage::frame::{ContextDesc, Gaze, Reset};
use afterimage::image::Image;
use afterimage::settings::Settings;

const SIZE: [u32; 2] = [64, 48];

#[test]
fn h61_h62_h64_h65_weights_follow_rays_in_any_view() {
    // As wide as 170 degrees, one eye of a headset, a fovea of nothing, an eye in a corner.
    let views = [
        ViewGeometry::flat(SIZE, 110.0).unwrap(),
        ViewGeometry::flat(SIZE, 170.0).unwrap(),
        ViewGeometry::flat(SIZE, 1.0).unwrap(),
        ViewGeometry::off_axis(SIZE, [-1.2, 0.9], [-1.1, 1.1]).unwrap(),
    ];
    for fovea_deg in [0.0, 5.0] {
        let foveation = Foveation { fovea_deg, ..Foveation::default() };
        let settings = Settings { gate: None, foveation, ..Settings::paper() };
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
}

#[test]
fn h66_a_saccade_keeps_the_old_fovea() {
    let Some(mut rig) = Rig::new(ContextDesc::new(SIZE), Settings { gate: None, ..Settings::paper() }) else {
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
}
