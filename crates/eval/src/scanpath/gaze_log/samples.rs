//! Samples of an eye tracker, and the scanpath on a screen that they make.

use super::layouts::Plane;
use super::options::{GazeLogOptions, Vendor};
use crate::error::InputError;
use crate::scanpath::recorded::Merged;
use crate::scanpath::sample_times::median_step;
use crate::scanpath::table::number;
use crate::scanpath::{About, Sample, Scanpath, Screen};

/// Screen of logs of directions, fixed to the head: as wide as that of generated heads, in degrees.
const HEAD_FOV_DEG: f32 = 100.0;
/// Its size in pixels.
const HEAD_PX: [u32; 2] = [2000, 2000];
/// Distance of screens whose distance does not matter, in millimetres.
const NOMINAL_DISTANCE_MM: f32 = 600.0;
/// Size of a screen of which a log holds shares, where nobody states it. `fit` does not depend on it.
const NOMINAL_PX: [u32; 2] = [1920, 1080];
/// Longest step back in time within a recording, in seconds. Trackers that join two eyes give samples out of order.
const LONGEST_STEP_BACK_S: f64 = 1.0;

/// A time in ticks, exact for nanoseconds since 1970.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Clock {
    whole: i64,
    part: f64,
}

impl Clock {
    /// A time of whole ticks.
    pub fn of_whole(whole: i64) -> Self {
        Self { whole, part: 0.0 }
    }

    pub fn parse(cell: &str) -> Option<Self> {
        if let Ok(whole) = cell.parse() {
            return Some(Self { whole, part: 0.0 });
        }
        let ticks: f64 = number::<f64>(cell).filter(|t| t.is_finite())?;
        Some(Self { whole: ticks.trunc() as i64, part: ticks.fract() })
    }

    /// Ticks since `start`.
    pub fn since(self, start: Self) -> f64 {
        (i128::from(self.whole) - i128::from(start.whole)) as f64 + (self.part - start.part)
    }
}

/// A sample as a log has it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Raw {
    pub clock: Clock,
    /// Place on the log's plane, x to the right and y down; `None`: lost.
    pub at: Option<[f64; 2]>,
}

/// What a log says.
pub(super) struct Samples {
    /// Whose export it is; `None`: its columns were named.
    pub vendor: Option<Vendor>,
    pub writer: &'static str,
    pub plane: Plane,
    /// Ticks a second; `None`: not stated.
    pub per_second: Option<f64>,
    pub screen_px: Option<[u32; 2]>,
    pub screen_mm: Option<[f32; 2]>,
    pub distance_mm: Option<f32>,
    /// Rows of text that were left out.
    pub skipped: usize,
    pub raw: Vec<Raw>,
}

impl Samples {
    /// No samples yet, of a screen that is not stated.
    pub fn new(vendor: Option<Vendor>, writer: &'static str, plane: Plane, per_second: Option<f64>) -> Self {
        let (screen_px, screen_mm, distance_mm) = (None, None, None);
        Self { vendor, writer, plane, per_second, screen_px, screen_mm, distance_mm, skipped: 0, raw: vec![] }
    }

    /// The scanpath, and what was assumed.
    ///
    /// # Errors
    /// [`Request`](InputError::Request) if the screen's size is needed and not known, [`Invalid`](InputError::Invalid)
    /// for several recordings in one, and those of [`Scanpath::new`].
    pub fn placed(self, name: &str, options: &GazeLogOptions) -> Result<(Scanpath, Vec<String>), InputError> {
        let mut warnings = vec![];
        if self.skipped > 0 {
            warnings.push(format!(
                "{name} has {} rows without numbers in the columns of gaze; they were left out",
                self.skipped
            ));
        }
        let (screen, note) = self.screen(name, options, &mut warnings)?;
        let times = self.times(name, &mut warnings)?;
        let size = screen.size_px.map(f64::from);
        let slope = screen.tangent_per_px().unwrap_or([1.0; 2]);
        let to_px = |at: [f64; 2]| {
            [0, 1].map(|i| match self.plane {
                Plane::Pixels => at[i],
                Plane::Fractions | Plane::FractionsUp => at[i] * size[i],
                Plane::Forward | Plane::ForwardLeft | Plane::Angles | Plane::Radians => {
                    0.5 * size[i] + at[i] / slope[i]
                }
            } as f32)
        };
        let mut order: Vec<usize> = (0..times.len()).collect();
        order.sort_by(|&a, &b| times[a].total_cmp(&times[b]));
        let mut merged = Merged::default();
        for i in order {
            merged.push(Sample { t_s: times[i], px: self.raw[i].at.map(to_px) }, None);
        }
        warnings.extend(merged.warning(name));
        let notes = [("tracker".to_owned(), self.writer.to_owned())].into_iter().chain(note).collect();
        let about = About { notes, ..About::default() };
        Ok((Scanpath::new(name, screen, about, merged.samples)?, warnings))
    }

