//! EyeLink's ASC text, as `edf2asc` writes it: messages, events and samples, one a line.

use super::layouts::Plane;
use super::options::{Eye, Vendor};
use super::rows::{mean, no_eye};
use super::samples::{Clock, Raw, Samples};
use crate::error::InputError;
use crate::scanpath::table::{is_missing, number, quote};

/// Lines at the beginning in which the text is recognized.
const RECOGNIZED_WITHIN: usize = 200;

/// Whether a text is EyeLink's.
pub(super) fn is_asc(text: &str) -> bool {
    let first = || text.lines().take(RECOGNIZED_WITHIN);
    first().any(|l| l.starts_with("** CONVERTED FROM") || l.starts_with("** TYPE: EDF_FILE"))
        || first().any(|l| l.starts_with("START\t") && l.contains("SAMPLES"))
}

/// Whether a text may have EyeLink's samples alone: it begins with a number.
pub(super) fn is_samples(text: &str) -> bool {
    text.trim_start().starts_with(|c: char| c.is_ascii_digit())
}

/// What the lines so far say of the samples that follow.
struct State {
    eye: Eye,
    /// Left and right eye recorded.
    recorded: [bool; 2],
    /// In a blink, by eye.
    blinks: [bool; 2],
    /// Left top of the display.
    corner: [f64; 2],
}

/// The samples of a text.
///
/// # Errors
/// [`Invalid`](InputError::Invalid) with the line if gaze is not in screen coordinates or a sample cannot be read;
/// [`Request`](InputError::Request) for an eye that was not recorded.
pub(super) fn samples(name: &str, text: &str, eye: Eye) -> Result<Samples, InputError> {
    let mut samples = Samples::new(Some(Vendor::Eyelink), "EyeLink's edf2asc", Plane::Pixels, Some(1e3));
    let mut state = State { eye, recorded: [false; 2], blinks: [false; 2], corner: [0.0; 2] };
    for (index, line) in text.lines().enumerate() {
        let words: Vec<&str> = line.split_whitespace().collect();
        let invalid = |problem: String, remedy: &str| {
            Err(InputError::invalid(format!("{name}, line {}", index + 1), problem, remedy))
        };
        let eyes = || ["LEFT", "RIGHT"].map(|side| words.contains(&side));
        match words.as_slice() {
            ["MSG", _, said @ ..] => state.message(said, &mut samples),
            ["START", ..] => (state.recorded, state.blinks) = (eyes(), [false; 2]),
            ["SAMPLES", "GAZE", ..] => state.recorded = eyes(),
            ["SAMPLES", kind, ..] => {
                return invalid(
                    format!("the samples are {}, not gaze on the screen", quote(kind)),
                    "convert the EDF again with gaze samples",
                );
            }
            [begin @ ("SBLINK" | "EBLINK"), side, ..] => {
                state.blinks[usize::from(*side == "R")] = *begin == "SBLINK";
            }
            // Numbers of a calibration are indented.
            [time, values @ ..] if line.starts_with(|c: char| c.is_ascii_digit()) => {
                let Some(clock) = Clock::parse(time) else { continue };
                let Some(at) = state.gaze(values) else {
                    return invalid(
                        format!("{} is no sample", quote(line)),
                        "expected a time, and x y and pupil of each eye",
                    );
                };
                samples.raw.push(Raw { clock, at });
            }
            _ => {}
        }
    }
    let has = state.recorded;
    if (eye == Eye::Left && !has[0] || eye == Eye::Right && !has[1]) && has != [false; 2] {
        return Err(no_eye(name, eye));
    }
    Ok(samples)
}

impl State {
    /// Geometry of the screen in a message: its pixels, and the tracker's settings where they were logged.
    fn message(&mut self, said: &[&str], samples: &mut Samples) {
        let numbers = |words: &[&str]| -> Vec<f64> {
            words.iter().filter_map(|w| number(w.trim_end_matches(','))).filter(|v: &f64| v.is_finite()).collect()
        };
        match said {
            ["DISPLAY_COORDS" | "GAZE_COORDS", corners @ ..] => {
                if let [left, top, right, bottom] = numbers(corners)[..] {
                    let size = [right - left + 1.0, bottom - top + 1.0];
                    if size.iter().all(|v| (1.0..=1e6).contains(v)) {
                        samples.screen_px = Some(size.map(|v| v as u32));
                        self.corner = [left, top];
                    }
                }
            }
            ["!CMD", _, "screen_phys_coord", "=", corners @ ..] => {
                if let [left, top, right, bottom] = numbers(corners)[..] {
                    let size = [right - left, bottom - top].map(|v| v.abs() as f32);
                    samples.screen_mm = size.iter().all(|v| *v > 0.0).then_some(size);
                }
            }
            // Millimetres to the top, and to the bottom of the screen.
            ["!CMD", _, "screen_distance", "=", distances @ ..] => {
                let all = numbers(distances);
                let mean = all.iter().sum::<f64>() / all.len().max(1) as f64;
                samples.distance_mm = (mean > 0.0).then_some(mean as f32);
            }
            _ => {}
        }
    }

    /// Gaze in the values of a sample: `None` if they are too few, `Some(None)` where gaze is lost.
    fn gaze(&self, values: &[&str]) -> Option<Option<[f64; 2]>> {
        // Text with samples alone does not say which eyes they are of.
        let recorded = match self.recorded {
            [false, false] => [true, values.len() >= 6],
            stated => stated,
        };
        let mut seen = vec![];
        let mut first = 0;
        for side in (0..2).filter(|&side| recorded[side]) {
            let pair = [values.get(first)?, values.get(first + 1)?];
            first += 3;
            let is_chosen = self.eye == Eye::Both || (self.eye == Eye::Right) == (side == 1);
            if !is_chosen || self.blinks[side] || pair.iter().any(|cell| is_missing(cell)) {
                continue;
            }
            let [x, y] = [number::<f64>(pair[0])?, number::<f64>(pair[1])?];
            if x.is_finite() && y.is_finite() {
                seen.push([x - self.corner[0], y - self.corner[1]]);
            }
        }
        Some(mean(&seen))
    }
}
