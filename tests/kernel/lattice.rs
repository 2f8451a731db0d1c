//! Lattices of sparse frames: the order of the samples, the regions they cover, and the samples around a pixel.

use afterimage::kernel::lattice::*;
use afterimage::{Foveation, Lattice, Lattices, ViewGeometry};
use afterimage_testing::Draws;
use glam::Vec2;
use std::collections::HashSet;

#[test]
fn every_pixel_is_sampled_once_in_a_turn() {
    for step in [1, 2, 4, 8, 16] {
        let turn = u64::from(step * step);
        let mut seen = HashSet::new();
        for index in 0..turn {
            let offset = offset_px(index, step);
            assert!(offset[0] < step && offset[1] < step);
            assert!(seen.insert(offset), "step {step}: {offset:?} twice");
            assert_eq!(offset, offset_px(index + turn, step));
        }
    }
    // Four frames are one sample in each quarter of the block.
    let quarters: HashSet<_> = (0..4).map(|i| offset_px(i, 8).map(|v| v / 4)).collect();
    assert_eq!(quarters.len(), 4);
}

#[test]
fn lattices_cover_the_view_and_their_regions() {
    let geometry = ViewGeometry::flat([480, 270], 70.0).unwrap();
    let foveation = Foveation { rate_mid: 2, rate_far: 4, ..Foveation::default() };
    for gaze in [[240.0, 135.0], [3.0, 200.0], [479.0, 269.0], [-900.0, 5000.0]] {
        for index in 0..16 {
            let lattices = foveation.lattices(&geometry, gaze, index);
            for y in 0..270 {
                for x in 0..480 {
                    let e_deg = geometry.eccentricity_deg([x as f32, y as f32], gaze);
                    let step = lattices.at([x, y]).expect("the view is covered").step;
                    let needed = match e_deg {
                        ..=2.49 => 1,
                        ..=7.49 => 2,
                        _ => 4,
                    };
                    assert!(step <= needed, "{gaze:?}: ({x}, {y}) at {e_deg} degrees has step {step}");
                }
            }
        }
    }
}

#[test]
fn the_largest_atlas_holds_every_gaze_and_is_not_much_larger() {
    let mut draws = Draws::new("largest atlas");
    let views = [
        ViewGeometry::flat([640, 360], 70.0).unwrap(),
        ViewGeometry::from_angles([800, 800], [-0.785, 0.785, 0.785, -0.785]).unwrap(),
        ViewGeometry::from_angles([723, 811], [-0.95, 0.70, 0.80, -0.90]).unwrap(),
        ViewGeometry::flat([33, 7], 120.0).unwrap(),
        ViewGeometry::off_axis([400, 300], [0.2, 1.5], [-0.1, 0.9]).unwrap(),
    ];
    let foveations = [(5.0, 15.0, 8, 16), (10.0, 30.0, 2, 4), (0.0, 20.0, 2, 4), (12.0, 20.0, 1, 2), (0.0, 0.0, 4, 4)];
    for geometry in views {
        for (fovea_deg, mid_deg, rate_mid, rate_far) in foveations {
            let foveation = Foveation { fovea_deg, mid_deg, rate_mid, rate_far, ..Foveation::default() };
            let bound = foveation.max_atlas_px(&geometry);
            let size = geometry.size_px();
            let mut largest = [0, 0];
            for i in 0..4000 {
                // In the view, on its edges, and around it.
                let gaze = [0, 1].map(|axis| {
                    let s = size[axis] as f32;
                    [draws.range(-0.5 * s, 1.5 * s), draws.range(0.0, s), -0.5, s - 0.5][draws.bits() as usize % 4]
                });
                let atlas = foveation.lattices(&geometry, gaze, i).in_atlas().1;
                assert!((0..2).all(|i| atlas[i] <= bound[i]), "{gaze:?}: {atlas:?} of {bound:?}");
                largest = [0, 1].map(|i| largest[i].max(atlas[i]));
            }
            println!("{size:?}, {fovea_deg} and {mid_deg} degrees: {bound:?}, used {largest:?}");
            // Lattices of different gazes are largest, and some pixels are for what lies between the gazes tried.
            let slack = [0, 1].map(|i| bound[i] as f32 - 1.2 * largest[i] as f32);
            assert!(slack.iter().all(|&v| v <= 6.0), "{bound:?} where {largest:?} were used");
        }
    }
}

#[test]
fn stacks_that_cannot_be_are_refused() {
    let of = |step| Lattice::covering(step, [0, 0], [64, 48], [0, 0]);
    let refusal = |stack: &[Lattice]| Lattices::new(stack).unwrap_err().setting;
    assert_eq!(refusal(&[]), "lattices");
    assert_eq!(refusal(&[of(1), of(2), of(4), of(8), of(16)]), "lattices");
    assert_eq!(refusal(&[Lattice { step: 3, ..of(4) }]), "lattice step");
    assert_eq!(refusal(&[of(512)]), "lattice step");
    assert_eq!(refusal(&[of(4), of(2)]), "lattice step");
    assert_eq!(refusal(&[of(4), of(4)]), "lattice step");
    assert_eq!(refusal(&[Lattice { points: [0, 4], ..of(4) }]), "lattice points");
    assert_eq!(refusal(&[Lattice { points: [4, u32::MAX], ..of(4) }]), "lattice points");
    assert_eq!(refusal(&[Lattice { first_px: [0, u32::MAX], ..of(4) }]), "lattice first_px");
    assert_eq!(refusal(&[of(2), Lattice { atlas_texel: Some([0, 0]), ..of(4) }]), "lattice atlas_texel");
    let (atlas, size) = Lattices::new(&[of(2), of(8)]).unwrap().in_atlas();
    assert_eq!(size, [32, 24 + 6]);
    assert_eq!(atlas.as_slice()[1].atlas_texel, Some([0, 24]));
}

#[test]
fn the_weight_of_a_place_is_a_power_of_two_near_its_closed_form() {
    assert_eq!(place_weight(Vec2::ZERO), 1.0);
    let mut checked = 0;
    for y in -300..=300 {
        for x in -300..=300 {
            let weight = place_weight(Vec2::new(x as f32, y as f32));
            let inverse = 1.0 + 8.0 * f64::from(x * x + y * y);
            // The exponent is rounded down four at a time, and limited.
            let ratio = f64::from(weight) * inverse.powi(4);
            assert!((1.0..16.0).contains(&ratio) || weight == (-40.0_f32).exp2(), "({x}, {y}): {weight}");
            assert_eq!(weight.to_bits() & 0x007f_ffff, 0, "({x}, {y}): {weight} is no power of two");
            checked += u32::from(weight > (-40.0_f32).exp2());
        }
    }
    assert!(checked > 300, "{checked} places below the limit");
}
