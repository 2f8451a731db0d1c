//! Composed shaders as files, for shader compilers and captures of a frame.

use std::io::{self, Write};
use std::path::Path;
use std::sync::atomic::{AtomicU32, Ordering};
use std::{env, fs, process};

/// Environment variable with the folder.
const FOLDER: &str = "AFTERIMAGE_SHADER_DUMP";

/// Writes the text of a shader to `NAME.wgsl` in the folder that the environment names, if it names one. The last text
/// of a name stays: debug views and formats of outputs have texts of their own. An error is a line on standard error.
pub(super) fn dump(name: &str, source: &str) {
    // Browsers have no files.
    if cfg!(target_arch = "wasm32") {
        return;
    }
    let Some(folder) = env::var_os(FOLDER).filter(|folder| !folder.is_empty()) else { return };
    if let Err(error) = write(Path::new(&folder), name, source) {
        let _ = writeln!(
            io::stderr(),
            "{FOLDER}: no {name}.wgsl in {}: {error}; name a folder that can be written to",
            folder.display()
        );
    }
}

/// Writes a part first and then names it, so that readers find whole files.
fn write(folder: &Path, name: &str, source: &str) -> io::Result<()> {
    static COUNT: AtomicU32 = AtomicU32::new(0);
    fs::create_dir_all(folder)?;
    let part = folder.join(format!("{name}.{}-{}", process::id(), COUNT.fetch_add(1, Ordering::Relaxed)));
    fs::write(&part, source).and_then(|()| fs::rename(&part, folder.join(format!("{name}.wgsl")))).inspect_err(|_| {
        let _ = fs::remove_file(&part);
    })
}
