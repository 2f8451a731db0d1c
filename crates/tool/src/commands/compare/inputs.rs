//! Inputs of a comparison: frames that belong together, and what is known of their view.

use crate::failure::{Failure, warn};
use afterimage::Image;
use afterimage_eval::exposure::{Chosen, Exposure};
use afterimage_eval::metric;
use afterimage_lab::source::{ColorFrames, ReadLimits};
use serde::Deserialize;
use std::fs;
use std::path::Path;

/// Reference and tests.
pub struct Inputs {
    pub reference: ColorFrames,
    /// Each with a name of its own.
    pub tests: Vec<(String, ColorFrames)>,
}

/// What files say of the view.
#[derive(Clone, Copy, Debug, Default)]
pub struct Stated {
    pub fps: Option<f32>,
    pub hfov_deg: Option<f32>,
}

/// An sRGB-encoded frame.
pub struct Encoded {
    pub image: Image<[f32; 3]>,
    /// Pixels that were NaN or infinite and are black.
    pub nonfinite: u64,
}

impl Inputs {
    /// Opens the inputs, which must have one size, for `most` frames or all. `color`: layer of EXR frames.
    pub fn open(
        reference: &str,
        tests: &[String],
        limits: &ReadLimits,
        most: Option<u64>,
        color: Option<&str>,
    ) -> Result<Self, Failure> {
        let names = names(tests)?;
        let open = |input: &str| ColorFrames::open_named(input, limits, most, color);
        let reference = open(reference)?;
        let tests = tests.iter().map(|input| open(input)).collect::<Result<Vec<_>, _>>()?;
        if color.is_some() && ![&reference].into_iter().chain(&tests).any(ColorFrames::is_linear) {
            let problem = "--color: names a layer of .exr frames, and there are none; leave it out";
            return Err(Failure::Input(problem.into()));
        }
        for test in &tests {
            check_size(&reference, test)?;
            warn_of_numbers(&reference, test);
        }
        for frames in [&reference].into_iter().chain(&tests) {
            warn(frames.warnings());
        }
        Ok(Self { reference, tests: names.into_iter().zip(tests).collect() })
    }

    /// Width and height of all frames in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.reference.size()
    }

    /// Reference and tests.
    fn all(&self) -> impl Iterator<Item = &ColorFrames> {
        [&self.reference].into_iter().chain(self.tests.iter().map(|test| &test.1))
    }

    /// Number of frames to compare. Without a request, all inputs must have as many.
    pub fn frames(&self, requested: Option<u64>) -> Result<usize, Failure> {
        let fewest = self.all().map(ColorFrames::len).min().unwrap_or(0);
        let Some(requested) = requested else {
            let count = self.reference.len();
            return match self.all().find(|frames| frames.len() != count) {
                None => Ok(count),
                Some(other) => Err(Failure::Input(format!(
                    "{}: has {} frames, and the reference {} has {count}; give as many, or --frames {fewest} to compare \
                     the first {fewest}",
                    other.name(),
                    other.len(),
                    self.reference.name()
                ))),
            };
        };
        match self.all().find(|frames| (frames.len() as u64) < requested) {
            None => Ok(requested as usize),
            Some(short) => Err(Failure::Input(format!(
                "--frames {requested}: {} has {}; expected at most {fewest}",
                short.name(),
                short.len()
            ))),
        }
    }

    /// What the files say, the reference first.
    pub fn stated(&self) -> Stated {
        let runs: Vec<Stated> = self.all().map(|frames| of_run(Path::new(frames.name()))).collect();
        Stated {
            fps: self.all().find_map(ColorFrames::fps).or(runs.iter().find_map(|run| run.fps)),
            hfov_deg: self.all().find_map(ColorFrames::hfov_deg).or(runs.iter().find_map(|run| run.hfov_deg)),
        }
    }

    /// The exposure of linear frames, for the first frame of the first linear input.
    pub fn exposure(&self, requested: Exposure) -> Result<Chosen, Failure> {
        match self.all().find(|frames| frames.is_linear()) {
            Some(linear) => Ok(requested.choose(&linear.read(0)?.color, 1.0)),
            None if requested == Exposure::Stops(0.0) => Ok(Chosen { ev: 0.0, found: false, hint: None }),
            None => Err(Failure::Input(
                "--exposure: applies to linear frames (.exr), and these are encoded already; leave it out".into(),
            )),
        }
    }

    /// Reads a frame of all inputs in turn, the reference first.
    pub fn read(&self, index: usize, exposure_ev: f32, as_black: bool) -> Result<Vec<Encoded>, Failure> {
        self.all().map(|frames| read(frames, index, exposure_ev, as_black)).collect()
    }
}

