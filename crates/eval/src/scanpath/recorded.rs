//! Scanpath files: `# key: value` lines, column names, then one row per sample.
//!
//! ```text
//! # task: free viewing of a photograph
//! # rate_hz: 500
//! # screen_px: 1024x768
//! # screen_cm: 38.0x30.0
//! # distance_cm: 67
//! t_s,x_px,y_px,valid
//! 0.000,nan,nan,0
//! 0.002,511.09,375.05,1
//! ```
//!
//! With the pose of the head, for headsets:
//!
//! ```text
//! t_s,x_px,y_px,valid,head_x_m,head_y_m,head_z_m,head_qx,head_qy,head_qz,head_qw
//! 0.000,1000,1000,1,0,0,0,0,0,0,1
//! ```

use super::table::{Column, Columns, FILL, LineError, Row, bad, comment, decode, is_missing, number, quote, truth};
use super::{About, HeadPose, RESERVED_KEYS, Sample, Scanpath, Screen, UNKNOWN};
use crate::error::{Bound, Exceeded, InputError};
use std::fs::File;
use std::io::{Read, Write};
use std::path::Path;

/// Largest file size in bytes: 256 MiB, about three hours at 1250 Hz. Bounds the memory that a wrong path can take.
pub const MAX_FILE_BYTES: u64 = 256 << 20;

const COLUMNS: &str = "t_s,x_px,y_px,valid";

/// Further columns of a scanpath with poses of the head.
const POSE_COLUMNS: &str = "head_x_m,head_y_m,head_z_m,head_qx,head_qy,head_qz,head_qw";

/// Reads a scanpath file; its path becomes the scanpath's name.
///
/// # Errors
/// [`Io`](InputError::Io) if the file is missing or unreadable, [`Request`](InputError::Request) if it is a folder,
/// [`Limit`](InputError::Limit) if it is larger than [`MAX_FILE_BYTES`], and those of [`parse_csv`].
pub fn read_csv(path: impl AsRef<Path>) -> Result<Scanpath, InputError> {
    let (name, bytes) = bytes_of(path.as_ref())?;
    parse_csv(&name, &bytes)
}

/// Name and contents of a file of at most [`MAX_FILE_BYTES`].
pub(super) fn bytes_of(path: &Path) -> Result<(String, Vec<u8>), InputError> {
    let name = path.display().to_string();
    let unreadable = |e: std::io::Error| {
        InputError::io(&name, format!("cannot be read ({e})"), "give the path of a scanpath CSV file")
    };
    let too_large = |bytes: Option<u64>| {
        InputError::limit(
            Exceeded { bound: Bound::Fixed, needed: bytes, allowed: MAX_FILE_BYTES },
            &name,
            format!("larger than {} MiB", MAX_FILE_BYTES >> 20),
            "cut the recording to the time window that is needed",
        )
    };
    let file = File::open(path).map_err(unreadable)?;
    let meta = file.metadata().map_err(unreadable)?;
    if meta.is_dir() {
        return Err(InputError::request(name, "is a folder", "give the path of a scanpath CSV file"));
    }
    if meta.len() > MAX_FILE_BYTES {
        return Err(too_large(Some(meta.len())));
    }
    // Devices and pipes report no length, so the read is bounded, too.
    let mut bytes = Vec::new();
    file.take(MAX_FILE_BYTES + 1).read_to_end(&mut bytes).map_err(unreadable)?;
    if bytes.len() as u64 > MAX_FILE_BYTES {
        return Err(too_large(None));
    }
    Ok((name, bytes))
}

