//! Scanpaths: recorded and synthetic gaze over time, and its resampling to frames.
//!
//! A [`Scanpath`] comes from a CSV file ([`read_csv`]), from the export of an eye tracker ([`read_gaze_log`]), from a
//! model of an eye that looks at a screen ([`generate`]), or from a model of eye and head ([`generate_head`]);
//! [`FrameGaze`] resamples it to one gaze point per frame. Lost gaze is `None` in samples, and is never filled in by
//! interpolation. A scanpath of a headset has a [`HeadPose`] for each sample, from which [`HeadPath`] makes a camera
//! path.

mod doubts;
mod frames;
mod gaze_log;
mod head;
mod head_path;
mod kinematics;
mod pose;
mod recorded;
mod sample_times;
mod simulated_eye;
mod synthetic;
mod table;
mod viewing;

pub use frames::{FrameGaze, GazeMap};
pub use gaze_log::{Eye, GazeColumns, GazeLog, GazeLogOptions, GazeUnit, Vendor};
pub use gaze_log::{parse_gaze_columns, parse_gaze_log, read_gaze_columns, read_gaze_log};
pub use head::{DistanceOf, HeadOptions, HeadTurn, Regarded, SyntheticHead, generate_head, in_a_room};
pub use head_path::HeadPath;
pub use pose::HeadPose;
pub use recorded::{MAX_FILE_BYTES, parse_csv, read_csv, write_csv};
pub use synthetic::{Synthetic, SyntheticOptions, generate};
pub use viewing::{Event, EventKind};

use crate::error::InputError;
use afterimage::ViewGeometry;

/// Header keys with a defined meaning; notes cannot use them.
const RESERVED_KEYS: [&str; 5] = ["task", "rate_hz", "screen_px", "screen_cm", "distance_cm"];

/// Header value for unknown quantities.
const UNKNOWN: &str = "unknown";

/// One sample of an eye tracker.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Time in seconds on the recording's clock.
    pub t_s: f64,
    /// Gaze in screen pixels from the top left **corner** of the screen, y down; may lie off the screen. `None`: lost
    /// gaze.
    pub px: Option<[f32; 2]>,
}

/// The screen of a recording: flat, with its middle straight ahead of the eye. It is fixed to the head if the recording
/// has poses of the head.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Screen {
    /// Width and height in pixels, at least 1.
    pub size_px: [u32; 2],
    /// Width and height in centimetres, if known.
    pub size_cm: Option<[f32; 2]>,
    /// Distance from the eye to the middle of the screen in centimetres, if known.
    pub distance_cm: Option<f32>,
}

impl Default for Screen {
    /// 1920x1080 pixels seen from 60 cm that span 70 degrees, the default field of view of sources.
    fn default() -> Self {
        let width_cm = 2.0 * 60.0 * 35f32.to_radians().tan();
        Self { size_px: [1920, 1080], size_cm: Some([width_cm, width_cm * 1080.0 / 1920.0]), distance_cm: Some(60.0) }
    }
}

impl Screen {
    /// A screen with the pixels and visual angles of `view`, seen from 60 cm: both [`GazeMap`]s onto `view` are then
    /// equal. An off-axis view is centred.
    pub fn of_view(view: &ViewGeometry) -> Self {
        let size_px = view.size_px().map(|n| n.max(1));
        let (tangent_per_px, _) = view.scale_offset();
        let side = |axis: usize| 60.0 * tangent_per_px[axis] * size_px[axis] as f32;
        Self { size_px, size_cm: Some([side(0), side(1)]), distance_cm: Some(60.0) }
    }

    /// Tangent of the visual angle per pixel in x and y; `None` unless size and distance are known.
    pub fn tangent_per_px(&self) -> Option<[f64; 2]> {
        let (cm, distance) = (self.size_cm?, f64::from(self.distance_cm?));
        Some([0, 1].map(|i| f64::from(cm[i]) / f64::from(self.size_px[i]) / distance))
    }

    /// Pixel at these tangents of visual angles, with `slope` as the tangent per pixel.
    fn px(&self, slope: [f64; 2], tangent: [f64; 2]) -> [f32; 2] {
        [0, 1].map(|i| (tangent[i] / slope[i] + 0.5 * f64::from(self.size_px[i])) as f32)
    }

