//! FovVideoVDP of a clip, from a program that this project does not contain.

use super::camera::{FPS, HFOV_DEG};
use super::clip::{Clip, ROWS};
use crate::error::AnyError;
use afterimage_lab::picture::write_png;
use image::RgbImage;
use rayon::prelude::*;
use serde::Deserialize;
use std::fs;
use std::path::Path;
use std::process::Command;

const GAZE: &str = "gaze.csv";
const REFERENCE: &str = "reference";

/// What is read of the program's output.
#[derive(Deserialize)]
struct Judged {
    fvvdp_jod: f64,
}

/// Writes the frames of a clip as folders of PNG files, and the gaze.
pub fn write_frames(clip: &Clip, folder: &Path) -> Result<(), AnyError> {
    write_row(&folder.join(REFERENCE), &clip.reference)?;
    for (name, row) in ROWS.iter().zip(&clip.rows) {
        write_row(&folder.join(folder_name(name)), &row.frames)?;
    }
    // (0, 0) is the middle of the first pixel.
    let gaze = clip.gazes_px.iter().enumerate().map(|(i, [x, y])| format!("{i},{},{}\n", x - 0.5, y - 0.5));
    fs::write(folder.join(GAZE), format!("frame,x_px,y_px\n{}", gaze.collect::<String>()))?;
    Ok(())
}

fn write_row(folder: &Path, frames: &[RgbImage]) -> Result<(), AnyError> {
    // Frames of an earlier, longer clip would be scored, too.
    if folder.exists() {
        fs::remove_dir_all(folder)?;
    }
    fs::create_dir_all(folder)?;
    for (i, frame) in frames.iter().enumerate() {
        write_png(&folder.join(format!("{i:04}.png")), frame)?;
    }
    Ok(())
}

fn folder_name(row: &str) -> String {
    row.split(|c: char| !c.is_ascii_alphanumeric()).filter(|word| !word.is_empty()).collect::<Vec<_>>().join("_")
}

/// FovVideoVDP of each row, from the frames that [`write_frames`] wrote.
pub fn fvvdp_jod(command: &[String], clip: &Clip, folder: &Path) -> Result<Vec<f64>, AnyError> {
    // One thread each.
    ROWS[..clip.rows.len()].par_iter().map(|name| judge_row(command, folder, &folder_name(name))).collect()
}

fn judge_row(command: &[String], folder: &Path, row: &str) -> Result<f64, AnyError> {
    let result = folder.join(format!("{row}.json"));
    let output = Command::new(&command[0])
        .args(&command[1..])
        .args(["--metrics", "fvvdp", "--fps", &FPS.to_string(), "--width-deg", &HFOV_DEG.to_string()])
        .arg("--ref")
        .arg(folder.join(REFERENCE))
        .arg("--test")
        .arg(folder.join(row))
        .arg("--gaze")
        .arg(folder.join(GAZE))
        .arg("--json")
        .arg(&result)
        .output()
        .map_err(|e| format!("{}: {e}", command[0]))?;
    if !output.status.success() {
        let text = String::from_utf8_lossy(&output.stderr);
        return Err(
            format!("the judge ends with {}: {}", output.status, text.lines().last().unwrap_or_default()).into()
        );
    }
    let judged: Judged = serde_json::from_slice(&fs::read(&result)?)?;
    Ok(judged.fvvdp_jod)
}
