//! The output folder. Each file is written completely or not at all, and frames of different runs never mix.

use crate::error::InputError;
use crate::picture::write_png;
use crate::scanpath::{Scanpath, write_csv};
use crate::whole_file::write_whole;
use image::RgbImage;
use serde::Serialize;
use std::fmt::Display;
use std::fs::{self, File};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Marks the folder of a run that has not ended.
const UNFINISHED: &str = ".afterimage.unfinished";

/// A file that could not be written during the work.
#[derive(Debug, Error)]
#[error("{}: cannot be written ({problem}); {remedy}", path.display())]
pub struct WriteError {
    path: PathBuf,
    problem: String,
    remedy: &'static str,
}

impl WriteError {
    /// `path`, and why it could not be written.
    pub fn new(path: &Path, problem: impl Display) -> Self {
        Self { path: path.to_owned(), problem: problem.to_string(), remedy: "free space or choose another --out" }
    }

    /// With what to do about it.
    #[must_use]
    pub fn with_remedy(self, remedy: &'static str) -> Self {
        Self { remedy, ..self }
    }
}

/// Output folder of a run. Unless its run ends, a file marks it as unfinished, so that the next run replaces what is
/// left.
pub struct Output {
    root: PathBuf,
}

/// A CSV file that grows row by row under a temporary name.
pub struct Table {
    path: PathBuf,
    partial: PathBuf,
    file: BufWriter<File>,
}

impl Output {
    /// Creates the folder and its subfolders `parts`. Removes frames and `reports` of an earlier run, if the first of
    /// these (`report.json` or `trace.json`) shows that this tool wrote them, or that it was about to.
    pub fn create(root: &Path, parts: &[String], reports: &[&str]) -> Result<Self, InputError> {
        let refuse = |path: &Path, error: &dyn Display| {
            let remedy = "give --out a folder that can be created or written";
            InputError::io(path.display().to_string(), format!("cannot be written ({error})"), remedy)
        };
        fs::create_dir_all(root).map_err(|e| refuse(root, &e))?;
        let ours = reports.first().is_some_and(|report| {
            fs::read_to_string(root.join(report)).is_ok_and(|text| text.contains("\"tool\": \"afterimage\""))
        });
        // A run that was aborted leaves this file, and no report.
        let unfinished = root.join(UNFINISHED);
        let ours = ours || unfinished.exists();
        let mut stale = vec![];
        for part in parts {
            stale.extend(numbered_frames(&root.join(part)));
        }
        if let (false, Some(first)) = (ours, stale.first()) {
            let folder = first.parent().unwrap_or(root).display().to_string();
            let problem = "holds frames of something else, not of afterimage";
            return Err(InputError::io(folder, problem, "give --out an empty folder"));
        }
        // Create a file to check that the folder can be written.
        let probe = root.join(".afterimage.partial");
        File::create(&probe).and_then(|_| fs::remove_file(&probe)).map_err(|e| refuse(root, &e))?;
        if ours {
            stale.extend(parts.iter().flat_map(|part| cut_off(&root.join(part))));
            stale.extend(reports.iter().map(|report| root.join(report)).filter(|path| path.exists()));
        }
        for path in stale {
            fs::remove_file(&path).map_err(|e| refuse(&path, &e))?;
        }
        File::create(&unfinished).map_err(|e| refuse(&unfinished, &e))?;
        for part in parts {
            let folder = root.join(part);
            fs::create_dir_all(&folder).map_err(|e| refuse(&folder, &e))?;
        }
        Ok(Self { root: root.to_owned() })
    }

    /// Path of frame `index` of `folder`.
    pub fn path(&self, folder: &str, index: usize, ending: &str) -> PathBuf {
        self.root.join(folder).join(format!("{index:06}.{ending}"))
    }

    /// Writes frame `index` of `folder` as PNG.
    pub fn picture(&self, folder: &str, index: usize, picture: &RgbImage) -> Result<(), WriteError> {
        let path = self.path(folder, index, "png");
        write_png(&path, picture).map_err(|e| WriteError::new(&path, e))
    }

    /// Writes a PNG into the root of the folder.
    pub fn root_picture(&self, name: &str, picture: &RgbImage) -> Result<(), WriteError> {
        let path = self.root.join(name);
        write_png(&path, picture).map_err(|e| WriteError::new(&path, e))
    }

