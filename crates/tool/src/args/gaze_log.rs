//! Options of gaze logs: what a file does not say of its screen, and which eye counts.

use super::{Named, by_name, parse_distance_mm, parse_size, parse_size_mm};
use crate::failure::Failure;
use afterimage_lab::scanpath::{Eye, GazeLog, GazeLogOptions, Vendor, read_gaze_log};
use clap::Args;
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
        let &Self { screen_px, screen_mm, distance_mm, eye } = self;
        let options = GazeLogOptions { from, eye: eye.unwrap_or_default(), screen_px, screen_mm, distance_mm };
        Ok(read_gaze_log(Path::new(file), &options)?)
    }

    /// Refuses the options for a `subject` that is no gaze log.
    pub fn refuse_for(&self, subject: &str) -> Result<(), Failure> {
        let given = [
            (self.screen_px.is_some(), "--screen-px"),
            (self.screen_mm.is_some(), "--screen-mm"),
            (self.distance_mm.is_some(), "--distance-mm"),
            (self.eye.is_some(), "--eye"),
        ];
        match given.iter().find(|(is_given, _)| *is_given) {
            Some((_, option)) => Err(Failure::Input(format!(
                "{option}: {subject} is not a gaze log; give the file of one, or leave the option out"
            ))),
            None => Ok(()),
        }
    }
}
