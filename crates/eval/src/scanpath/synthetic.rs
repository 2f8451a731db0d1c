//! Synthetic scanpaths: options, and their generation by a model of free viewing.

use super::sample_times::{check_times, sample_times};
use super::simulated_eye::SimulatedEye;
use super::viewing::{AIM_MARGIN_DEG, Event, SACCADE_DEG};
use super::{About, Sample, Scanpath, Screen};
use crate::error::InputError;

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

    /// Checks all options. Returns the tangent per pixel, and half the screen's width and height in degrees.
    fn aim_field(&self) -> Result<([f64; 2], [f64; 2]), InputError> {
        let fault = |option: &str, found: String, remedy: &str| {
            Err(InputError::request(format!("synthetic scanpath, {option}"), found, remedy))
        };
        check_times("synthetic scanpath", self.duration_s, self.rate_hz)?;
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

/// A generated scanpath and its ground truth.
#[derive(Clone, Debug, PartialEq)]
pub struct Synthetic {
    /// Samples. No sample is lost.
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
    let mut eye = SimulatedEye::new(options.seed, half_deg, sample_times(options.duration_s, options.rate_hz));
    while !eye.done() {
        eye.fixate();
        eye.look_elsewhere();
    }
    let (tangents, events) = eye.finish();
    let sample = |(t_s, tangent)| Sample { t_s, px: Some(options.screen.px(slope, tangent)) };
    let samples = tangents.into_iter().map(sample).collect();
    let source = format!("afterimage, synthetic scanpath, seed {}", options.seed);
    let about = About::generated("free viewing", options.rate_hz, &[("source", &source)]);
    let path = Scanpath::new(format!("synthetic:{}", options.seed), options.screen, about, samples)?;
    Ok(Synthetic { path, events })
}