    /// Checks the screen. The error is problem and remedy.
    fn check(&self) -> Result<(), (String, &'static str)> {
        let [w, h] = self.size_px;
        if w == 0 || h == 0 {
            return Err((
                format!("the screen is {w}x{h} pixels"),
                "state its width and height as `# screen_px: WIDTHxHEIGHT`, both at least 1",
            ));
        }
        let usable = |x: f32| x.is_finite() && x > 0.0;
        if let Some([w, h]) = self.size_cm.filter(|s| !s.iter().copied().all(usable)) {
            return Err((format!("the screen is {w}x{h} cm"), "give `screen_cm` as two numbers above 0, or `unknown`"));
        }
        if let Some(d) = self.distance_cm.filter(|d| !usable(*d)) {
            return Err((
                format!("the screen is seen from {d} cm"),
                "give `distance_cm` as a number above 0, or `unknown`",
            ));
        }
        Ok(())
    }
}

/// Metadata of a recording other than its screen.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct About {
    /// Task of the viewer, in words. Empty and `unknown` mean `None`.
    pub task: Option<String>,
    /// Nominal samples per second.
    pub rate_hz: Option<f64>,
    /// All other `# key: value` lines in order: source, licence and the like.
    pub notes: Vec<(String, String)>,
}

impl About {
    /// Of a scanpath that is generated: `notes` stand between its origin and its licence.
    fn generated(task: &str, rate_hz: f64, notes: &[(&str, &str)]) -> Self {
        let (origin, licence) = (("origin", "top left, x right, y down"), ("licence", "MIT OR Apache-2.0"));
        let notes = [origin].into_iter().chain(notes.iter().copied()).chain([licence]);
        Self {
            task: Some(format!("{task} (synthetic)")),
            rate_hz: Some(rate_hz),
            notes: notes.map(|(key, value)| (key.to_owned(), value.to_owned())).collect(),
        }
    }
}

/// A gaze recording. Times increase, at least one sample is valid, and valid samples are finite.
#[derive(Clone, Debug, PartialEq)]
pub struct Scanpath {
    name: String,
    screen: Screen,
    about: About,
    samples: Vec<Sample>,
    /// One pose for each sample; empty without poses.
    poses: Vec<HeadPose>,
}

impl Scanpath {
    /// A scanpath from its parts. Samples whose coordinates are not finite become lost. All other data stay unchanged.
    /// `name` is the name in errors, usually the file's path.
    ///
    /// # Errors
    /// [`Invalid`](InputError::Invalid) if the screen has no pixels or a size that is not positive, the rate is not a
    /// positive number, a note is not one line of `key: value` or uses a reserved key, times are not finite and
    /// increasing, or no sample is valid.
    pub fn new(
        name: impl Into<String>,
        screen: Screen,
        mut about: About,
        mut samples: Vec<Sample>,
    ) -> Result<Self, InputError> {
        let name = name.into();
        let invalid = |(problem, remedy): (String, &str)| InputError::invalid(&name, problem, remedy);
        screen.check().map_err(invalid)?;
        normalize(&mut about).map_err(invalid)?;
        for sample in &mut samples {
            sample.px = sample.px.filter(|px| px.iter().all(|v| v.is_finite()));
        }
        let bad_time = |i: usize| !samples[i].t_s.is_finite() || (i > 0 && samples[i].t_s <= samples[i - 1].t_s);
        if let Some(i) = (0..samples.len()).find(|&i| bad_time(i)) {
            let problem = format!("sample {i} is at {} s", samples[i].t_s);
            return Err(invalid((problem, "times must be finite and increase from sample to sample")));
        }
        if samples.is_empty() {
            return Err(invalid(("there is no sample".into(), "give at least one row with a valid gaze")));
        }
        if samples.iter().all(|s| s.px.is_none()) {
            let problem = format!("the gaze is lost in all {} samples", samples.len());
            return Err(invalid((problem, "give a recording with at least one valid sample")));
        }
        Ok(Self { name, screen, about, samples, poses: vec![] })
    }

