//! Places of samples: their order, and the weight of a sample beside a pixel.

use afterimage::kernel::lattice::*;
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