/// Parses the contents of a scanpath file; `name` is its name in errors.
///
/// Columns are found by name, in any order, and further ones are ignored: `t_s`, `x_px` and `y_px`, seconds and screen
/// pixels from the top left corner (y down), and `valid`, 1 or 0 (`TRUE`, `false`, `1.0`), which may be absent. They
/// end at commas, tabs, semicolons or spaces; decimal commas and quotes are accepted, and so are blank lines, a byte
/// order mark, UTF-16 and CRLF. A sample is lost if `valid` is 0 or a coordinate is empty, `nan`, `NA`, `.` or
/// infinite. Valid samples off the screen are kept unchanged. Of samples with equal times, the last valid one counts. A
/// measure in the header may be followed by a remark (`1024x768 (inferred)`), which becomes the note `screen_px_note`,
/// or be `unknown`; only `screen_px` must be known.
///
/// With the columns `head_x_m,head_y_m,head_z_m` and `head_qx,head_qy,head_qz,head_qw`, every row has a [`HeadPose`],
/// also where the gaze is lost. The screen is then fixed to the head.
///
/// # Errors
/// [`Invalid`](InputError::Invalid). With the line number: bytes that are not text, a header line or row that cannot be
/// parsed, a row without exactly the columns named, times that go back, an invalid pose. Without a line number: missing
/// column names, and the errors of [`Scanpath::new`].
pub fn parse_csv(name: &str, bytes: &[u8]) -> Result<Scanpath, InputError> {
    parse_table(name, &decode(name, bytes)?, &|screen| screen).map(|(path, _)| path)
}

/// Size of a screen whose header does not state it, before it is replaced.
const NO_SIZE: [u32; 2] = [0; 2];

/// Parses the text of a scanpath file. `replaced` is the screen that counts, from that of the header. Also returns what
/// was assumed.
pub(super) fn parse_table(
    name: &str,
    text: &str,
    replaced: &dyn Fn(Screen) -> Screen,
) -> Result<(Scanpath, Vec<String>), InputError> {
    let mut header = Header::default();
    let mut merged = Merged::default();
    let mut columns: Option<Own> = None;
    let mut lines = text.lines().enumerate().map(|(index, line)| (index, line.trim_matches(['\r', ' ']))).peekable();
    while let Some((index, line)) = lines.next() {
        let parsed = if line.trim().is_empty() {
            Ok(())
        } else if let Some(said) = comment(line) {
            header.line(said)
        } else if let Some(columns) = &columns {
            columns.row(line, merged.samples.last()).map(|(sample, pose)| merged.push(sample, pose))
        } else {
            let first_row = lines.peek().map_or("", |(_, row)| row);
            Own::new(line, first_row).map(|found| columns = Some(found))
        };
        parsed
            .map_err(|(problem, remedy)| InputError::invalid(format!("{name}, line {}", index + 1), problem, remedy))?;
    }
    let Some(columns) = columns else {
        let remedy = format!("the first line without # must be {COLUMNS}");
        return Err(InputError::invalid(name, "there are no column names", remedy));
    };
    let size_px = header.size_px.unwrap_or(NO_SIZE);
    let screen = replaced(Screen { size_px, size_cm: header.size_cm, distance_cm: header.distance_cm });
    if screen.size_px == NO_SIZE {
        let remedy = "state it in the header as `# screen_px: WIDTHxHEIGHT`";
        return Err(InputError::invalid(name, "the screen's size is missing", remedy));
    }
    let warnings = merged.warning(name).into_iter().collect();
    let path = Scanpath::new(name, screen, header.about, merged.samples)?;
    Ok((if columns.pose.is_some() { path.with_poses(merged.poses)? } else { path }, warnings))
}

/// Samples by time; of those with equal times, the last valid one counts.
#[derive(Default)]
pub(super) struct Merged {
    pub samples: Vec<Sample>,
    poses: Vec<HeadPose>,
    equal: usize,
}

impl Merged {
    /// Adds a sample that is not before the last one.
    pub fn push(&mut self, sample: Sample, pose: Option<HeadPose>) {
        match self.samples.last_mut() {
            Some(last) if last.t_s == sample.t_s => {
                self.equal += 1;
                if sample.px.is_some() || last.px.is_none() {
                    *last = sample;
                    if let (Some(last), Some(pose)) = (self.poses.last_mut(), pose) {
                        *last = pose;
                    }
                }
            }
            _ => {
                self.samples.push(sample);
                self.poses.extend(pose);
            }
        }
    }

    /// What to say of equal times.
    pub fn warning(&self, name: &str) -> Option<String> {
        (self.equal > 0).then(|| {
            format!("{name} has {} samples at the time of the one before; the last valid one counts", self.equal)
        })
    }
}

/// Columns of a scanpath file.
struct Own {
    columns: Columns,
    time: Column,
    at: [Column; 2],
    valid: Option<Column>,
    pose: Option<[Column; 7]>,
}

