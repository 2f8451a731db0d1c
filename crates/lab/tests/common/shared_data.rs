//! Data that is not in the repository: scenes, sequences and scanpaths made by others.

use std::io::Write;
use std::path::PathBuf;

/// Path of a file or folder; prints a message if it is absent.
pub fn shared_data(name: &str) -> Option<PathBuf> {
    let root = afterimage_testing::workspace();
    let places = ["../shared/data", "shared/data"].map(|place| root.join(place).join(name));
    let found = places.iter().find(|path| path.exists());
    if found.is_none() {
        // Not eprintln: the test harness captures it.
        let _ = writeln!(std::io::stderr(), "\nSKIPPED: {} is not there\n", places[0].display());
    }
    found.cloned()
}
