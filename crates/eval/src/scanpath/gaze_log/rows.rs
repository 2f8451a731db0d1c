//! Rows of a vendor's table as samples.

use super::clock_time;
use super::layouts::{Layout, Place, Plane, Unit, Validity};
use super::options::Eye;
use super::samples::{Clock, Raw, Samples};
use crate::error::InputError;
use crate::scanpath::table::{Column, Columns, LineError, Row, bad, comment, is_missing, number, quote, truth};

impl Layout {
    /// Whether a table has the time and some gaze of this layout.
    pub fn fits(&self, columns: &Columns) -> bool {
        let has = |place: &Place| !place.at.is_empty() && place.at.iter().all(|name| columns.find(name).is_some());
        self.time(columns).is_some() && [self.both, self.left, self.right].iter().any(has)
    }

    /// The columns that are needed, for errors.
    pub fn expected(&self) -> String {
        let first = |names: &str| names.split('|').next().unwrap_or_default().to_owned();
        let place = if self.both.at.is_empty() { self.left } else { self.both };
        let names: Vec<_> = [self.time[0].0].iter().chain(place.at).map(|names| first(names)).collect();
        names.join(" ")
    }

    /// Time column, and its ticks a second, if they are known.
    fn time(&self, columns: &Columns) -> Option<(Column, Option<f64>)> {
        self.time.iter().find_map(|(names, unit)| {
            let (name, column) = columns.find(names)?;
            let per_second = match unit {
                Unit::PerSecond(ticks) => Some(*ticks),
                Unit::Named => per_second(name),
            };
            Some((column, per_second))
        })
    }
}

/// Ticks a second of a time column with this name.
pub(super) fn per_second(name: &str) -> Option<f64> {
    const UNITS: [(&str, f64); 5] = [
        ("100ns", 1e7),
        ("ns|nsec|nanoseconds", 1e9),
        ("us|usec|microseconds", 1e6),
        ("ms|msec|millis|milliseconds", 1e3),
        ("s|sec|secs|seconds", 1.0),
    ];
    let last = name.rsplit('_').next().unwrap_or(name);
    let unit = UNITS.iter().find(|(words, _)| words.split('|').any(|word| word == last)).map(|(_, ticks)| *ticks);
    let frequency = || name.rsplit_once("_f_")?.1.parse().ok().filter(|ticks| *ticks >= 1.0);
    unit.or_else(frequency)
}

/// Columns of a place that is in a table.
pub(super) struct Found<'a> {
    pub rule: Validity,
    pub at: Vec<(&'a str, Column)>,
    /// Axes that point the other way.
    pub is_turned: [bool; 3],
    pub valid: Vec<Column>,
}

impl<'a> Found<'a> {
    fn new(rule: Validity, place: &Place, columns: &'a Columns) -> Option<Self> {
        let at: Vec<_> = place.at.iter().map_while(|names| columns.find(names)).collect();
        let valid = place.valid.iter().filter_map(|names| Some(columns.find(names)?.1)).collect();
        (!at.is_empty() && at.len() == place.at.len()).then_some(Self { rule, at, is_turned: [false; 3], valid })
    }

    /// Whether a row has text where gaze would be, or ends before it.
    fn is_text(&self, row: &Row) -> bool {
        let is_text = |cell: &str| !is_missing(cell) && number::<f64>(cell).is_none();
        self.at.iter().any(|(_, column)| is_text(row.cell(*column)) || !row.reaches(*column))
    }

    /// The gaze in a row; `None` where it is lost.
    fn read(&self, plane: Plane, row: &Row) -> Result<Option<[f64; 2]>, LineError> {
        let mut is_valid = self.valid.is_empty();
        for &column in &self.valid {
            is_valid |= self.rule.holds(row.cell(column))?;
        }
        let mut values = [0.0; 3];
        for (value, (name, column)) in values.iter_mut().zip(&self.at) {
            *value = coordinate(name, row.cell(*column))?;
        }
        for (value, _) in values.iter_mut().zip(self.is_turned).filter(|(_, is_turned)| *is_turned) {
            *value = if plane == Plane::Fractions { 1.0 - *value } else { -*value };
        }
        let read = &values[..plane.axes()];
        Ok((is_valid && read.iter().all(|v| v.is_finite())).then(|| flat(plane, values)).flatten())
    }
}