impl Own {
    fn new(line: &str, first_row: &str) -> Result<Self, LineError> {
        let columns = Columns::new(line, first_row);
        let find = |name: &str| columns.find(name).map(|(_, column)| column);
        let poses: Vec<Column> = POSE_COLUMNS.split(',').filter_map(find).collect();
        match (find("t_s"), find("x_px"), find("y_px")) {
            (Some(time), Some(x), Some(y)) if poses.is_empty() || poses.len() == 7 => {
                let (at, valid, pose) = ([x, y], find("valid"), poses.try_into().ok());
                Ok(Self { columns, time, at, valid, pose })
            }
            _ => Err(bad(
                format!("{} instead of the column names", quote(line)),
                format!(
                    "the first line without # must be {COLUMNS}, or with poses of the head {COLUMNS},{POSE_COLUMNS}"
                ),
            )),
        }
    }

    /// A row, not before the `previous` sample. The pose is `None` without columns for it.
    fn row(&self, line: &str, previous: Option<&Sample>) -> Result<(Sample, Option<HeadPose>), LineError> {
        let (row, expected) = (self.columns.row(line), self.columns.count());
        let count = row.count(expected);
        if count != expected {
            return Err(bad(format!("{count} columns in {}", quote(line)), format!("expected {expected} columns")));
        }
        let text = row.cell(self.time);
        let t_s: f64 = number(text)
            .filter(|t: &f64| t.is_finite())
            .ok_or_else(|| bad(format!("t_s is {}", quote(text)), "expected a time in seconds"))?;
        if let Some(previous) = previous.filter(|p| t_s < p.t_s) {
            return Err(bad(format!("t_s is {t_s} after {}", previous.t_s), "times must increase from row to row"));
        }
        let coordinate = |column: &str, text: &str| match number(text) {
            Some(value) => Ok(value),
            None if is_missing(text) => Ok(f32::NAN),
            None => Err(bad(
                format!("{column} is {}", quote(text)),
                "expected a number of pixels, or nan where the gaze was lost",
            )),
        };
        let px = [coordinate("x_px", row.cell(self.at[0]))?, coordinate("y_px", row.cell(self.at[1]))?];
        let valid = match self.valid.map(|column| row.cell(column)) {
            Some(text) if is_missing(text) => false,
            Some(text) => truth(text)
                .ok_or_else(|| bad(format!("valid is {}", quote(text)), "expected 1, or 0 where the gaze was lost"))?,
            None => true,
        };
        let pose = self.pose.map(|columns| pose(&row, columns)).transpose()?;
        Ok((Sample { t_s, px: (valid && px.iter().all(|v| v.is_finite())).then_some(px) }, pose))
    }
}

/// Writes the format that [`read_csv`] reads. Numbers have as many digits as an exact round trip needs, and lost
/// samples are `nan,nan,0`. The name is not written: reading the result under the same name gives an equal scanpath.
///
/// # Errors
/// Errors of `out`.
pub fn write_csv(path: &Scanpath, out: &mut impl Write) -> std::io::Result<()> {
    let about = path.about();
    let screen = path.screen();
    let known = |text: Option<String>| text.unwrap_or_else(|| UNKNOWN.into());
    let values = [
        known(about.task.clone()),
        known(about.rate_hz.map(|r| r.to_string())),
        format!("{}x{}", screen.size_px[0], screen.size_px[1]),
        known(screen.size_cm.map(|[w, h]| format!("{w}x{h}"))),
        known(screen.distance_cm.map(|d| d.to_string())),
    ];
    let mut out = std::io::BufWriter::new(out);
    for (key, value) in RESERVED_KEYS.iter().zip(&values) {
        writeln!(out, "# {key}: {value}")?;
    }
    for (key, value) in &about.notes {
        writeln!(out, "# {key}: {value}")?;
    }
    match path.poses() {
        Some(_) => writeln!(out, "{COLUMNS},{POSE_COLUMNS}")?,
        None => writeln!(out, "{COLUMNS}")?,
    }
    for (i, sample) in path.samples().iter().enumerate() {
        match sample.px {
            Some([x, y]) => write!(out, "{},{x},{y},1", sample.t_s)?,
            None => write!(out, "{},nan,nan,0", sample.t_s)?,
        }
        if let Some(poses) = path.poses() {
            let ([x, y, z], [qx, qy, qz, qw]) = (poses[i].position_m, poses[i].orientation);
            write!(out, ",{x},{y},{z},{qx},{qy},{qz},{qw}")?;
        }
        writeln!(out)?;
    }
    out.flush()
}

