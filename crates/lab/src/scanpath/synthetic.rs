//! A model of free viewing: what it draws, from which distributions, and what it reports about them.
//!
//! ```text
//! fixation -> saccade -> fixation                                  (the rest of the error is small)
//! fixation -> saccade -> landing -> corrective -> fixation         (it is not)
//! ```
//!
//! Angles are true visual angles. A saccade turns the eye along a great circle, which is a straight line on a flat screen.
//! The numbers below give about 2.5 saccades and 1.1 correctives a second on the default screen; either count, with or without
//! the correctives, is within the 2 to 4 a second of ordinary viewing.

use super::walk::Walk;
use super::{About, Sample, Scanpath, Screen};
use crate::error::InputError;

/// Fixation, seconds: uniform. Free viewing has means of 250 to 330 ms (Rayner 1998, table 1: 330 for scenes, 275 for search).
pub(super) const FIXATION_S: [f64; 2] = [0.2, 0.4];

/// Drift, degrees: root mean square displacement, both axes together, after [`DRIFT_STEP_S`] of a Brownian walk. Chosen here:
/// 0.15 degrees over a fixation of 300 ms, the order reported by Martinez-Conde et al. 2004.
pub(super) const DRIFT_RMS_DEG: f64 = 0.035;

/// Time over which [`DRIFT_RMS_DEG`] is meant: a frame at 60 Hz.
pub(super) const DRIFT_STEP_S: f64 = 1.0 / 60.0;

/// Microsaccades per second of fixation (Martinez-Conde et al. 2004: 1 to 2). A fixation of `d` seconds has one with probability
/// `rate * d` and never two, which keeps the mean rate exact and is a crude refractory time.
pub(super) const MICROSACCADE_HZ: f64 = 2.0;

/// Microsaccade, degrees: uniform. Up to 1 degree (Martinez-Conde et al. 2013); below 0.2 it is lost in drift.
pub(super) const MICROSACCADE_DEG: [f64; 2] = [0.2, 1.0];

/// Intended saccade, degrees: exponential with the scale [`SACCADE_SCALE_DEG`], cut to this range. Larger turns are made with
/// the head (Bahill, Adler & Stark 1975: most natural saccades are below 15 degrees).
pub(super) const SACCADE_DEG: [f64; 2] = [2.5, 18.0];

/// Scale of the intended amplitude, degrees: many short, few long (shape as in Tatler & Vincent 2008, the number chosen here). Larger: fewer
/// revisits of places seen before.
pub(super) const SACCADE_SCALE_DEG: f64 = 6.0;

/// Main sequence, seconds and seconds per degree: duration = 21 ms + 2.2 ms/deg (Carpenter 1988, p. 72).
pub(super) const MAIN_SEQUENCE_S: [f64; 2] = [0.021, 0.0022];

/// Share of the intended amplitude that a saccade falls short by: uniform, 8 % in the mean (Becker & Fuchs 1969: about 10 %).
pub(super) const UNDERSHOOT: [f64; 2] = [0.04, 0.12];

/// Error in degrees above which a corrective saccade follows; smaller ones stay (they are within the foveola and of the order of
/// drift). Smaller: more correctives, and more than 4 saccades a second.
pub(super) const CORRECT_ABOVE_DEG: f64 = 0.5;

/// Rest between a saccade and its corrective, seconds: uniform (Becker & Fuchs 1969: 130 ms; 120 to 180 in later work).
pub(super) const LANDING_S: [f64; 2] = [0.12, 0.18];

/// Saccades aim no closer than this to the edge, degrees, so that the longest microsaccade and drift seldom meet the edge.
pub(super) const AIM_MARGIN_DEG: f64 = 1.5;

/// The gaze never comes closer than this to the edge, degrees.
pub(super) const EDGE_MARGIN_DEG: f64 = 0.5;

/// Most samples that are made: 24 bytes each, so a quarter of a gigabyte.
const MAX_SAMPLES: f64 = 1e7;

/// What to generate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SyntheticOptions {
    /// Same seed, same scanpath (on one platform bit for bit; elsewhere sines may differ in their last digit).
    pub seed: u64,
    /// Seconds, above 0; default 60. `duration_s * rate_hz` is at most ten million.
    pub duration_s: f64,
    /// Samples per second, 1 to 10,000; default 500.
    pub rate_hz: f64,
    /// Where the eye looks; default [`Screen::default`]. Needs its size in centimetres and its distance, and at least 8 degrees
    /// a side.
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
    /// Names the first option outside its range.
    pub fn validate(&self) -> Result<(), InputError> {
        self.aim_field().map(|_| ())
    }

    /// Samples to make: one at every multiple of `1 / rate_hz` below the duration.
    fn samples(&self) -> usize {
        // 1.1 s at 10 Hz, 11.000000000000002 in floats, are eleven samples and not twelve.
        ((self.duration_s * self.rate_hz - 1e-6).ceil() as usize).max(1)
    }

    /// After all checks: slope per pixel, and half the screen's width and height in degrees.
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
                "give both: the eye's movements are angles",
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
                "expected at least 8 degrees a side, or no saccade would fit",
            );
        }
        Ok((slope, half_deg))
    }
}

/// What the eye was doing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum EventKind {
    /// At rest on its target, drifting; 200 to 400 ms. Microsaccades are inside.
    Fixation,
    /// At rest where a saccade fell short, drifting; 120 to 180 ms. Always followed by a corrective.
    Landing,
    /// A turn to a new target.
    Saccade,
    /// A small turn during a fixation.
    Microsaccade,
    /// The turn that makes good a saccade's undershoot. Not counted in "saccades per second"; see the module's text.
    Corrective,
}

/// One stretch of the truth behind the samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Event {
    /// What the eye was doing.
    pub kind: EventKind,
    /// Begin in seconds.
    pub start_s: f64,
    /// End in seconds. The last events may end after the last sample.
    pub end_s: f64,
    /// Visual angle in degrees between the gaze at begin and end.
    pub amplitude_deg: f64,
    /// Visual angle in degrees from the begin to where the turn was meant to end: above `amplitude_deg` for a saccade, which falls
    /// short; equal to it for all else.
    pub intended_deg: f64,
}

/// A generated scanpath and the truth behind it.
#[derive(Clone, Debug, PartialEq)]
pub struct Synthetic {
    /// The samples; none is lost.
    pub path: Scanpath,
    /// What the eye did, by begin. All but microsaccades follow one another without a gap, from 0 s to past the last sample.
    pub events: Vec<Event>,
}

/// Generates a scanpath of free viewing. The distributions and their sources are in this module's constants and in
/// [`EventKind`].
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
