//! Programs of the workspace, run as processes.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// A program, by its path: `env!("CARGO_BIN_EXE_...")`. It runs in the root of the workspace, on the adapter that the
/// tests take.
#[derive(Clone, Copy, Debug)]
pub struct Program(pub &'static str);

impl Program {
    /// Runs it.
    pub fn output(self, args: &[&str]) -> Output {
        Command::new(self.0)
            .args(args)
            // Silences a message of Mesa about windows.
            .env("NODEVICE_SELECT", "1")
            .envs(crate::gpu::choice())
            .current_dir(crate::workspace())
            .output()
            .expect("the program starts")
    }

    /// Checks that it succeeds, with nothing on stderr, which is not a terminal. Returns stdout.
    #[track_caller]
    pub fn succeeds(self, args: &[&str]) -> String {
        let output = self.output(args);
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{args:?}: {stderr}");
        assert!(stderr.is_empty(), "nothing on stderr when it is no terminal: {stderr}");
        String::from_utf8(output.stdout).expect("text")
    }

    /// Checks for an error in one line that contains `words`, exit code 2, and no panic. Returns the line.
    #[track_caller]
    pub fn refuses(self, args: &[&str], words: &[&str]) -> String {
        let output = self.output(args);
        let stderr = String::from_utf8_lossy(&output.stderr).into_owned();
        println!("{}", stderr.trim_end());
        assert_eq!(output.status.code(), Some(2), "{args:?}: {stderr}");
        assert_eq!(stderr.lines().count(), 1, "one line: {stderr}");
        assert!(output.stdout.is_empty());
        for word in words {
            assert!(stderr.contains(word), "'{word}' is missing: {stderr}");
        }
        stderr
    }
}

/// A JSON file that a program wrote.
pub fn read_json(path: &Path) -> serde_json::Value {
    serde_json::from_str(&std::fs::read_to_string(path).expect("a file")).expect("JSON")
}

/// A temporary folder for what programs read and write.
pub struct Folder(tempfile::TempDir);

impl Folder {
    /// An empty one.
    #[expect(clippy::new_without_default, reason = "it makes a folder")]
    pub fn new() -> Self {
        Self(tempfile::tempdir().expect("a temporary folder"))
    }

    /// Path of a file in it.
    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// The same as text, for arguments.
    pub fn text(&self, name: &str) -> String {
        self.path(name).to_str().expect("a path in UTF-8").to_owned()
    }

    /// Writes a file, and returns its path.
    pub fn write(&self, name: &str, bytes: &[u8]) -> String {
        std::fs::write(self.path(name), bytes).expect("a written file");
        self.text(name)
    }
}