impl Validity {
    /// Whether a cell says that the sample is valid.
    fn holds(self, cell: &str) -> Result<bool, LineError> {
        let refused = |expected: &str| bad(format!("the validity is {}", quote(cell)), format!("expected {expected}"));
        if is_missing(cell) {
            return Ok(self == Self::NoFlag);
        }
        let value = truth(cell).map(|is_true| f64::from(u8::from(is_true))).or_else(|| number::<f64>(cell));
        let value = |expected: &str| value.ok_or_else(|| refused(expected));
        Ok(match self {
            Self::Flag => value("0 or 1")? > 0.0,
            Self::NoFlag => value("0 or 1")? == 0.0,
            Self::Word => match cell.to_ascii_lowercase().as_str() {
                "valid" => true,
                "invalid" => false,
                _ => return Err(refused("Valid or Invalid")),
            },
            Self::Truth { is_inverted } => {
                let is_word = cell.eq_ignore_ascii_case("valid");
                let is_true = is_word || !cell.eq_ignore_ascii_case("invalid") && value("0 or 1, or a word")? > 0.0;
                is_true != is_inverted
            }
            Self::Code => value("0 to 4")? <= 1.0,
            Self::AtLeast(least) => value("a number")? >= least,
            Self::Mask => {
                let mask = value("0 to 31")?;
                mask == 1.0 || mask as u64 & 2 != 0
            }
        })
    }
}

fn coordinate(name: &str, cell: &str) -> Result<f64, LineError> {
    if is_missing(cell) {
        return Ok(f64::NAN);
    }
    number(cell)
        .ok_or_else(|| bad(format!("{name} is {}", quote(cell)), "expected a number, or nothing where gaze is lost"))
}

/// A place on its plane, x to the right and y down: pixels, shares of the screen, or tangents of visual angles. `None`
/// for directions that no screen ahead shows.
fn flat(plane: Plane, [x, y, z]: [f64; 3]) -> Option<[f64; 2]> {
    match plane {
        Plane::Pixels | Plane::Fractions => Some([x, y]),
        Plane::FractionsUp => Some([x, 1.0 - y]),
        Plane::Forward => (z > 0.0).then(|| [x / z, -y / z]),
        Plane::ForwardLeft => (z > 0.0).then(|| [-x / z, -y / z]),
        Plane::Angles | Plane::Radians => {
            let (azimuth, elevation) = if plane == Plane::Angles { (x.to_radians(), y.to_radians()) } else { (x, y) };
            (azimuth.cos() > 0.0 && elevation.cos() > 0.0).then(|| [azimuth.tan(), -elevation.tan() / azimuth.cos()])
        }
    }
}

/// The columns of a table that samples need.
pub(super) struct Reader<'a> {
    columns: &'a Columns,
    plane: Plane,
    time: Column,
    places: Vec<Found<'a>>,
    /// Only rows with this word are samples.
    only: Option<(Column, &'static str)>,
    blink: Option<Column>,
    screen_px: Option<[Column; 2]>,
    /// Whether rows with text instead of gaze are events, and not errors.
    pub skips_text: bool,
}

/// The samples of a table.
///
/// # Errors
/// [`Invalid`](InputError::Invalid) with the line for cells that cannot be read;
/// [`Request`](InputError::Request) for an eye that the table lacks.
pub(super) fn samples(
    name: &str,
    text: &str,
    layout: &'static Layout,
    columns: &Columns,
    eye: Eye,
) -> Result<Samples, InputError> {
    let found = |place: &'static Place| Found::new(layout.rule, place, columns);
    let places: Vec<_> = match eye {
        Eye::Both => match found(&layout.both) {
            Some(both) => vec![both],
            None => [found(&layout.left), found(&layout.right)].into_iter().flatten().collect(),
        },
        Eye::Left => found(&layout.left).into_iter().collect(),
        Eye::Right => found(&layout.right).into_iter().collect(),
    };
    let Some((time, per_second)) = layout.time(columns).filter(|_| !places.is_empty()) else {
        return Err(no_eye(name, eye));
    };
    let reader = Reader {
        only: layout.rows.and_then(|(names, word)| Some((columns.find(names)?.1, word))),
        blink: layout.blink.and_then(|names| Some(columns.find(names)?.1)),
        screen_px: layout.screen_px.and_then(|[w, h]| Some([columns.find(w)?.1, columns.find(h)?.1])),
        ..Reader::new(columns, layout.plane, time, places)
    };
    reader.samples(name, text, Samples::new(Some(layout.vendor), layout.writer, layout.plane, per_second))
}

