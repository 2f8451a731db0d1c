//! Rotations of a line of sight, their profile in time, random draws, and the times of samples.

use super::viewing::{DRIFT_RMS_DEG, DRIFT_STEP_S, MAIN_SEQUENCE_S};
use crate::error::InputError;
use glam::DVec3;
use rand::Rng;
use rand_pcg::Pcg64;
use std::f64::consts::TAU;

/// Largest number of samples: up to 64 bytes each, two thirds of a gigabyte in all.
const MAX_SAMPLES: f64 = 1e7;

/// Checks duration and rate of what is generated: `of`.
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

/// Median of the steps between values, of those that `counts`; `None` without any.
pub(super) fn median_step(values: impl Iterator<Item = f64> + Clone, counts: impl Fn(f64) -> bool) -> Option<f64> {
    let mut steps: Vec<f64> =
        values.clone().zip(values.skip(1)).map(|(a, b)| b - a).filter(|step| counts(*step)).collect();
    let middle = steps.len() / 2;
    (!steps.is_empty()).then(|| *steps.select_nth_unstable_by(middle, f64::total_cmp).1)
}

/// Duration in seconds of a saccade of `amplitude_deg`.
pub(super) fn main_sequence_s(amplitude_deg: f64) -> f64 {
    MAIN_SEQUENCE_S[0] + MAIN_SEQUENCE_S[1] * amplitude_deg
}

/// Share of a movement that is done after the share `u` of its duration, with the least jerk (Flash & Hogan 1985). Its
/// largest speed is 1.875 times the mean speed.
pub(super) fn minimum_jerk(u: f64) -> f64 {
    u * u * u * (10.0 + u * (6.0 * u - 15.0))
}

/// Inverse of the distribution function of an exponential distribution with this scale, truncated to a range.
pub(super) fn truncated_exponential(u: f64, scale: f64, [least, most]: [f64; 2]) -> f64 {
    let share = 1.0 - (-(most - least) / scale).exp();
    least - scale * (1.0 - u * share).ln()
}

/// Uniform in \[0, 1). Not the `rand` crate's conversion, whose values may change between versions.
pub(super) fn unit(rng: &mut Pcg64) -> f64 {
    (rng.next_u64() >> 11) as f64 * (1.0 / (1u64 << 53) as f64)
}

pub(super) fn uniform(rng: &mut Pcg64, [low, high]: [f64; 2]) -> f64 {
    low + (high - low) * unit(rng)
}

/// Unit vector `from` rotated by `angle_deg` towards `towards`, a unit vector orthogonal to it.
pub(super) fn turn(from: DVec3, towards: DVec3, angle_deg: f64) -> DVec3 {
    let (sin, cos) = angle_deg.to_radians().sin_cos();
    // Normalised, so that rounding errors do not accumulate over millions of steps.
    (from * cos + towards * sin).normalize()
}

/// Two orthonormal vectors orthogonal to `gaze`, which is never the y axis.
pub(super) fn axes(gaze: DVec3) -> (DVec3, DVec3) {
    let right = DVec3::Y.cross(gaze).normalize();
    (right, gaze.cross(right))
}

/// A direction at `gaze`, all equally likely.
pub(super) fn any_direction(rng: &mut Pcg64, gaze: DVec3) -> DVec3 {
    let (sin, cos) = (TAU * unit(rng)).sin_cos();
    let (right, down) = axes(gaze);
    right * cos + down * sin
}

/// Gaze after a step of Brownian drift.
pub(super) fn drifted(rng: &mut Pcg64, gaze: DVec3, step_s: f64) -> DVec3 {
    let variance_deg2 = DRIFT_RMS_DEG * DRIFT_RMS_DEG * (step_s / DRIFT_STEP_S).max(0.0);
    // A two-dimensional normal displacement: uniform direction, Rayleigh length with this mean square.
    let length_deg = (variance_deg2 * -(1.0 - unit(rng)).ln()).sqrt();
    turn(gaze, any_direction(rng, gaze), length_deg)
}

/// Direction at `from` of the shortest rotation to `to`; an arbitrary one if they coincide.
pub(super) fn tangent_towards(from: DVec3, to: DVec3) -> DVec3 {
    (to - from * from.dot(to)).try_normalize().unwrap_or_else(|| axes(from).0)
}

pub(super) fn angle_deg(a: DVec3, b: DVec3) -> f64 {
    a.cross(b).length().atan2(a.dot(b)).to_degrees()
}
