//! Options of gaze logs: what a file does not say of its screen, and which eye counts.

use super::gaze_columns::{NamedColumns, TimeUnit, parse_columns};
use super::gaze_layout::{GazeLayout, parse_layout};
use super::{by_name, parse_distance_mm, parse_size, parse_size_mm};
use crate::failure::Failure;
use afterimage_lab::scanpath::{Eye, GazeColumns, GazeLog, GazeLogOptions, GazeUnit, Vendor};
use afterimage_lab::scanpath::{read_gaze_columns, read_gaze_log};
use clap::Args;
use std::path::Path;

/// Heading of these options in the help.
const HEADING: &str = "Gaze logs";

/// Screen of a gaze log.
#[derive(Args, Clone, Debug, Default)]
pub struct GazeLogArgs {
    /// Screen of a gaze log, pixels; default: the file's. For gaze in pixels of a picture: the picture's size
    #[arg(long, value_parser = parse_size, value_name = "WxH", help_heading = HEADING)]
    pub screen_px: Option<[u32; 2]>,
    /// Screen of a gaze log, millimeters; default: the file's
    #[arg(long, value_parser = parse_size_mm, value_name = "WxH", help_heading = HEADING)]
    pub screen_mm: Option<[f32; 2]>,
    /// Distance of the screen of a gaze log, millimeters; default: the file's
    #[arg(long, value_parser = parse_distance_mm, value_name = "D", help_heading = HEADING)]
    pub distance_mm: Option<f32>,
    /// Gaze of a log with both eyes; default: both
    #[arg(long, value_parser = by_name::<Eye>(), help_heading = HEADING)]
    pub eye: Option<Eye>,
    /// Columns of a gaze log that is no known export: t=NAME,x=NAME,y=NAME[,z=NAME][,valid=NAME]; with z, a direction;
    /// -NAME turns an axis around, valid=!NAME inverts
    #[arg(long, value_name = "LIST", value_parser = parse_columns, help_heading = HEADING)]
    pub gaze_columns: Option<NamedColumns>,
    /// With --gaze-columns: unit of x and y; default: px
    #[arg(long, value_name = "UNIT", value_parser = by_name::<GazeUnit>(), requires = "gaze_columns", help_heading = HEADING)]
    pub gaze_unit: Option<GazeUnit>,
    /// With --gaze-columns: unit of t; default: auto, as its name says, else that with 5 to 5000 samples a second
    #[arg(long, value_name = "UNIT", value_parser = by_name::<TimeUnit>(), requires = "gaze_columns", help_heading = HEADING)]
    pub time_unit: Option<TimeUnit>,
    /// The options from --screen-px to --time-unit of a data set, as JSON (docs/gaze-logs.md); options replace what it
    /// says of the screen and the eye
    #[arg(long, value_name = "FILE.json", value_parser = parse_layout, conflicts_with = "gaze_columns", help_heading = HEADING)]
    pub gaze_layout: Option<GazeLayout>,
}

impl GazeLogArgs {
    /// Reads a log, of a given vendor or found out.
    pub fn read(&self, file: &str, from: Option<Vendor>) -> Result<GazeLog, Failure> {
        let given = self.with_layout();
        let Self { screen_px, screen_mm, distance_mm, eye, .. } = given;
        let options = GazeLogOptions { from, eye: eye.unwrap_or_default(), screen_px, screen_mm, distance_mm };
        let Some(named) = given.gaze_columns else {
            return Ok(read_gaze_log(Path::new(file), &options)?);
        };
        let NamedColumns { time, at, valid } = named;
        let per_second = match given.time_unit {
            Some(TimeUnit::PerSecond(ticks)) => Some(ticks),
            Some(TimeUnit::Auto) | None => None,
        };
        let columns = GazeColumns { time, at, valid, unit: given.gaze_unit.unwrap_or_default(), per_second };
        Ok(read_gaze_columns(Path::new(file), &columns, &options)?)
    }

    /// The options that were given, and those of the layout where there are none.
    fn with_layout(&self) -> Self {
        let Some(of) = self.gaze_layout.clone() else { return self.clone() };
        Self {
            screen_px: self.screen_px.or(of.screen_px),
            screen_mm: self.screen_mm.or(of.screen_mm),
            distance_mm: self.distance_mm.or(of.distance_mm),
            eye: self.eye.or(of.eye),
            gaze_columns: of.columns,
            gaze_unit: of.unit,
            time_unit: of.time_unit,
            gaze_layout: None,
        }
    }

    /// Refuses the options for a `subject` that is no gaze log.
    pub fn refuse_for(&self, subject: &str) -> Result<(), Failure> {
        let given = [
            (self.screen_px.is_some(), "--screen-px"),
            (self.screen_mm.is_some(), "--screen-mm"),
            (self.distance_mm.is_some(), "--distance-mm"),
            (self.eye.is_some(), "--eye"),
            (self.gaze_columns.is_some(), "--gaze-columns"),
            (self.gaze_layout.is_some(), "--gaze-layout"),
        ];
        match given.iter().find(|(is_given, _)| *is_given) {
            Some((_, option)) => Err(Failure::Input(format!(
                "{option}: {subject} is not a gaze log; give the file of one, or leave the option out"
            ))),
            None => Ok(()),
        }
    }
}
