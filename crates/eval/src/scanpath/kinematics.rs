//! Rotations of a line of sight, their profile in time, and random draws.

use super::viewing::{DRIFT_RMS_DEG, DRIFT_STEP_S, MAIN_SEQUENCE_S};
use glam::DVec3;
use rand::Rng;
use rand_pcg::Pcg64;
use std::f64::consts::TAU;

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