    /// A gaze position per frame, in pixels of frames of `size_px`, on a screen of that size and unknown geometry.
    ///
    /// # Errors
    /// As for [`new`](Self::new).
    pub fn of_frames(name: &str, size_px: [u32; 2], fps: f64, px: &[[f32; 2]]) -> Result<Self, InputError> {
        // A scanpath counts pixels from the corner of the screen, a frame from the center of its first pixel.
        let sample = |(i, px): (usize, &[f32; 2])| Sample { t_s: i as f64 / fps, px: Some(px.map(|v| v + 0.5)) };
        let screen = Screen { size_px, size_cm: None, distance_cm: None };
        Self::new(name, screen, About::default(), px.iter().enumerate().map(sample).collect())
    }

    /// The scanpath of a headset: with the pose of the head at each sample, also where the gaze is lost.
    ///
    /// # Errors
    /// [`Invalid`](InputError::Invalid) if there are not as many poses as samples, a position is not finite or beyond
    /// 1000 km, or a quaternion's length is not 1.
    pub fn with_poses(self, poses: Vec<HeadPose>) -> Result<Self, InputError> {
        if poses.len() != self.samples.len() {
            let problem = format!("there are {} poses of the head for {} samples", poses.len(), self.samples.len());
            return Err(InputError::invalid(self.name, problem, "give one for each sample"));
        }
        let faults = poses.iter().enumerate().filter_map(|(i, pose)| Some((i, pose.fault()?)));
        match faults.into_iter().next() {
            Some((i, fault)) => Err(InputError::invalid(self.name, format!("sample {i}: {fault}"), HeadPose::EXPECTED)),
            None => Ok(Self { poses, ..self }),
        }
    }

    /// Name in errors, usually the file's path.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Screen of the recording.
    pub fn screen(&self) -> &Screen {
        &self.screen
    }

    /// Metadata other than the screen.
    pub fn about(&self) -> &About {
        &self.about
    }

    /// All samples including lost ones, by increasing time.
    pub fn samples(&self) -> &[Sample] {
        &self.samples
    }

    /// Pose of the head at each sample; `None` if the head is not tracked.
    pub fn poses(&self) -> Option<&[HeadPose]> {
        (!self.poses.is_empty()).then_some(&self.poses[..])
    }

    /// Duration in seconds from the first to the last sample; 0 for a single one.
    pub fn duration_s(&self) -> f64 {
        self.end_s() - self.begin_s()
    }

    /// Number of samples with lost gaze.
    pub fn lost(&self) -> usize {
        self.samples.iter().filter(|s| s.px.is_none()).count()
    }

    /// Time of the first sample on the recording's clock.
    fn begin_s(&self) -> f64 {
        self.samples.first().map_or(0.0, |s| s.t_s)
    }

    /// Time of the last sample on the recording's clock.
    fn end_s(&self) -> f64 {
        self.samples.last().map_or(0.0, |s| s.t_s)
    }
}

/// Normalises metadata to the form in which it is read from a file, so that a scanpath that is written and read again
/// is unchanged.
fn normalize(about: &mut About) -> Result<(), (String, &'static str)> {
    const ONE_LINE: &str = "a header line is `# key: value` on one line, each key once";
    about.task = about.task.take().map(|t| t.trim().to_owned()).filter(|t| !t.is_empty() && t != UNKNOWN);
    if about.task.as_ref().is_some_and(|t| t.contains('\n')) {
        return Err(("the task has more than one line".into(), ONE_LINE));
    }
    if let Some(rate) = about.rate_hz.filter(|r| !(r.is_finite() && *r > 0.0)) {
        return Err((format!("the rate is {rate} Hz"), "give `rate_hz` as a number above 0, or `unknown`"));
    }
    let mut seen = std::collections::HashSet::from(RESERVED_KEYS.map(str::to_owned));
    for (key, value) in &mut about.notes {
        *key = key.trim().to_owned();
        *value = value.trim().to_owned();
        let one_line = !key.contains(['\n', ':']) && !value.contains('\n');
        if key.is_empty() || key.starts_with('#') || !one_line || !seen.insert(key.clone()) {
            return Err((format!("the note {key:?} cannot be written"), ONE_LINE));
        }
    }
    Ok(())
}
