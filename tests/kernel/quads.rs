//! Shaded quads around a quad: octants, rows and codes of neighbours.

use afterimage::kernel::quads::{
    KEYS, MOST_PATHS, NOWHERE, first_of, known_samples, last_of, neighbour, neighbour_offset, octant_offsets, path_key,
    paths, window,
};
use afterimage_testing::Draws;
use std::collections::HashSet;

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

/// Keys of further paths fall by what each takes off the error of a mean: V / ((n + k - 1)(n + k)).
#[test]
fn further_paths_bring_less() {
    for samples in 1..=31 {
        let gain = |path: u32| 1.0 / f64::from((samples + path - 1) * (samples + path));
        for path in 1..=MOST_PATHS {
            let halves = (2.0 * (gain(1) / gain(path)).log2() + 1e-12).floor() as u32;
            let key = 50 << 8 | 77;
            assert_eq!(path_key(key, samples, path), key - (halves << 8), "{samples}, {path}");
            // A key that would fall below the smallest one is none.
            assert_eq!(path_key(halves << 8 | 77, samples, path), 0);
            assert_eq!(path_key((halves + 1) << 8 | 77, samples, path), 1 << 8 | 77);
        }
    }
    assert_eq!([0.0, 1.9, 17.0, 1e9].map(known_samples), [1, 1, 17, 31]);
}

/// A pixel gets a path for each of its keys that reaches the threshold.
#[test]
fn paths_are_keys_from_the_threshold_on() {
    let mut draws = Draws::new("paths");
    let mut seen = HashSet::new();
    for _ in 0..20_000 {
        let further = draws.bits() % KEYS;
        let first = if draws.bits().is_multiple_of(4) { 0 } else { further + draws.bits() % (KEYS - further) };
        let (samples, threshold) = (1 + draws.bits() % 31, 1 + draws.bits() % KEYS);
        let keys = [first].into_iter().chain((2..=MOST_PATHS).map(|path| path_key(further, samples, path)));
        let count = keys.clone().filter(|&key| key >= threshold).count() as u32;
        assert_eq!(paths(first, further, samples, false, threshold), count);
        let of_even = keys.skip(1).filter(|&key| key >= threshold).count() as u32;
        assert_eq!(paths(0, further, samples, true, threshold), of_even + 1);
        seen.insert(count);
    }
    assert_eq!(seen.len() as u32, MOST_PATHS + 1);
}
