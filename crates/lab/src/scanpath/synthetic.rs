//! A stochastic model of free viewing: its distributions with their sources, its options, and the events that it
//! generates.
//!
//! ```text
//! fixation -> saccade -> fixation                                  (the landing error is small)
//! fixation -> saccade -> landing -> corrective -> fixation         (the landing error is large)
//! ```
//!
//! Angles are true visual angles. A saccade rotates the eye along a great circle, which is a straight line on a flat
//! screen. The constants below give about 2.5 saccades and 1.1 correctives a second on the default screen. With or
//! without the correctives, this is within the 2 to 4 saccades a second of ordinary viewing.

use super::walk::Walk;
use super::{About, Sample, Scanpath, Screen};
use crate::error::InputError;

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

/// Largest number of samples: 24 bytes each, a quarter of a gigabyte in all.
const MAX_SAMPLES: f64 = 1e7;

/// Options of [`generate`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SyntheticOptions {
    /// Seed. The same seed gives the same scanpath, bit for bit on one platform; on others sines may differ in the last
    /// digit.
    pub seed: u64,
    /// Duration in seconds, above 0; default 60. `duration_s * rate_hz` is at most ten million.
    pub duration_s: f64,
    /// Samples per second, 1 to 10,000; default 500.
    pub rate_hz: f64,
    /// Screen; default [`Screen::default`]. Its size in centimetres and its distance must be known, and it must span at
    /// least 8 degrees in width and height.
    pub screen: Screen,
}

impl Default for SyntheticOptions {
    fn default() -> Self {
        Self { seed: 0, duration_s: 60.0, rate_hz: 500.0, screen: Screen::default() }
    }
}

impl SyntheticOptions {
    /// Checks every option.
    ///
    /// # Errors
    /// [`Request`](InputError::Request) for the first option that is out of range.
    pub fn validate(&self) -> Result<(), InputError> {
        self.aim_field().map(|_| ())
    }

    /// Number of samples: one at every multiple of `1 / rate_hz` below the duration.
    fn samples(&self) -> usize {
        // Tolerance for rounding: 1.1 s at 10 Hz is 11.000000000000002 in floats, and must give 11 samples.
        ((self.duration_s * self.rate_hz - 1e-6).ceil() as usize).max(1)
    }

    /// Checks all options. Returns the tangent per pixel, and half the screen's width and height in degrees.
    fn aim_field(&self) -> Result<([f64; 2], [f64; 2]), InputError> {
        let fault = |option: &str, found: String, remedy: &str| {
            Err(InputError::request(format!("synthetic scanpath, {option}"), found, remedy))
        };
        if !(1.0..=10_000.0).contains(&self.rate_hz) {
            return fault("rate", format!("{} Hz", self.rate_hz), "expected 1 to 10000 Hz");
        }
        let samples = self.duration_s * self.rate_hz;
        if !(self.duration_s > 0.0 && samples <= MAX_SAMPLES) {
            return fault(
                "duration",
                format!("{} s at {} Hz", self.duration_s, self.rate_hz),
                "expected more than 0 s and at most ten million samples",
            );
        }
        if let Err((problem, remedy)) = self.screen.check() {
            return fault("screen", problem, remedy);
        }
        let Some(slope) = self.screen.tangent_per_px() else {
            return fault(
                "screen",
                "its size in cm or its distance is not known".into(),
                "give both: eye movements are defined as angles",
            );
        };
        let half_deg = [0, 1].map(|i| {
            let tangent = 0.5 * f64::from(self.screen.size_px[i]) * slope[i];
            tangent.atan().to_degrees()
        });
        let least = SACCADE_DEG[0] + AIM_MARGIN_DEG;
        if half_deg.iter().any(|h| *h < least) {
            return fault(
                "screen",
                format!("it spans {:.1}x{:.1} degrees", 2.0 * half_deg[0], 2.0 * half_deg[1]),
                "expected at least 8 degrees in width and height, or no saccade fits",
            );
        }
        Ok((slope, half_deg))
    }
}

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

/// A generated scanpath and its ground truth.
#[derive(Clone, Debug, PartialEq)]
pub struct Synthetic {
    /// Samples; none is lost.
    pub path: Scanpath,
    /// Events by begin. All but microsaccades are contiguous, from 0 s to past the last sample.
    pub events: Vec<Event>,
}

/// Generates a scanpath of free viewing. The constants of this module give the distributions and their sources.
///
/// # Errors
/// Those of [`SyntheticOptions::validate`].
pub fn generate(options: &SyntheticOptions) -> Result<Synthetic, InputError> {
    let (slope, half_deg) = options.aim_field()?;
    let times = (0..options.samples()).map(|i| i as f64 / options.rate_hz);
    let mut walk = Walk::new(options.seed, half_deg, times);
    while !walk.done() {
        walk.fixate();
        walk.look_elsewhere();
    }
    let (tangents, events) = walk.finish();
    let size = options.screen.size_px;
    let samples = tangents.into_iter().map(|(t_s, tangent)| Sample {
        t_s,
        px: Some([0, 1].map(|i| (tangent[i] / slope[i] + 0.5 * f64::from(size[i])) as f32)),
    });
    let about = About {
        task: Some("free viewing (synthetic)".into()),
        rate_hz: Some(options.rate_hz),
        notes: [
            ("origin", "top left, x right, y down".into()),
            ("source", format!("afterimage, synthetic scanpath, seed {}", options.seed)),
            ("licence", "MIT OR Apache-2.0".into()),
        ]
        .map(|(key, value)| (key.to_owned(), value))
        .to_vec(),
    };
    let path = Scanpath::new(format!("synthetic:{}", options.seed), options.screen, about, samples.collect())?;
    Ok(Synthetic { path, events })
}
