//! A stochastic model of free viewing: its distributions with their sources, and the events that it generates.
//!
//! ```text
//! fixation -> saccade -> fixation                                  (the landing error is small)
//! fixation -> saccade -> landing -> corrective -> fixation         (the landing error is large)
//! ```
//!
//! Angles are true visual angles. A saccade rotates the eye along a great circle, which is a straight line on a flat
//! screen. The constants below give about 2.5 saccades and 1.1 correctives a second on the default screen. With or
//! without the correctives, this is within the 2 to 4 saccades a second of ordinary viewing.

/// Duration of a fixation in seconds: uniform. Means in free viewing are 250 to 330 ms (Rayner 1998, table 1: 330 for
/// scenes, 275 for search).
pub(super) const FIXATION_S: [f64; 2] = [0.2, 0.4];

/// Drift: root mean square displacement in degrees, over both axes, of a Brownian walk during [`DRIFT_STEP_S`]. Chosen
/// to give 0.15 degrees over a fixation of 300 ms, the order reported by Martinez-Conde et al. 2004.
pub(super) const DRIFT_RMS_DEG: f64 = 0.035;

/// Time in seconds that [`DRIFT_RMS_DEG`] refers to: a frame at 60 Hz.
pub(super) const DRIFT_STEP_S: f64 = 1.0 / 60.0;

/// Microsaccades per second of fixation (Martinez-Conde et al. 2004: 1 to 2). A fixation of `d` seconds has one with
/// probability `rate * d`, and never two. This keeps the mean rate exact, and approximates a refractory time.
pub(super) const MICROSACCADE_HZ: f64 = 2.0;

/// Amplitude of a microsaccade in degrees: uniform. Up to 1 degree (Martinez-Conde et al. 2013); below 0.2 it is
/// indistinguishable from drift.
pub(super) const MICROSACCADE_DEG: [f64; 2] = [0.2, 1.0];

/// Intended amplitude of a saccade in degrees: exponential with the scale [`SACCADE_SCALE_DEG`], truncated to this
/// range. Larger gaze shifts involve the head (Bahill, Adler & Stark 1975: most natural saccades are below 15 degrees).
pub(super) const SACCADE_DEG: [f64; 2] = [2.5, 18.0];

/// Scale of the intended amplitude in degrees: many short saccades, few long ones (the shape is that in Tatler &
/// Vincent 2008, the number is chosen here). A larger scale revisits earlier places less often.
pub(super) const SACCADE_SCALE_DEG: f64 = 6.0;

/// Main sequence in seconds and seconds per degree: duration = 21 ms + 2.2 ms/deg (Carpenter 1988, p. 72).
pub(super) const MAIN_SEQUENCE_S: [f64; 2] = [0.021, 0.0022];

/// Undershoot of a saccade as a share of its intended amplitude: uniform, with a mean of 8 % (Becker & Fuchs 1969:
/// about 10 %).
pub(super) const UNDERSHOOT: [f64; 2] = [0.04, 0.12];

/// Landing error in degrees above which a corrective saccade follows. Smaller errors are within the foveola and of the
/// order of drift. A smaller threshold gives more correctives, and more than 4 saccades a second.
pub(super) const CORRECT_ABOVE_DEG: f64 = 0.5;

/// Interval in seconds between a saccade and its corrective: uniform (Becker & Fuchs 1969: 130 ms; 120 to 180 in later
/// work).
pub(super) const LANDING_S: [f64; 2] = [0.12, 0.18];

/// Smallest distance in degrees of a saccade's target from the screen's edge. Microsaccades and drift then seldom reach
/// the edge.
pub(super) const AIM_MARGIN_DEG: f64 = 1.5;

/// Smallest distance in degrees of the gaze from the screen's edge.
pub(super) const EDGE_MARGIN_DEG: f64 = 0.5;

/// Kind of an eye movement or rest.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum EventKind {
    /// Rest on the target with drift; 200 to 400 ms. Contains microsaccades.
    Fixation,
    /// Rest with drift after a saccade that fell short; 120 to 180 ms. A corrective always follows.
    Landing,
    /// Movement to a new target.
    Saccade,
    /// Small movement during a fixation.
    Microsaccade,
    /// Pursuit of a moving object; only with a head.
    Pursuit,
    /// Movement that corrects a saccade's undershoot. Not counted in "saccades per second"; see the module's
    /// documentation.
    Corrective,
}

/// An eye movement or rest: ground truth behind the samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Event {
    /// Kind of movement or rest.
    pub kind: EventKind,
    /// Begin in seconds.
    pub start_s: f64,
    /// End in seconds. The last events may end after the last sample.
    pub end_s: f64,
    /// Visual angle in degrees between the gaze at begin and end.
    pub amplitude_deg: f64,
    /// Visual angle in degrees between the gaze at begin and the target: above `amplitude_deg` for a saccade, which
    /// falls short; equal to it for all other kinds.
    pub intended_deg: f64,
}
