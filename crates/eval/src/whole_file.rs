//! Atomic file writes: a file is written completely or not at all. Devices and pipes are written directly.

use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

/// Links that are followed from one to the next, as many as Linux follows.
const MOST_LINKS: usize = 40;

/// Writes `path` with the contents that `fill` produces: into a temporary file in the same folder, which is then
/// renamed. Readers never see a partial file, and an existing file stays intact if anything fails. A link stays, and
/// the file that it names is written. Devices, pipes and open files (`/dev/stdout`) get the contents directly.
///
/// # Errors
/// Errors of the file system and of `fill`; the temporary file is then removed.
pub fn write_whole(path: &Path, fill: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>) -> io::Result<()> {
    let filled = |file: File| {
        let mut file = BufWriter::new(file);
        fill(&mut file)?;
        file.flush()
    };
    let path = match Destination::of(path)? {
        // Appended, because the shell may have opened a file for what it appends.
        Destination::Stream(path) => return filled(OpenOptions::new().append(true).open(path)?),
        Destination::Regular(path) => path,
    };
    let temporary = temporary_name(&path)?;
    let write = || {
        filled(File::create(&temporary)?)?;
        fs::rename(&temporary, &path)
    };
    write().inspect_err(|_| {
        // Report the first error, not that of the clean-up.
        let _ = fs::remove_file(&temporary);
    })
}

/// What a path names behind its links.
#[derive(Debug, PartialEq)]
enum Destination {
    /// A regular file, or none yet.
    Regular(PathBuf),
    /// A device, a pipe, or an open file of a process: a rename would replace it.
    Stream(PathBuf),
}

impl Destination {
    fn of(path: &Path) -> io::Result<Self> {
        let mut path = path.to_owned();
        for _ in 0..=MOST_LINKS {
            // The files that processes have open; links lead from there to names that may not exist.
            if path.starts_with("/proc") || path.starts_with("/dev/fd") {
                return Ok(Self::Stream(path));
            }
            let Ok(kind) = fs::symlink_metadata(&path).map(|meta| meta.file_type()) else {
                return Ok(Self::Regular(path));
            };
            if !kind.is_symlink() {
                let is_stream = !kind.is_file() && !kind.is_dir();
                return Ok(if is_stream { Self::Stream(path) } else { Self::Regular(path) });
            }
            path = path.parent().unwrap_or(Path::new("")).join(fs::read_link(&path)?);
        }
        Err(io::Error::other("too many links"))
    }
}

/// A path in the folder of `path` that no other process or call uses.
fn temporary_name(path: &Path) -> io::Result<PathBuf> {
    static COUNT: AtomicU64 = AtomicU64::new(0);
    let name =
        path.file_name().ok_or_else(|| io::Error::new(io::ErrorKind::InvalidInput, "the path has no file name"))?;
    let count = COUNT.fetch_add(1, Ordering::Relaxed);
    let temporary = format!(".{}.{}.{count}.part", name.to_string_lossy(), std::process::id());
    Ok(path.with_file_name(temporary))
}