/// Header lines read so far.
#[derive(Default)]
struct Header {
    size_px: Option<[u32; 2]>,
    size_cm: Option<[f32; 2]>,
    distance_cm: Option<f32>,
    about: About,
    keys: std::collections::HashSet<String>,
}

impl Header {
    /// Parses a line without its leading `#`. A line without a colon is a comment.
    fn line(&mut self, line: &str) -> Result<(), LineError> {
        let Some((key, value)) = line.split_once(':') else {
            return Ok(());
        };
        let (key, value) = (key.trim(), value.trim());
        if key.is_empty() || key.starts_with('#') {
            return Ok(());
        }
        if !self.keys.insert(key.to_owned()) {
            return Err(bad(format!("{} is given a second time", quote(key)), "remove one of the two lines"));
        }
        match key {
            "task" => self.about.task = Some(value.to_owned()),
            "rate_hz" => self.about.rate_hz = self.measure(key, value, "500", positive)?,
            "screen_px" => self.size_px = self.measure(key, value, "1024x768", pair)?,
            "screen_cm" => self.size_cm = self.measure(key, value, "38.0x30.0", pair)?,
            "distance_cm" => self.distance_cm = self.measure(key, value, "67", positive)?,
            "origin" if value != UNKNOWN && !value.starts_with("top left") => {
                return Err(bad(
                    format!("the origin is {}", quote(value)),
                    "convert the coordinates to pixels from the top left corner, y down",
                ));
            }
            _ => self.about.notes.push((key.to_owned(), value.to_owned())),
        }
        Ok(())
    }

    /// Parses the first word of `value`; the rest is a remark and becomes a note. `None` for `unknown`.
    fn measure<T>(
        &mut self,
        key: &str,
        value: &str,
        example: &str,
        parse: impl Fn(&str) -> Option<T>,
    ) -> Result<Option<T>, LineError> {
        let value = value.trim_end_matches(FILL);
        let (word, remark) = value.split_once(char::is_whitespace).unwrap_or((value, ""));
        if !remark.trim().is_empty() {
            let note = format!("{key}_note");
            if self.keys.insert(note.clone()) {
                self.about.notes.push((note, remark.trim().to_owned()));
            }
        }
        if word == UNKNOWN {
            return Ok(None);
        }
        parse(word).map(Some).ok_or_else(|| {
            bad(
                format!("{key} is {}", quote(word)),
                format!("expected a measure above 0 such as {example}, or {UNKNOWN}"),
            )
        })
    }
}

fn positive<T: std::str::FromStr + Into<f64> + Copy>(text: &str) -> Option<T> {
    let value: T = text.parse().ok()?;
    let size: f64 = value.into();
    (size.is_finite() && size > 0.0).then_some(value)
}

fn pair<T: std::str::FromStr + Into<f64> + Copy>(text: &str) -> Option<[T; 2]> {
    let (a, b) = text.split_once('x')?;
    Some([positive(a)?, positive(b)?])
}

/// Pose of the head from its seven columns.
fn pose(row: &Row, columns: [Column; 7]) -> Result<HeadPose, LineError> {
    let mut values = [0.0; 7];
    for ((value, column), name) in values.iter_mut().zip(columns).zip(POSE_COLUMNS.split(',')) {
        let text = row.cell(column);
        *value = number(text)
            .filter(|v: &f32| v.is_finite())
            .ok_or_else(|| bad(format!("{name} is {}", quote(text)), HeadPose::EXPECTED))?;
    }
    let [x, y, z, qx, qy, qz, qw] = values;
    let pose = HeadPose { position_m: [x, y, z], orientation: [qx, qy, qz, qw] };
    pose.fault().map_or(Ok(pose), |fault| Err(bad(fault, HeadPose::EXPECTED)))
}
