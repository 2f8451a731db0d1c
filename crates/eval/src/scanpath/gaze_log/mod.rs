//! Gaze logs: scanpath files, and the exports of eye trackers as they are.
//!
//! ```text
//! table of a dialect -> layout of a vendor -> samples -> scanpath on a screen
//! EyeLink's ASC text ----------------------^
//! ```

mod asc;
mod clock_time;
mod layouts;
mod named;
mod options;
mod rows;
mod samples;

use super::recorded::{bytes_of, parse_table};
use super::table::{Columns, comment, decode, quote};
use super::{Scanpath, Screen};
use crate::error::InputError;
use layouts::{LAYOUTS, Layout};
pub use named::{GazeColumns, GazeUnit};
pub use options::{Eye, GazeLogOptions, Vendor};
use std::path::Path;

/// A gaze log that was read.
#[derive(Clone, Debug, PartialEq)]
pub struct GazeLog {
    /// Its scanpath, in screen pixels and seconds.
    pub scanpath: Scanpath,
    /// Whose export it is; `None`: a scanpath file.
    pub vendor: Option<Vendor>,
    /// What was assumed or looks wrong, one line each: those of [`Scanpath::warnings`], and of reading.
    pub warnings: Vec<String>,
}

/// Reads a gaze log; its path becomes the scanpath's name. Formats are found by the contents, not by the name.
///
/// # Errors
/// Those of [`read_csv`](super::read_csv), and of [`parse_gaze_log`].
pub fn read_gaze_log(path: impl AsRef<Path>, options: &GazeLogOptions) -> Result<GazeLog, InputError> {
    let (name, bytes) = bytes_of(path.as_ref())?;
    parse_gaze_log(&name, &bytes, options)
}

/// Reads a table in the columns that are named, and not as the export of a vendor that it may be.
///
/// # Errors
/// Those of [`read_csv`](super::read_csv); [`Request`](InputError::Request) if a column does not exist, or gaze is in
/// pixels of a screen of unknown size; [`Invalid`](InputError::Invalid) for cells that cannot be read.
pub fn read_gaze_columns(
    path: impl AsRef<Path>,
    columns: &GazeColumns,
    options: &GazeLogOptions,
) -> Result<GazeLog, InputError> {
    let (name, bytes) = bytes_of(path.as_ref())?;
    parse_gaze_columns(&name, &bytes, columns, options)
}

/// Parses the contents of a table as [`read_gaze_columns`] does; `name` is its name in errors.
///
/// # Errors
/// Those of [`read_gaze_columns`] that are not of the file system.
pub fn parse_gaze_columns(
    name: &str,
    bytes: &[u8],
    columns: &GazeColumns,
    options: &GazeLogOptions,
) -> Result<GazeLog, InputError> {
    let text = decode(name, bytes)?;
    let samples = named::samples(name, &text, &columns_of(&text), columns)?;
    let (scanpath, mut warnings) = samples.placed(name, options)?;
    warnings.extend(scanpath.warnings());
    Ok(GazeLog { scanpath, vendor: None, warnings })
}

/// The columns of a table, by its line of names.
fn columns_of(text: &str) -> Columns {
    let mut lines = text.lines().filter(|line| !line.trim().is_empty() && comment(line.trim()).is_none());
    let heads = lines.next().unwrap_or_default();
    Columns::new(heads, lines.next().unwrap_or_default())
}

/// Parses the contents of a gaze log; `name` is its name in errors. Times of an eye tracker begin at 0.
///
/// # Errors
/// [`Invalid`](InputError::Invalid) for a damaged file, one of another kind, and several recordings in one;
/// [`Request`](InputError::Request) if the file lacks the gaze of the eye that is asked for, or gaze is in pixels of a
/// screen of unknown size.
pub fn parse_gaze_log(name: &str, bytes: &[u8], options: &GazeLogOptions) -> Result<GazeLog, InputError> {
    if bytes.starts_with(b"SR_RESEARCH") {
        let problem = "is an EyeLink recording (EDF), which only SR Research's programs read";
        return Err(InputError::not_supported(name, problem, "convert it with edf2asc, and give the .asc file"));
    }
    let text = decode(name, bytes)?;
    let is_asc = match options.from {
        None => asc::is_asc(&text),
        Some(vendor) => vendor == Vendor::Eyelink && (asc::is_asc(&text) || asc::is_samples(&text)),
    };
    let samples = match is_asc {
        true => Some(asc::samples(name, &text, options.eye)?),
        false => match layout_of(name, &text, options)? {
            Some((layout, columns)) => Some(rows::samples(name, &text, layout, &columns, options.eye)?),
            None => None,
        },
    };
    let vendor = samples.as_ref().and_then(|samples| samples.vendor);
    let (scanpath, mut warnings) = match samples {
        Some(samples) => samples.placed(name, options)?,
        None => parse_table(name, &text, &|screen| replaced(screen, options))?,
    };
    warnings.extend(scanpath.warnings());
    Ok(GazeLog { scanpath, vendor, warnings })
}

/// The screen of a file, with what the options say instead.
fn replaced(screen: Screen, options: &GazeLogOptions) -> Screen {
    Screen {
        size_px: options.screen_px.unwrap_or(screen.size_px),
        size_cm: options.screen_mm.map(|mm| mm.map(|v| v / 10.0)).or(screen.size_cm),
        distance_cm: options.distance_mm.map(|mm| mm / 10.0).or(screen.distance_cm),
    }
}

/// The layout of a table, and its columns; `None`: a scanpath file.
fn layout_of(
    name: &str,
    text: &str,
    options: &GazeLogOptions,
) -> Result<Option<(&'static Layout, Columns)>, InputError> {
    let from = options.from;
    let columns = columns_of(text);
    let mut lines = text.lines().filter(|line| !line.trim().is_empty() && comment(line.trim()).is_none());
    let heads = lines.next().unwrap_or_default();
    let is_own = ["t_s", "x_px", "y_px"].iter().all(|column| columns.find(column).is_some());
    if from.is_none() && (is_own || heads.is_empty()) {
        return Ok(None);
    }
    // The size of a picture alone: the log's pixels are those of that picture, such as a scene camera's.
    let is_picture = options.screen_px.is_some() && options.screen_mm.is_none() && options.distance_mm.is_none();
    let fitting = || LAYOUTS.iter().filter(|l| from.is_none_or(|vendor| l.vendor == vendor) && l.fits(&columns));
    let found = fitting().find(|l| !(is_picture && l.plane.is_angular())).or_else(|| fitting().next());
    match (found, from) {
        (Some(layout), _) => Ok(Some((layout, columns))),
        (None, Some(vendor)) => {
            let wanted: Vec<_> = LAYOUTS.iter().filter(|l| l.vendor == vendor).map(Layout::expected).collect();
            let asc = if vendor == Vendor::Eyelink { ", or the ASC text of edf2asc" } else { "" };
            Err(InputError::invalid(
                name,
                format!("{} has no time and gaze of {}", quote(heads), vendor.name()),
                format!("expected the columns {}{asc}", wanted.join(", or ")),
            ))
        }
        (None, None) => {
            let vendors: Vec<_> = Vendor::ALL.iter().map(|v| v.name()).collect();
            Err(InputError::invalid(
                name,
                format!("{} instead of the column names of a scanpath or of an eye tracker's export", quote(heads)),
                format!(
                    "expected t_s,x_px,y_px,valid, or an export of {}, as docs/gaze-logs.md lists them; of another \
                     table, name the columns with `gaze_columns`",
                    vendors.join(", ")
                ),
            ))
        }
    }
}
