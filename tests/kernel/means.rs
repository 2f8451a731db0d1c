//! Means of jittered samples: their storage, and runs of samples on one side.

use afterimage::kernel::antialias::{Mean, count_in_run, mean_of, next_run, stored_lod, with_regular_run};

const DEVIATION: f32 = 25.0;
const SAMPLES: f32 = 16.0;
/// Level of a region that an even pattern visits every 8 frames.
const REGULAR: u32 = 2;

#[test]
fn every_stored_mean_is_stored_again_as_it_is() {
    for code in 0..240 {
        let stored = code as f32 * (1.0 / 7.0);
        assert_eq!(stored_lod(mean_of(stored), [0.5; 2]), stored, "code {code}");
    }
}

/// Samples in a mean of [`SAMPLES`] after more of them, brighter or darker by `difference`.
fn samples_after(are_brighter: &[bool], difference: f32, level: u32) -> f32 {
    let start = Mean { samples: SAMPLES, deviation: DEVIATION, ..Mean::ONE };
    let last = are_brighter.iter().fold(start, |past, &is_brighter| {
        let past = with_regular_run(past, level);
        let run = next_run(past, is_brighter, difference);
        Mean { samples: count_in_run(past.samples, past, run) + 1.0, run, ..past }
    });
    last.samples
}

#[test]
fn a_run_on_one_side_leaves_a_mean_of_the_run_alone() {
    for is_brighter in [false, true] {
        assert_eq!(samples_after(&[is_brighter; 2], DEVIATION, REGULAR), SAMPLES + 2.0);
        assert_eq!(samples_after(&[is_brighter; 6], DEVIATION, REGULAR), 4.0);
    }
}

#[test]
fn no_run_loses_no_sample() {
    let [alternating, in_pairs] = [1, 2].map(|n| (0..12).map(|i| i / n % 2 == 0).collect::<Vec<_>>());
    for sides in [alternating, in_pairs] {
        assert_eq!(samples_after(&sides, DEVIATION, REGULAR), SAMPLES + 12.0);
    }
    // Near the mean, and where samples come irregularly.
    assert_eq!(samples_after(&[true; 12], 0.6 * DEVIATION, REGULAR), SAMPLES + 12.0);
    assert_eq!(samples_after(&[true; 12], DEVIATION, REGULAR + 1), SAMPLES + 12.0);
}
