//! Columns of a gaze log by name, and their units.

use super::Named;
use afterimage_lab::scanpath::{Eye, GazeUnit};
use std::collections::BTreeMap;

/// Values of `--gaze-columns`.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedColumns {
    pub time: String,
    pub at: Vec<String>,
    pub valid: Option<String>,
}

/// `t=NAME,x=NAME,y=NAME[,z=NAME][,valid=NAME]`.
pub fn parse_columns(text: &str) -> Result<NamedColumns, String> {
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
