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

/// Number of columns without and with poses.
const COUNTS: [usize; 2] = [4, 11];

/// Reads a scanpath file; its path becomes the scanpath's name.
///
/// # Errors
/// [`Io`](InputError::Io) if the file is missing or unreadable, [`Request`](InputError::Request) if it is a folder,
/// [`Limit`](InputError::Limit) if it is larger than [`MAX_FILE_BYTES`], and those of [`parse_csv`].
pub fn read_csv(path: impl AsRef<Path>) -> Result<Scanpath, InputError> {
    let path = path.as_ref();
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
    parse_csv(&name, &bytes)
}

/// Parses the contents of a scanpath file; `name` is its name in errors.
///
/// Columns are `t_s,x_px,y_px,valid`: seconds, screen pixels from the top left corner (y down), 1 or 0. A sample is
/// lost if `valid` is 0 or a coordinate is empty, `nan` or infinite. Valid samples off the screen are kept unchanged. A
/// measure in the header may be followed by a remark (`1024x768 (inferred)`), which becomes the note `screen_px_note`,
/// or be `unknown`; only `screen_px` must be known. Blank lines, a byte order mark and CRLF are accepted.
///
/// The columns `head_x_m,head_y_m,head_z_m` and `head_qx,head_qy,head_qz,head_qw` may follow: the [`HeadPose`] in every
/// row, also where the gaze is lost. The screen is then fixed to the head.
///
/// # Errors
/// [`Invalid`](InputError::Invalid). With the line number: bytes that are not UTF-8, a header line or row that cannot
/// be parsed, a row without exactly the columns named, times that do not increase, an invalid pose. Without a line
/// number: missing column names, and the errors of [`Scanpath::new`].
pub fn parse_csv(name: &str, bytes: &[u8]) -> Result<Scanpath, InputError> {
    let text = utf8(name, bytes)?;
    let mut header = Header::default();
    let mut samples: Vec<Sample> = Vec::new();
    let mut poses: Vec<HeadPose> = Vec::new();
    // Number of columns, once their names are read.
    let mut columns: Option<usize> = None;
    for (index, line) in text.lines().enumerate() {
        let line = line.trim();
        let parsed = if line.is_empty() {
            Ok(())
        } else if let Some(comment) = line.strip_prefix('#') {
            header.line(comment)
        } else if let Some(count) = columns {
            row(line, count, samples.last()).map(|(sample, pose)| {
                samples.push(sample);
                poses.extend(pose);
            })
        } else if let Some(count) = named_columns(line) {
            columns = Some(count);
            Ok(())
        } else {
            Err(bad(
                format!("{} instead of the column names", quote(line)),
                format!(
                    "the first line without # must be {COLUMNS}, or with poses of the head {COLUMNS},{POSE_COLUMNS}"
                ),
            ))
        };
        parsed
            .map_err(|(problem, remedy)| InputError::invalid(format!("{name}, line {}", index + 1), problem, remedy))?;
    }
    let Some(columns) = columns else {
        return Err(InputError::invalid(
            name,
            "there are no column names",
            format!("the first line without # must be {COLUMNS}"),
        ));
    };
    let Some(size_px) = header.size_px else {
        return Err(InputError::invalid(
            name,
            "the screen's size is missing",
            "state it in the header as `# screen_px: WIDTHxHEIGHT`",
        ));
    };
    let screen = Screen { size_px, size_cm: header.size_cm, distance_cm: header.distance_cm };
    let path = Scanpath::new(name, screen, header.about, samples)?;
    if columns == COUNTS[1] { path.with_poses(poses) } else { Ok(path) }
}