impl<'a> Reader<'a> {
    /// Every row is a sample.
    pub fn new(columns: &'a Columns, plane: Plane, time: Column, places: Vec<Found<'a>>) -> Self {
        Self { columns, plane, time, places, only: None, blink: None, screen_px: None, skips_text: false }
    }

    /// Adds the samples of all rows.
    pub fn samples(&self, name: &str, text: &str, mut samples: Samples) -> Result<Samples, InputError> {
        let is_row = |line: &str| !line.trim().is_empty() && comment(line.trim()).is_none();
        let rows = || text.lines().enumerate().filter(|(_, line)| is_row(line)).skip(1);
        // The first time tells whether all of them are clock times.
        let times = rows().map(|(_, line)| self.columns.row(line).cell(self.time));
        let first_time = times.into_iter().find(|cell| !is_missing(cell));
        let is_clock_time =
            first_time.is_some_and(|cell| Clock::parse(cell).is_none() && clock_time::parse(cell).is_some());
        if is_clock_time {
            samples.per_second = Some(clock_time::PER_SECOND);
        }
        for (index, line) in rows() {
            let read = self.read(line, is_clock_time, &mut samples);
            read.map_err(|(problem, remedy)| {
                InputError::invalid(format!("{name}, line {}", index + 1), problem, remedy)
            })?;
        }
        Ok(samples)
    }

    /// Adds the sample of a row, if it is one.
    fn read(&self, line: &str, is_clock_time: bool, samples: &mut Samples) -> Result<(), LineError> {
        let (row, named) = (self.columns.row(line), self.columns.count());
        let count = row.count(named);
        if count > named {
            return Err(bad(
                format!("{count} columns in {}", quote(line)),
                format!("expected the {named} columns that have names"),
            ));
        }
        if self.only.is_some_and(|(column, word)| !row.cell(column).eq_ignore_ascii_case(word)) {
            return Ok(());
        }
        if let (None, Some(size)) = (samples.screen_px, self.screen_px) {
            let [w, h] = size.map(|column| number::<u32>(row.cell(column)).filter(|n| *n > 0));
            samples.screen_px = w.zip(h).map(|(w, h)| [w, h]);
        }
        if self.skips_text && self.places.iter().any(|place| place.is_text(&row)) {
            samples.skipped += 1;
            return Ok(());
        }
        let parse = if is_clock_time { clock_time::parse } else { Clock::parse };
        let Some(clock) = clock(row.cell(self.time), parse)? else { return Ok(()) };
        let is_blink = self.blink.is_some_and(|column| {
            let cell = row.cell(column);
            !is_missing(cell) && truth(cell) != Some(false)
        });
        let mut seen = vec![];
        for place in &self.places {
            seen.extend(place.read(self.plane, &row)?);
        }
        samples.raw.push(Raw { clock, at: mean(&seen).filter(|_| !is_blink) });
        Ok(())
    }
}

/// The mean of the places that are valid.
pub(super) fn mean(seen: &[[f64; 2]]) -> Option<[f64; 2]> {
    let axis = |i: usize| seen.iter().map(|at| at[i]).sum::<f64>() / seen.len() as f64;
    (!seen.is_empty()).then(|| [axis(0), axis(1)])
}

/// A time cell; `None` in rows without one, which hold events.
fn clock(cell: &str, parse: fn(&str) -> Option<Clock>) -> Result<Option<Clock>, LineError> {
    if is_missing(cell) {
        return Ok(None);
    }
    let expected = "expected a number of seconds, milliseconds or the like, or a time as 2021-04-05T12:00:00.25Z";
    parse(cell).map(Some).ok_or_else(|| bad(format!("the time is {}", quote(cell)), expected))
}

/// The error for a log without the gaze that is asked for.
pub(super) fn no_eye(name: &str, eye: Eye) -> InputError {
    let side = match eye {
        Eye::Both => "either eye",
        Eye::Left => "the left eye",
        Eye::Right => "the right eye",
    };
    InputError::request(name, format!("has no gaze of {side} alone"), "choose another `eye`, or leave it out")
}