fn read(frames: &ColorFrames, index: usize, exposure_ev: f32, as_black: bool) -> Result<Encoded, Failure> {
    let frame = frames.read(index)?;
    if frame.nonfinite > 0 && !as_black {
        return Err(Failure::Input(format!(
            "{}: has {} pixels that are NaN or infinite; render it again, or score them as black with \
             --nonfinite-as-black",
            frames.file(index).display(),
            frame.nonfinite
        )));
    }
    let exposure_ev = if frames.is_linear() { exposure_ev } else { 0.0 };
    Ok(Encoded { image: metric::encode(&frame.color, exposure_ev), nonfinite: frame.nonfinite })
}

/// Names of the tests in reports: that of the folder or file, or the whole path where two would be alike.
fn names(tests: &[String]) -> Result<Vec<String>, Failure> {
    if let Some(twice) = (1..tests.len()).find(|&i| tests[..i].contains(&tests[i])) {
        return Err(Failure::Input(format!("{}: is named twice; leave one out", tests[twice])));
    }
    let short = |test: &String| {
        let name = Path::new(test).file_name().and_then(|name| name.to_str());
        name.unwrap_or(test).to_owned()
    };
    let names: Vec<String> = tests.iter().map(short).collect();
    let is_unique = (1..names.len()).all(|i| !names[..i].contains(&names[i]));
    Ok(if is_unique { names } else { tests.to_vec() })
}

fn check_size(reference: &ColorFrames, test: &ColorFrames) -> Result<(), Failure> {
    let ([w, h], [w0, h0]) = (test.size(), reference.size());
    if [w, h] == [w0, h0] {
        return Ok(());
    }
    Err(Failure::Input(format!(
        "{}: has {w}x{h} pixels, and the reference {} has {w0}x{h0}; give both at the size that is shown",
        test.name(),
        reference.name()
    )))
}

/// Frames are paired by their order, which may not be what their numbers mean.
fn warn_of_numbers(reference: &ColorFrames, test: &ColorFrames) {
    if let (Some(a), Some(b)) = (reference.first_number(), test.first_number())
        && a != b
    {
        warn(&[format!(
            "{}: starts with frame {b}, and the reference {} with {a}; they are compared in this order",
            test.name(),
            reference.name()
        )]);
    }
}

/// Fields of the `report.json` of a run.
#[derive(Deserialize)]
struct RunReport {
    tool: String,
    command: Option<String>,
    fps: f32,
    hfov_deg: f32,
}

fn report_of_run(folder: &Path) -> Option<RunReport> {
    let report: RunReport = serde_json::from_slice(&fs::read(folder.join("report.json")).ok()?).ok()?;
    (report.tool == "afterimage" && report.command.is_none()).then_some(report)
}

/// Whether a run wrote this folder.
pub fn is_of_run(folder: &Path) -> bool {
    report_of_run(folder).is_some()
}

/// What the report of a run says of one of its folders of frames.
fn of_run(frames: &Path) -> Stated {
    let Some(report) = frames.canonicalize().ok().and_then(|path| report_of_run(path.parent()?)) else {
        return Stated::default();
    };
    Stated { fps: Some(report.fps), hfov_deg: Some(report.hfov_deg) }
}
