//! Atomic file writes: a file is written completely or not at all.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

/// Writes `path` with the contents that `fill` produces: into a temporary file in the same folder, which is then
/// renamed. Readers never see a partial file, and an existing file stays intact if anything fails.
///
/// # Errors
/// Errors of the file system and of `fill`; the temporary file is then removed.
pub fn write_whole(path: &Path, fill: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>) -> io::Result<()> {
    let temporary = temporary_name(path)?;
    let write = || {
        let mut file = BufWriter::new(File::create(&temporary)?);
        fill(&mut file)?;
        file.flush()?;
        fs::rename(&temporary, path)
    };
    write().inspect_err(|_| {
        // Report the first error, not that of the clean-up.
        let _ = fs::remove_file(&temporary);
    })
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
