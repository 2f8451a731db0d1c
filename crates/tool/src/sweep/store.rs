//! The folder of a sweep: one file per finished point, written atomically, so that finished work is never lost.

use super::grid::Point;
use super::measurement::Measurement;
use afterimage_lab::error::InputError;
use afterimage_lab::whole_file::write_whole;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Size limit of a measurement's file, bytes: a hundred times the usual size.
const MAX_BYTES: u64 = 1 << 20;
/// Size limit of a picture from another folder, bytes: a 4K picture takes two million.
const MAX_PICTURE_BYTES: u64 = 32 << 20;

/// Pictures of a point: output of the method, error map, reference.
pub const PICTURES: [&str; 3] = ["shown", "error", "reference"];

/// Folder of measurements and pictures.
#[derive(Clone, Debug)]
pub struct Store {
    root: PathBuf,
}

impl Store {
    /// Opens a folder, creating it if necessary.
    ///
    /// # Errors
    /// If the folder cannot be created or written.
    pub fn create(root: &Path) -> Result<Self, InputError> {
        let refuse = |path: &Path, error: io::Error| {
            let problem = format!("cannot be written ({error})");
            InputError::io(path.display().to_string(), problem, "give --out a folder that can be created or written")
        };
        for folder in ["points", "pictures"] {
            let path = root.join(folder);
            fs::create_dir_all(&path).map_err(|e| refuse(&path, e))?;
        }
        let probe = root.join("points/.afterimage.part");
        fs::File::create(&probe).and_then(|_| fs::remove_file(&probe)).map_err(|e| refuse(&probe, e))?;
        Ok(Self { root: root.to_owned() })
    }

    /// Opens an existing folder.
    ///
    /// # Errors
    /// If the folder does not belong to a sweep.
    pub fn open(root: &Path) -> Result<Self, InputError> {
        if !root.join("points").is_dir() {
            let remedy = "expected the --out folder of an earlier afterimage sweep";
            return Err(InputError::request(root.display().to_string(), "holds no sweep", remedy));
        }
        Ok(Self { root: root.to_owned() })
    }

    /// The folder.
    pub fn root(&self) -> &Path {
        &self.root
    }

    /// Saves a measurement.
    ///
    /// # Errors
    /// If a file cannot be read or written.
    pub fn save(&self, measurement: &Measurement) -> io::Result<()> {
        let text = serde_json::to_string_pretty(measurement).map_err(io::Error::other)?;
        write_whole(&self.file(&measurement.point), |file| file.write_all(text.as_bytes()))
    }

    /// Copies a point and its pictures from another folder.
    ///
    /// # Errors
    /// If a file cannot be read or written.
    pub fn adopt(&self, from: &Self, point: &Point) -> io::Result<()> {
        // The measurement last, since it marks the point as finished.
        for what in PICTURES {
            match read_own(&from.picture(point, what), MAX_PICTURE_BYTES) {
                Ok(bytes) => write_whole(&self.picture(point, what), |file| file.write_all(&bytes))?,
                Err(error) if error.kind() == io::ErrorKind::NotFound => {}
                Err(error) => return Err(error),
            }
        }
        let bytes = read_own(&from.file(point), MAX_BYTES)?;
        write_whole(&self.file(point), |file| file.write_all(&bytes))
    }

    fn file(&self, point: &Point) -> PathBuf {
        self.root.join("points").join(format!("{}.json", id(point)))
    }

    /// All measurements, in the order of their points.
    ///
    /// # Errors
    /// If a file cannot be read, or does not contain a measurement.
    pub fn load(&self) -> Result<Vec<Measurement>, InputError> {
        let folder = self.root.join("points");
        let wrong = |path: &Path, problem: String| {
            InputError::invalid(path.display().to_string(), problem, "remove it, and the point is measured again")
        };
        let entries = fs::read_dir(&folder).map_err(|e| wrong(&folder, format!("cannot be read ({e})")))?;
        let mut measurements = vec![];
        for path in entries.filter_map(|e| Some(e.ok()?.path())) {
            if path.extension().is_none_or(|e| e != "json") {
                continue;
            }
            let text = read_own(&path, MAX_BYTES).map_err(|e| wrong(&path, format!("cannot be read ({e})")))?;
            let measurement: Measurement =
                serde_json::from_slice(&text).map_err(|e| wrong(&path, format!("is no measurement ({e})")))?;
            // A merge names files by their content. Reject a mismatch, which could lead outside the folder.
            if path.file_stem().is_none_or(|name| *name != *id(&measurement.point)) {
                return Err(wrong(&path, "does not have its point's name".into()));
            }
            measurements.push(measurement);
        }
        measurements.sort_by(|a, b| a.point.cmp(&b.point));
        Ok(measurements)
    }

    /// Path of a picture of a point; `what`: one of [`PICTURES`].
    pub fn picture(&self, point: &Point, what: &str) -> PathBuf {
        self.root.join("pictures").join(format!("{}-{what}.jpg", id(point)))
    }
}

/// Reads a file of at most `max` bytes. Rejects links, which could lead outside the folder.
fn read_own(path: &Path, max: u64) -> io::Result<Vec<u8>> {
    let facts = fs::symlink_metadata(path)?;
    if !facts.is_file() {
        return Err(io::Error::other("is a link or a folder; expected a file"));
    }
    if facts.len() > max {
        return Err(io::Error::other(format!("has {} bytes; expected at most {max}", facts.len())));
    }
    fs::read(path)
}

/// File name of a point: the method, and a 64-bit FNV-1a hash of input, options and seed.
pub fn id(point: &Point) -> String {
    let mut hash = 0xcbf2_9ce4_8422_2325_u64;
    let mut add = |word: &str| {
        // Hash a zero after each word, so that "a", "bc" and "ab", "c" differ.
        for byte in word.bytes().chain([0]) {
            hash = (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    };
    add(&point.input);
    point.options.iter().for_each(|(name, value)| {
        add(name);
        add(value);
    });
    add(&point.seed.to_string());
    format!("{}-{hash:016x}", point.method)
}