/// Number of columns, if a line has their names.
fn named_columns(line: &str) -> Option<usize> {
    let names = || line.split(',').map(str::trim);
    let count = if names().eq(COLUMNS.split(',')) {
        COUNTS[0]
    } else if names().eq(COLUMNS.split(',').chain(POSE_COLUMNS.split(','))) {
        COUNTS[1]
    } else {
        return None;
    };
    Some(count)
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

/// Problem and remedy of a line.
type LineError = (String, String);

fn bad(problem: impl Into<String>, remedy: impl Into<String>) -> LineError {
    (problem.into(), remedy.into())
}

/// A piece of the file for a one-line message: escaped and truncated.
fn quote(text: &str) -> String {
    const LONGEST: usize = 40;
    let cut: String = text.chars().take(LONGEST).collect();
    let dots = if cut.len() < text.len() { "..." } else { "" };
    format!("{cut:?}{dots}")
}

fn utf8<'a>(name: &str, bytes: &'a [u8]) -> Result<&'a str, InputError> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    std::str::from_utf8(bytes).map_err(|e| {
        let before = &bytes[..e.valid_up_to()];
        let line = 1 + before.iter().filter(|&&b| b == b'\n').count();
        InputError::invalid(format!("{name}, line {line}"), "not UTF-8 text", "give a scanpath as CSV text")
    })
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

/// A row of `expected` columns. The pose is `None` without columns for it.
fn row(line: &str, expected: usize, previous: Option<&Sample>) -> Result<(Sample, Option<HeadPose>), LineError> {
    let mut fields = [""; COUNTS[1]];
    let mut count = 0;
    for field in line.split(',') {
        if let Some(slot) = fields.get_mut(count) {
            *slot = field.trim();
        }
        count += 1;
    }
    if count != expected {
        let names = if expected == COUNTS[0] { COLUMNS.to_owned() } else { format!("{COLUMNS},{POSE_COLUMNS}") };
        return Err(bad(
            format!("{count} columns in {}", quote(line)),
            format!("expected the {expected} columns {names}"),
        ));
    }
    let t_s: f64 = number(fields[0])
        .filter(|t: &f64| t.is_finite())
        .ok_or_else(|| bad(format!("t_s is {}", quote(fields[0])), "expected a time in seconds"))?;
    if let Some(previous) = previous.filter(|p| t_s <= p.t_s) {
        return Err(bad(format!("t_s is {t_s} after {}", previous.t_s), "times must increase from row to row"));
    }
    let coordinate = |column: &str, text: &str| {
        if text.is_empty() {
            return Ok(f32::NAN);
        }
        number(text).ok_or_else(|| {
            bad(format!("{column} is {}", quote(text)), "expected a number of pixels, or nan where the gaze was lost")
        })
    };
    let px = [coordinate("x_px", fields[1])?, coordinate("y_px", fields[2])?];
    let valid = match fields[3] {
        "1" => px.iter().all(|v| v.is_finite()),
        "0" => false,
        other => {
            return Err(bad(format!("valid is {}", quote(other)), "expected 1, or 0 where the gaze was lost"));
        }
    };
    let pose = if expected == COUNTS[1] { Some(pose(&fields[COUNTS[0]..])?) } else { None };
    Ok((Sample { t_s, px: valid.then_some(px) }, pose))
}

/// Pose of the head from its seven columns.
fn pose(fields: &[&str]) -> Result<HeadPose, LineError> {
    let mut values = [0.0; 7];
    for ((value, text), column) in values.iter_mut().zip(fields).zip(POSE_COLUMNS.split(',')) {
        *value = number(text)
            .filter(|v: &f32| v.is_finite())
            .ok_or_else(|| bad(format!("{column} is {}", quote(text)), HeadPose::EXPECTED))?;
    }
    let [x, y, z, qx, qy, qz, qw] = values;
    let pose = HeadPose { position_m: [x, y, z], orientation: [qx, qy, qz, qw] };
    pose.fault().map_or(Ok(pose), |fault| Err(bad(fault, HeadPose::EXPECTED)))
}

fn number<T: std::str::FromStr>(text: &str) -> Option<T> {
    text.parse().ok()
}
