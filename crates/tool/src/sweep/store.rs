//! The folder of a sweep: a file for every point that is done, written whole, so that nothing finished is ever lost.

use super::grid::Point;
use super::measurement::Measurement;
use afterimage_lab::error::InputError;
use afterimage_lab::whole_file::write_whole;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Largest file of a measurement that is read, bytes: a hundred times what one takes.
const MAX_BYTES: u64 = 1 << 20;
/// Largest picture that is taken from another folder, bytes: one of 4K takes two million.
const MAX_PICTURE_BYTES: u64 = 32 << 20;

/// Pictures of a point: what was shown, where it is wrong, what it should have been.
pub const PICTURES: [&str; 3] = ["shown", "error", "reference"];

/// A folder with measurements and pictures.
#[derive(Clone, Debug)]
pub struct Store {
    root: PathBuf,
}

impl Store {
    /// The folder, made if need be.
    ///
    /// # Errors
    /// If it cannot be made or written.
    pub fn create(root: &Path) -> Result<Self, InputError> {
        let refuse = |path: &Path, error: io::Error| {
            let problem = format!("cannot be written ({error})");
            InputError::io(path.display().to_string(), problem, "give --out a folder that can be made or written")
        };
        for folder in ["points", "pictures"] {
            let path = root.join(folder);
            fs::create_dir_all(&path).map_err(|e| refuse(&path, e))?;
        }
        let probe = root.join("points/.afterimage.part");
        fs::File::create(&probe).and_then(|_| fs::remove_file(&probe)).map_err(|e| refuse(&probe, e))?;
        Ok(Self { root: root.to_owned() })
    }

    /// A folder that is there.
    ///
    /// # Errors
    /// If it has no measurements.
    pub fn open(root: &Path) -> Result<Self, InputError> {
        if !root.join("points").is_dir() {
            let remedy = "expected a folder that afterimage sweep has written";
            return Err(InputError::request(root.display().to_string(), "holds no sweep", remedy));
        }
        Ok(Self { root: root.to_owned() })
    }

    /// The folder.
    pub fn root(&self) -> &Path {
        &self.root
    }

    /// Keeps a measurement.
    ///
    /// # Errors
    /// Those of the file system.
    pub fn save(&self, measurement: &Measurement) -> io::Result<()> {
        let text = serde_json::to_string_pretty(measurement).map_err(io::Error::other)?;
        write_whole(&self.file(&measurement.point), |file| file.write_all(text.as_bytes()))
    }

    /// Takes a point with its pictures from another folder, byte by byte.
    ///
    /// # Errors
    /// Those of the file system.
    pub fn adopt(&self, from: &Self, point: &Point) -> io::Result<()> {
        // The measurement last: what has one is finished.
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
    /// If a file cannot be read or is not one of ours.
    pub fn load(&self) -> Result<Vec<Measurement>, InputError> {
        let folder = self.root.join("points");
        let wrong = |path: &Path, problem: String| {
            InputError::invalid(path.display().to_string(), problem, "remove it, and the point is measured anew")
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
            // A name that its content does not give would be written elsewhere when it is merged: outside the folder, even.
            if path.file_stem().is_none_or(|name| *name != *id(&measurement.point)) {
                return Err(wrong(&path, "is not named as its point is".into()));
            }
            measurements.push(measurement);
        }
        measurements.sort_by(|a, b| a.point.cmp(&b.point));
        Ok(measurements)
    }

    /// Where a picture of a point goes: one of [`PICTURES`].
    pub fn picture(&self, point: &Point, what: &str) -> PathBuf {
        self.root.join("pictures").join(format!("{}-{what}.jpg", id(point)))
    }
}

/// The bytes of a file in the folder itself: no link out of it, and no more than `max`.
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

/// A name for files: the method, and 64 bits of all that makes the point (FNV-1a).
pub fn id(point: &Point) -> String {
    let mut hash = 0xcbf2_9ce4_8422_2325_u64;
    let mut add = |word: &str| {
        // A zero after each word keeps "a" "bc" from being "ab" "c".
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
