//! Shaded quads around a quad: octants, rows and codes of neighbours.

use afterimage::kernel::quads::{NOWHERE, first_of, last_of, neighbour, neighbour_offset, octant_offsets, window};

#[test]
fn octants_are_those_of_angles() {
    for (x, y) in (1..9).flat_map(|x| (1..9).map(move |y| (x, y))) {
        let angle = f64::from(y).atan2(f64::from(x)) / std::f64::consts::FRAC_PI_4;
        let [vertical, horizontal] = octant_offsets(y);
        let octant = if x <= vertical {
            2
        } else if x >= horizontal {
            0
        } else {
            1
        };
        assert_eq!(octant, angle.round() as i32, "{x}, {y}");
    }
}

#[test]
fn rows_are_searched_from_both_sides() {
    // Offsets -8, -3, 0, 7.
    let all = window(0b1000_0001_0010_0001 << 5, 16 + 5);
    let at = |code: u32, y: i32| {
        (code != u32::MAX).then(|| neighbour_offset(code & 255)).inspect(|o| assert_eq!(o[1], y)).map(|o| o[0])
    };
    for (low, high, first, last) in [
        (-8, 7, Some(-8), Some(7)),
        (-7, 6, Some(-3), Some(0)),
        (1, 7, Some(7), Some(7)),
        (1, 6, None, None),
        (8, 7, None, None),
        (20, 7, None, None),
        (-8, -20, None, None),
    ] {
        assert_eq!((at(first_of(all, low, high, 2), 2), at(last_of(all, low, high, -4), -4)), (first, last));
    }
}

#[test]
fn nearer_neighbours_have_smaller_codes() {
    let all: Vec<_> = (-8..8).flat_map(|x| (-8..8).map(move |y| (x, y))).collect();
    for &(x, y) in &all {
        assert_eq!(neighbour_offset(neighbour(x, y)), [x, y]);
        for &(u, v) in all.iter().filter(|(u, v)| u * u + v * v < x * x + y * y) {
            assert!(neighbour(u, v) < neighbour(x, y));
        }
    }
    assert_eq!(neighbour_offset(NOWHERE), [0, 0]);
}
