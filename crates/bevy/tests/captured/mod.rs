//! The application's log, kept in memory.

use std::io::Write;
use std::sync::Mutex;

/// What was logged and not yet taken.
pub static LOG: Mutex<Vec<u8>> = Mutex::new(vec![]);

/// Writes to [`LOG`].
pub struct Log;

impl Write for Log {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        LOG.lock().expect("the log").write(bytes)
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}
