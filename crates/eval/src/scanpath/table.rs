//! Tables of numbers as text, in the dialects of spreadsheets, R, pandas and eye trackers: columns found by name.
//!
//! Columns end at tabs, semicolons, commas or spaces, whichever gives the line of names the most columns. Cells may be
//! quoted, and a decimal comma is a decimal point. A cell `(1, 2, 3)` is three cells.

use crate::error::InputError;
use std::borrow::Cow;

/// Problem and remedy of a line.
pub(super) type LineError = (String, String);

pub(super) fn bad(problem: impl Into<String>, remedy: impl Into<String>) -> LineError {
    (problem.into(), remedy.into())
}

/// A piece of the file for a one-line message: escaped and truncated.
pub(super) fn quote(text: &str) -> String {
    const LONGEST: usize = 40;
    let cut: String = text.chars().take(LONGEST).collect();
    let dots = if cut.len() < text.len() { "..." } else { "" };
    format!("{cut:?}{dots}")
}

/// The text of a file in UTF-8 or, with a byte order mark, UTF-16.
pub(super) fn decode<'a>(name: &str, bytes: &'a [u8]) -> Result<Cow<'a, str>, InputError> {
    let wide = |read: fn([u8; 2]) -> u16| {
        let words: Vec<u16> = bytes[2..].chunks_exact(2).map(|pair| read([pair[0], pair[1]])).collect();
        String::from_utf16(&words).map(Cow::Owned).map_err(|_| {
            InputError::invalid(name, "not UTF-16 text, as its first bytes say", "save it as CSV text in UTF-8")
        })
    };
    match bytes {
        [0xff, 0xfe, ..] => return wide(u16::from_le_bytes),
        [0xfe, 0xff, ..] => return wide(u16::from_be_bytes),
        _ => {}
    }
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    std::str::from_utf8(bytes).map(Cow::Borrowed).map_err(|e| {
        let before = &bytes[..e.valid_up_to()];
        let line = 1 + before.iter().filter(|&&b| b == b'\n').count();
        InputError::invalid(format!("{name}, line {line}"), "not UTF-8 text", "give a scanpath as CSV text")
    })
}

/// The text behind `#` of a header line or comment. Spreadsheets quote it, and fill it up with empty cells.
pub(super) fn comment(line: &str) -> Option<&str> {
    match line.strip_prefix("\"#") {
        Some(quoted) => Some(quoted.trim_end_matches(FILL).trim_end_matches('"')),
        None => line.strip_prefix('#'),
    }
}

/// What spreadsheets put behind the last cell of a row.
pub(super) const FILL: [char; 4] = [',', ';', '\t', ' '];

/// Whether a cell says that there is no value.
pub(super) fn is_missing(cell: &str) -> bool {
    const WORDS: [&str; 14] =
        ["", ".", "-", "--", "na", "n/a", "#n/a", "<na>", "nan", "-nan", "nan(ind)", "-nan(ind)", "null", "none"];
    WORDS.contains(&cell.to_ascii_lowercase().as_str())
}

/// A cell as a number; `None` if it is none.
pub(super) fn number<T: std::str::FromStr>(cell: &str) -> Option<T> {
    cell.parse().ok().or_else(|| {
        let (whole, part) = cell.split_once(',')?;
        format!("{whole}.{part}").parse().ok()
    })
}

/// A cell as yes or no; `None` if it is neither.
pub(super) fn truth(cell: &str) -> Option<bool> {
    match cell.to_ascii_lowercase().as_str() {
        "true" | "t" => Some(true),
        "false" | "f" => Some(false),
        _ => match number::<f64>(cell)? {
            0.0 => Some(false),
            1.0 => Some(true),
            _ => None,
        },
    }
}

/// What ends a column.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Delimiter {
    Char(char),
    Spaces,
}

/// Cells of a line, without their quotes.
fn split(line: &str, delimiter: Delimiter) -> Vec<&str> {
    let Delimiter::Char(delimiter) = delimiter else {
        return line.split_whitespace().map(bare).collect();
    };
    let mut cells = vec![];
    let (mut begin, mut is_quoted) = (0, false);
    for (i, c) in line.char_indices() {
        if c == '"' && (is_quoted || line[begin..i].trim().is_empty()) {
            is_quoted = !is_quoted;
        } else if c == delimiter && !is_quoted {
            cells.push(bare(&line[begin..i]));
            begin = i + c.len_utf8();
        }
    }
    cells.push(bare(&line[begin..]));
    cells
}

fn bare(cell: &str) -> &str {
    let cell = cell.trim();
    cell.strip_prefix('"').and_then(|c| c.strip_suffix('"')).unwrap_or(cell).trim()
}

/// Cells of `(1, 2, 3)` or `[1, 2, 3]`.
fn tuple(cell: &str) -> Option<impl Iterator<Item = &str>> {
    let inner = cell.strip_prefix('(').and_then(|c| c.strip_suffix(')'));
    let inner = inner.or_else(|| cell.strip_prefix('[').and_then(|c| c.strip_suffix(']')))?;
    Some(inner.split(',').map(str::trim))
}

