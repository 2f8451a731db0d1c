//! Options of gaze logs: what a file does not say of its screen, and which eye counts.

use super::{Named, by_name, parse_distance_mm, parse_size, parse_size_mm};
use crate::failure::Failure;
use afterimage_lab::scanpath::{Eye, GazeColumns, GazeLog, GazeLogOptions, GazeUnit, Vendor};
use afterimage_lab::scanpath::{read_gaze_columns, read_gaze_log};
use clap::Args;
use std::collections::BTreeMap;
use std::path::Path;

/// Screen of a gaze log.
#[derive(Args, Clone, Debug, Default)]
pub struct GazeLogArgs {
    /// Screen of a gaze log, pixels; default: the file's. For gaze in pixels of a picture: the picture's size
    #[arg(long, value_parser = parse_size, value_name = "WxH")]
    pub screen_px: Option<[u32; 2]>,
    /// Screen of a gaze log, millimeters; default: the file's
    #[arg(long, value_parser = parse_size_mm, value_name = "WxH")]
    pub screen_mm: Option<[f32; 2]>,
    /// Distance of the screen of a gaze log, millimeters; default: the file's
    #[arg(long, value_parser = parse_distance_mm, value_name = "D")]
    pub distance_mm: Option<f32>,
    /// Gaze of a log with both eyes; default: both
    #[arg(long, value_parser = by_name::<Eye>())]
    pub eye: Option<Eye>,
    /// Columns of a gaze log that is no known export: t=NAME,x=NAME,y=NAME[,z=NAME][,valid=NAME]; with z, a direction;
    /// -NAME turns an axis around, valid=!NAME inverts
    #[arg(long, value_name = "LIST", value_parser = parse_columns)]
    pub gaze_columns: Option<NamedColumns>,
    /// With --gaze-columns: unit of x and y; default: px
    #[arg(long, value_name = "UNIT", value_parser = by_name::<GazeUnit>(), requires = "gaze_columns")]
    pub gaze_unit: Option<GazeUnit>,
    /// With --gaze-columns: unit of t; default: auto, as its name says, else that with 5 to 5000 samples a second
    #[arg(long, value_name = "UNIT", value_parser = by_name::<TimeUnit>(), requires = "gaze_columns")]
    pub time_unit: Option<TimeUnit>,
}

/// Values of `--gaze-columns`.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedColumns {
    time: String,
    at: Vec<String>,
    valid: Option<String>,
}

fn parse_columns(text: &str) -> Result<NamedColumns, String> {
    const EXPECTED: &str = "expected t=NAME,x=NAME,y=NAME, and z=NAME and valid=NAME where there are";
    let mut given = BTreeMap::new();
    for part in text.split(',') {
        let (key, name) = part.split_once('=').ok_or(EXPECTED)?;
        let is_known = ["t", "x", "y", "z", "valid"].contains(&key.trim());
        if !is_known || name.trim().is_empty() || given.insert(key.trim(), name.trim().to_owned()).is_some() {
            return Err(EXPECTED.into());
        }
    }
    let mut take = |key: &str| given.remove(key);
    let (Some(time), Some(x), Some(y)) = (take("t"), take("x"), take("y")) else { return Err(EXPECTED.into()) };
    Ok(NamedColumns { time, at: [Some(x), Some(y), take("z")].into_iter().flatten().collect(), valid: take("valid") })
}

impl Named for GazeUnit {
    fn rows() -> Vec<(Self, &'static str, &'static str)> {
        vec![
            (Self::Pixels, "px", "Screen pixels from the top left corner, y down"),
            (Self::Shares, "norm", "0 to 1 of the screen, y down"),
            (Self::Degrees, "deg", "Visual angles, degrees, y up"),
            (Self::Radians, "rad", "Visual angles, radians, y up"),
            (Self::Sphere, "lonlat", "Longitude and latitude, degrees, y up; the middle of the view is 0,0"),
        ]
    }
}

/// Values of `--time-unit`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TimeUnit {
    Auto,
    PerSecond(f64),
}

impl Named for TimeUnit {
    fn rows() -> Vec<(Self, &'static str, &'static str)> {
        vec![
            (Self::Auto, "auto", "As the name says, else by the step"),
            (Self::PerSecond(1.0), "s", "Seconds"),
            (Self::PerSecond(1e3), "ms", "Milliseconds"),
            (Self::PerSecond(1e6), "us", "Microseconds"),
            (Self::PerSecond(1e9), "ns", "Nanoseconds"),
        ]
    }
}

impl Named for Eye {
    fn rows() -> Vec<(Self, &'static str, &'static str)> {
        vec![
            (Self::Both, "both", "The tracker's gaze of both eyes, else the mean of the valid ones"),
            (Self::Left, "left", "The left eye's"),
            (Self::Right, "right", "The right eye's"),
        ]
    }
}

impl GazeLogArgs {
    /// Reads a log, of a given vendor or found out.
    pub fn read(&self, file: &str, from: Option<Vendor>) -> Result<GazeLog, Failure> {
        let &Self { screen_px, screen_mm, distance_mm, eye, .. } = self;
        let options = GazeLogOptions { from, eye: eye.unwrap_or_default(), screen_px, screen_mm, distance_mm };
        let Some(named) = &self.gaze_columns else {
            return Ok(read_gaze_log(Path::new(file), &options)?);
        };
        let NamedColumns { time, at, valid } = named.clone();
        let per_second = match self.time_unit {
            Some(TimeUnit::PerSecond(ticks)) => Some(ticks),
            Some(TimeUnit::Auto) | None => None,
        };
        let columns = GazeColumns { time, at, valid, unit: self.gaze_unit.unwrap_or_default(), per_second };
        Ok(read_gaze_columns(Path::new(file), &columns, &options)?)
    }

    /// Refuses the options for a `subject` that is no gaze log.
    pub fn refuse_for(&self, subject: &str) -> Result<(), Failure> {
        let given = [
            (self.screen_px.is_some(), "--screen-px"),
            (self.screen_mm.is_some(), "--screen-mm"),
            (self.distance_mm.is_some(), "--distance-mm"),
            (self.eye.is_some(), "--eye"),
            (self.gaze_columns.is_some(), "--gaze-columns"),
        ];
        match given.iter().find(|(is_given, _)| *is_given) {
            Some((_, option)) => Err(Failure::Input(format!(
                "{option}: {subject} is not a gaze log; give the file of one, or leave the option out"
            ))),
            None => Ok(()),
        }
    }
}