    /// The screen, and a note about it.
    fn screen(
        &self,
        name: &str,
        options: &GazeLogOptions,
        warnings: &mut Vec<String>,
    ) -> Result<(Screen, Option<(String, String)>), InputError> {
        let (px, mm, distance) = (
            options.screen_px.or(self.screen_px),
            options.screen_mm.or(self.screen_mm),
            options.distance_mm.or(self.distance_mm),
        );
        let screen = |px: [u32; 2], mm: Option<[f32; 2]>, distance: Option<f32>| Screen {
            size_px: px,
            size_cm: mm.map(|mm| mm.map(|v| v / 10.0)),
            distance_cm: distance.map(|v| v / 10.0),
        };
        let note = |text: &str| Some(("screen_px_note".to_owned(), text.to_owned()));
        if self.plane.is_angular() {
            let px = px.unwrap_or(HEAD_PX);
            return match (mm, distance) {
                (Some(_), Some(_)) => Ok((screen(px, mm, distance), None)),
                (None, None) => {
                    let wide = 2.0 * NOMINAL_DISTANCE_MM * (0.5 * HEAD_FOV_DEG).to_radians().tan();
                    let mm = [wide, wide * px[1] as f32 / px[0] as f32];
                    let text = "fixed to the head, 100 degrees wide: the log has directions";
                    Ok((screen(px, Some(mm), Some(NOMINAL_DISTANCE_MM)), note(text)))
                }
                _ => Err(InputError::request(
                    name,
                    "has directions, and only one of the screen's size and its distance is given",
                    "give both `screen_mm` and `distance_mm`, or neither",
                )),
            };
        }
        if mm.is_none() || distance.is_none() {
            warnings.push(format!(
                "{name} does not state the screen's size and distance, so gaze is stretched from screen to frame; to \
                 keep visual angles, give `screen_mm` and `distance_mm`"
            ));
        }
        match (px, self.plane) {
            (Some(px), _) => Ok((screen(px, mm, distance), None)),
            (None, Plane::Pixels) => Err(InputError::request(
                name,
                "has gaze in pixels and does not state the size of the screen or picture",
                "give it as `screen_px`, and for visual angles `screen_mm` and `distance_mm`",
            )),
            (None, _) => {
                let text = "nominal: the log has shares of the screen";
                Ok((screen(NOMINAL_PX, mm, distance), note(text)))
            }
        }
    }

    /// Times in seconds since the first sample, rounded to nanoseconds.
    fn times(&self, name: &str, warnings: &mut Vec<String>) -> Result<Vec<f64>, InputError> {
        let Some(start) = self.raw.first().map(|raw| raw.clock) else {
            return Err(InputError::invalid(name, "there is no sample", "give at least one row with a valid gaze"));
        };
        let ticks: Vec<f64> = self.raw.iter().map(|raw| raw.clock.since(start)).collect();
        let per_second = self.per_second.unwrap_or_else(|| usual_unit(&ticks));
        let seconds = |ticks: f64| (ticks / per_second * 1e9).round() * 1e-9;
        let steps_back = ticks.windows(2).filter(|pair| pair[1] < pair[0]);
        if let Some(pair) = steps_back.clone().find(|pair| seconds(pair[0] - pair[1]) > LONGEST_STEP_BACK_S) {
            return Err(InputError::invalid(
                name,
                format!("time goes back by {} s: it has several recordings", seconds(pair[0] - pair[1])),
                "cut it to one of them",
            ));
        }
        match steps_back.count() {
            0 => {}
            n => warnings.push(format!("{name} has {n} samples out of order in time; they were sorted")),
        }
        let first = ticks.iter().copied().fold(f64::INFINITY, f64::min);
        Ok(ticks.iter().map(|t| ((t - first) / per_second * 1e9).round() / 1e9).collect())
    }
}

/// Ticks a second with which the median step lies between 0.2 and 200 ms.
fn usual_unit(ticks: &[f64]) -> f64 {
    let Some(median) = median_step(ticks.iter().copied(), |step| step > 0.0) else { return 1.0 };
    [1.0, 1e3, 1e6].into_iter().find(|unit| median < 0.2 * unit).unwrap_or(1e9)
}