/// A column's name in lower case, in which a run of characters other than letters and digits is an underscore:
/// `Gaze point X [DACS px]` is `gaze_point_x_dacs_px`. Greek mu is `u`.
pub(super) fn plain(name: &str) -> String {
    let mut plain = String::new();
    for c in name.chars() {
        match c {
            '\u{b5}' | '\u{3bc}' => plain.push('u'),
            _ if c.is_alphanumeric() => plain.extend(c.to_lowercase()),
            _ if plain.is_empty() || plain.ends_with('_') => {}
            _ => plain.push('_'),
        }
    }
    plain.truncate(plain.trim_end_matches('_').len());
    plain
}

/// A column, or a part of one with tuples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Column {
    cell: usize,
    part: Option<usize>,
}

/// The line of names of a table.
#[derive(Debug)]
pub(super) struct Columns {
    delimiter: Delimiter,
    names: Vec<(String, Column)>,
    count: usize,
}

impl Columns {
    /// Names in `line`. `first_row` tells which columns have tuples: `gaze` then has the parts `gaze_x`, `gaze_y`, ...
    pub fn new(line: &str, first_row: &str) -> Self {
        let best = ['\t', ';', ','].into_iter().rev().max_by_key(|&c| split(line, Delimiter::Char(c)).len());
        let delimiter = best.map(Delimiter::Char).filter(|&d| split(line, d).len() > 1).unwrap_or(Delimiter::Spaces);
        let (heads, cells) = (split(line, delimiter), split(first_row, delimiter));
        let mut names = vec![];
        for (cell, name) in heads.iter().map(|name| plain(name)).enumerate() {
            let parts = cells.get(cell).and_then(|text| tuple(text)).map_or(0, Iterator::count);
            names.extend(
                ["x", "y", "z"]
                    .iter()
                    .take(parts)
                    .enumerate()
                    .map(|(part, axis)| (format!("{name}_{axis}"), Column { cell, part: Some(part) })),
            );
            names.push((name, Column { cell, part: None }));
        }
        Self { delimiter, names, count: heads.len() }
    }

    /// The column of a name as [`plain`] gives it; several are separated by `|`, and `name*` is any that starts so.
    pub fn find(&self, names: &str) -> Option<(&str, Column)> {
        names.split('|').find_map(|wanted| {
            let fits = |name: &str| match wanted.strip_suffix('*') {
                Some(start) => name.starts_with(start),
                None => name == wanted,
            };
            self.names.iter().find(|(name, _)| fits(name)).map(|(name, column)| (name.as_str(), *column))
        })
    }

    /// Names for an error, as [`plain`] gives them, at most `most`.
    pub fn names(&self, most: usize) -> String {
        let names: Vec<&str> = self.names.iter().map(|(name, _)| name.as_str()).collect();
        let more = if names.len() > most { ", ..." } else { "" };
        format!("{}{more}", names[..names.len().min(most)].join(", "))
    }

    /// Number of columns.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Cells of a row.
    pub fn row<'a>(&self, line: &'a str) -> Row<'a> {
        Row(split(line, self.delimiter))
    }
}

/// The cells of a row.
pub(super) struct Row<'a>(Vec<&'a str>);

impl<'a> Row<'a> {
    /// Number of cells, without empty ones beyond the `columns` that have names.
    pub fn count(&self, columns: usize) -> usize {
        let beyond = self.0.iter().skip(columns).rposition(|cell| !cell.is_empty());
        beyond.map_or(self.0.len().min(columns), |last| columns + last + 1)
    }

    /// Whether the row has a cell in this column.
    pub fn reaches(&self, column: Column) -> bool {
        column.cell < self.0.len()
    }

    /// A cell; empty where the row ends before it.
    pub fn cell(&self, column: Column) -> &'a str {
        let cell = self.0.get(column.cell).copied().unwrap_or_default();
        match column.part {
            Some(part) => tuple(cell).and_then(|mut parts| parts.nth(part)).unwrap_or_default(),
            None => cell,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_dialect_gives_the_same_cells() {
        for (names, row) in [
            ("t_s,x_px,y_px", "0.5,960,790.25"),
            ("t_s, x_px , y_px", " 0.5, 960 ,790.25"),
            ("\"t_s\",\"x_px\",\"y_px\"", "\"0.5\",\"960\",\"790,25\""),
            ("t_s;x_px;y_px", "0,5;960;790,25"),
            ("T_S\tX [px]\ty_px", "0.5\t960\t790.25"),
            ("t_s   x_px  y_px", "  0.5  960   790.25"),
            ("t_s,gaze (px)", "0.5,\"(960, 790.25)\""),
        ] {
            let columns = Columns::new(names, row);
            let cells = columns.row(row);
            let value = |names: &str| {
                let (_, column) = columns.find(names).unwrap_or_else(|| panic!("{names} in {columns:?}"));
                number::<f64>(cells.cell(column)).unwrap()
            };
            let values = ["t_s", "x_px|gaze_px_x", "y_*|gaze_px_y"].map(value);
            assert_eq!(values, [0.5, 960.0, 790.25], "{names}");
        }
    }

    #[test]
    fn names_are_plain_words_whatever_wrote_them() {
        for (name, expected) in [
            ("Recording timestamp [\u{3bc}s]", "recording_timestamp_us"),
            ("Recording.timestamp..\u{b5}s.", "recording_timestamp_us"),
            ("TIMETICK(f=10000000)", "timetick_f_10000000"),
            ("gaze_direct_L.x", "gaze_direct_l_x"),
            ("", ""),
        ] {
            assert_eq!(plain(name), expected);
        }
    }
}
