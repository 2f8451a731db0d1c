//! Columns that the user names: of a tracker that no layout knows, or of one's own logger.

use super::layouts::{Plane, Validity};
use super::rows::{Found, Reader, per_second};
use super::samples::Samples;
use crate::error::InputError;
use crate::scanpath::table::{Column, Columns, plain, quote};

/// Columns of a gaze log, by name. Case and punctuation do not matter: `Gaze X [px]` is `gaze_x_px`.
#[derive(Clone, Debug, PartialEq)]
pub struct GazeColumns {
    /// Time.
    pub time: String,
    /// Gaze to the right and, in pixels and shares, downwards, else upwards; with a third column a direction with x to
    /// the right, y up and z ahead. A minus in front turns an axis around.
    pub at: Vec<String>,
    /// Validity: above 0, true, or `valid`; with `!` in front the opposite. `None`: gaze is lost where its cells are
    /// empty.
    pub valid: Option<String>,
    /// Unit of the gaze.
    pub unit: GazeUnit,
    /// Ticks a second of the time; `None`: as its name says, else that with 5 to 5000 samples a second.
    pub per_second: Option<f64>,
}

/// Unit of gaze.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum GazeUnit {
    /// Screen pixels from the top left corner.
    #[default]
    Pixels,
    /// Shares of the screen from the top left corner.
    Shares,
    /// Visual angles in degrees: azimuth to the right, elevation up.
    Degrees,
    /// The same in radians.
    Radians,
    /// Longitude to the right and latitude up in degrees, from the middle of the view.
    Sphere,
}

impl GazeUnit {
    fn plane(self) -> Plane {
        match self {
            Self::Pixels => Plane::Pixels,
            Self::Shares => Plane::Fractions,
            Self::Degrees | Self::Sphere => Plane::Angles,
            Self::Radians => Plane::Radians,
        }
    }
}

/// The samples of a table in the columns that are named.
///
/// # Errors
/// [`Request`](InputError::Request) if there are not two or three columns of gaze, a column does not exist, or pixels
/// are to be turned around; [`Invalid`](InputError::Invalid) with the line for cells that cannot be read.
pub(super) fn samples(name: &str, text: &str, columns: &Columns, named: &GazeColumns) -> Result<Samples, InputError> {
    let plane = match named.at.len() {
        2 => named.unit.plane(),
        3 => Plane::Forward,
        count => {
            let problem = format!("{count} columns of gaze are named");
            return Err(InputError::request(name, problem, "name those of x and y, or of a direction's x, y and z"));
        }
    };
    let find = |wanted: &str| -> Result<(&str, Column), InputError> {
        columns.find(&plain(wanted)).ok_or_else(|| {
            let problem = format!("has no column {}", quote(wanted));
            InputError::request(name, problem, format!("it has {}", columns.names(MOST_NAMED)))
        })
    };
    let (time_name, time) = find(&named.time)?;
    let mut at = vec![];
    let mut is_turned = [false; 3];
    for (axis, wanted) in named.at.iter().enumerate() {
        let bare = wanted.strip_prefix('-');
        is_turned[axis] = bare.is_some();
        at.push(find(bare.unwrap_or(wanted))?);
    }
    if plane == Plane::Pixels && is_turned.contains(&true) {
        let remedy = "state the gaze as shares of the screen, or convert it to pixels from the top left";
        return Err(InputError::request(name, "an axis of pixels cannot be turned around", remedy));
    }
    let validity = named.valid.as_ref().map(|wanted| {
        let bare = wanted.strip_prefix('!');
        Ok::<_, InputError>((bare.is_some(), find(bare.unwrap_or(wanted))?.1))
    });
    let (is_inverted, valid) =
        validity.transpose()?.map_or((false, vec![]), |(inverted, column)| (inverted, vec![column]));
    let place = Found { rule: Validity::Truth { is_inverted }, at, is_turned, valid };
    let mut reader = Reader::new(columns, plane, time, vec![place]);
    reader.skips_text = true;
    let per_second = named.per_second.or_else(|| per_second(time_name));
    reader.samples(name, text, Samples::new(None, "named by its columns", plane, per_second))
}

/// Columns that an error lists.
const MOST_NAMED: usize = 24;