    /// Writes gaze positions as CSV, one row per frame.
    pub fn gaze(&self, name: &str, gaze_px: &[[f32; 2]]) -> Result<(), WriteError> {
        let mut table = self.table(name, "frame,x_px,y_px")?;
        for (i, [x, y]) in gaze_px.iter().enumerate() {
            table.row(&format!("{i},{x:.3},{y:.3}"))?;
        }
        table.finish()
    }

    /// Writes a text file.
    pub fn text(&self, name: &str, text: &str) -> Result<(), WriteError> {
        write_text(&self.root.join(name), text)
    }

    /// Writes a scanpath.
    pub fn scanpath(&self, name: &str, scanpath: &Scanpath) -> Result<(), WriteError> {
        let path = self.root.join(name);
        write_whole(&path, |file| write_csv(scanpath, file)).map_err(|e| WriteError::new(&path, e))
    }

    /// Writes a report.
    pub fn json(&self, name: &str, report: &impl Serialize) -> Result<(), WriteError> {
        write_json(Some(&self.root.join(name)), report)
    }

    /// Ends the run: the folder is whole.
    pub fn finish(self) -> Result<(), WriteError> {
        let unfinished = self.root.join(UNFINISHED);
        fs::remove_file(&unfinished).map_err(|e| WriteError::new(&unfinished, e))
    }

    /// Starts a CSV table under a temporary name.
    pub fn table(&self, name: &str, header: &str) -> Result<Table, WriteError> {
        let path = self.root.join(name);
        let partial = self.root.join(format!("{name}.partial"));
        let file = File::create(&partial).map_err(|e| WriteError::new(&partial, e))?;
        let mut table = Table { path, partial, file: BufWriter::new(file) };
        table.row(header)?;
        Ok(table)
    }
}

impl Table {
    /// Adds a row.
    pub fn row(&mut self, row: &str) -> Result<(), WriteError> {
        writeln!(self.file, "{row}").map_err(|e| WriteError::new(&self.partial, e))
    }

    /// Flushes the table and renames it to its final name.
    pub fn finish(mut self) -> Result<(), WriteError> {
        self.file
            .flush()
            .and_then(|()| fs::rename(&self.partial, &self.path))
            .map_err(|e| WriteError::new(&self.path, e))
    }
}

/// Writes a text file.
pub fn write_text(path: &Path, text: &str) -> Result<(), WriteError> {
    write_whole(path, |file| file.write_all(text.as_bytes())).map_err(|e| WriteError::new(path, e))
}

/// A cell of CSV.
pub fn csv_cell(text: &str) -> String {
    if text.contains([',', '"', '\n']) { format!("\"{}\"", text.replace('"', "\"\"")) } else { text.to_owned() }
}

/// Writes a report, if it is asked for.
pub fn write_json(path: Option<&Path>, report: &impl Serialize) -> Result<(), WriteError> {
    let Some(path) = path else { return Ok(()) };
    let write = |file: &mut BufWriter<File>| {
        serde_json::to_writer_pretty(&mut *file, report)?;
        writeln!(file)
    };
    write_whole(path, write).map_err(|e| WriteError::new(path, e))
}

/// Temporary files of writes that were cut off.
fn cut_off(folder: &Path) -> Vec<PathBuf> {
    let is_part = |path: &PathBuf| {
        let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        name.starts_with('.') && name.ends_with(".part")
    };
    entries(folder).filter(is_part).collect()
}

/// Paths in a folder; none if it does not exist.
fn entries(folder: &Path) -> impl Iterator<Item = PathBuf> {
    fs::read_dir(folder).into_iter().flatten().filter_map(|e| Some(e.ok()?.path()))
}

/// Files such as `000000.png` in a folder; empty if the folder does not exist.
fn numbered_frames(folder: &Path) -> Vec<PathBuf> {
    let is_frame = |path: &PathBuf| {
        let ending = path.extension().and_then(|e| e.to_str());
        let stem = path.file_stem().and_then(|s| s.to_str()).unwrap_or_default();
        matches!(ending, Some("png" | "exr")) && stem.len() == 6 && stem.bytes().all(|b| b.is_ascii_digit())
    };
    entries(folder).filter(is_frame).collect()
}
