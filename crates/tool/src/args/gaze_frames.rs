//! `gaze.csv` of a run as `--gaze`: a frame pixel for each frame.

use crate::failure::Failure;
use std::fs::{self, File};
use std::io::Read;

/// First line of `gaze.csv`.
const HEADER: &str = "frame,x_px,y_px";

/// Gaze of each frame, in frame pixels; `None` if the file is none that a run wrote.
pub fn read(file: &str) -> Result<Option<Vec<[f32; 2]>>, Failure> {
    let mut first = [0; HEADER.len()];
    let starts = File::open(file).and_then(|mut file| file.read_exact(&mut first));
    if starts.is_err() || first != *HEADER.as_bytes() {
        return Ok(None);
    }
    let refuse = |problem: String| Failure::Input(format!("{file}: {problem}; expected {HEADER}, a row a frame"));
    let text = fs::read_to_string(file).map_err(|e| refuse(format!("cannot be read ({e})")))?;
    let lines = text.lines().enumerate().skip(1).filter(|(_, line)| !line.trim().is_empty());
    let rows: Vec<[f32; 2]> = lines
        .enumerate()
        .map(|(frame, (line, text))| {
            position(frame, text).ok_or_else(|| refuse(format!("line {} is {text}", line + 1)))
        })
        .collect::<Result<_, _>>()?;
    if rows.is_empty() {
        return Err(refuse("has no frame".into()));
    }
    Ok(Some(rows))
}

/// Position in the row of a frame.
fn position(frame: usize, row: &str) -> Option<[f32; 2]> {
    let cells: Vec<&str> = row.split(',').map(str::trim).collect();
    let [number, x, y] = cells.as_slice() else { return None };
    let px = [x.parse().ok()?, y.parse().ok()?];
    (number.parse() == Ok(frame) && px.iter().all(|v: &f32| v.is_finite())).then_some(px)
}
