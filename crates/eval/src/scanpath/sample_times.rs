//! Times of a scanpath's samples.

use crate::error::InputError;

/// Largest number of samples: up to 64 bytes each, two thirds of a gigabyte in all.
const MAX_SAMPLES: f64 = 1e7;

/// Checks the duration and rate of a scanpath that is generated; `of` is what errors call it.
pub(super) fn check_times(of: &str, duration_s: f64, rate_hz: f64) -> Result<(), InputError> {
    let (option, found, remedy) = if !(1.0..=10_000.0).contains(&rate_hz) {
        ("rate", format!("{rate_hz} Hz"), "expected 1 to 10000 Hz")
    } else if !(duration_s > 0.0 && duration_s * rate_hz <= MAX_SAMPLES) {
        let remedy = "expected more than 0 s and at most ten million samples";
        ("duration", format!("{duration_s} s at {rate_hz} Hz"), remedy)
    } else {
        return Ok(());
    };
    Err(InputError::request(format!("{of}, {option}"), found, remedy))
}

/// Times of samples in seconds: every multiple of `1 / rate_hz` below the duration.
pub(super) fn sample_times(duration_s: f64, rate_hz: f64) -> impl Iterator<Item = f64> {
    // Tolerance for rounding: 1.1 s at 10 Hz is 11.000000000000002 in floats, and must give 11 samples.
    let count = ((duration_s * rate_hz - 1e-6).ceil() as usize).max(1);
    (0..count).map(move |i| i as f64 / rate_hz)
}

/// Median of the steps between consecutive values that `counts` accepts; `None` if it accepts none.
pub(super) fn median_step(values: impl Iterator<Item = f64> + Clone, counts: impl Fn(f64) -> bool) -> Option<f64> {
    let mut steps: Vec<f64> =
        values.clone().zip(values.skip(1)).map(|(a, b)| b - a).filter(|step| counts(*step)).collect();
    let middle = steps.len() / 2;
    (!steps.is_empty()).then(|| *steps.select_nth_unstable_by(middle, f64::total_cmp).1)
}
