//! The files of the workspace.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

/// Folders of output, and of what fuzzing leaves.
const SKIPPED: [&str; 5] = ["target", ".git", "out", "artifacts", "corpus"];

/// Folders of the packages, relative to the root of the workspace, with a slash at the end unless empty.
pub const PACKAGES: [&str; 10] = [
    "",
    "crates/eval/",
    "crates/lab/",
    "crates/metric/",
    "crates/openxr/",
    "crates/program/",
    "crates/research/",
    "crates/testing/",
    "crates/tool/",
    "crates/trace/",
];

/// Packages in this repository that are workspaces of their own, and that have commands in documents.
pub const APART: [&str; 3] = ["crates/bevy/", "crates/web/", "crates/web/bindgen/"];

/// Files and folders of the workspace, with slashes, relative to its root. Folders end with a slash.
pub struct Tree {
    pub entries: BTreeSet<String>,
}

impl Tree {
    pub fn read() -> Self {
        let mut entries = BTreeSet::new();
        visit(&afterimage_testing::workspace(), "", &mut entries);
        assert!(entries.len() > 400, "{} files and folders", entries.len());
        Self { entries }
    }

    /// Files below `folder` whose names end in one of `endings`.
    pub fn files<'a>(&'a self, folder: &'a str, endings: &'a [&str]) -> impl Iterator<Item = &'a str> {
        let entries = self.entries.iter().map(String::as_str);
        entries.filter(move |e| e.starts_with(folder) && endings.iter().any(|ending| e.ends_with(ending)))
    }
}

fn visit(folder: &Path, prefix: &str, entries: &mut BTreeSet<String>) {
    for entry in fs::read_dir(folder).unwrap() {
        let entry = entry.unwrap();
        let name = entry.file_name().into_string().expect("file names are UTF-8");
        if !entry.path().is_dir() {
            entries.insert(format!("{prefix}{name}"));
        } else if !SKIPPED.contains(&name.as_str()) {
            let path = format!("{prefix}{name}/");
            visit(&entry.path(), &path, entries);
            entries.insert(path);
        }
    }
}

/// Text of a file of the workspace.
pub fn read(path: &str) -> String {
    fs::read_to_string(afterimage_testing::workspace().join(path)).unwrap_or_else(|e| panic!("{path}: {e}"))
}

/// Folder of the package that contains a file.
pub fn package_of(path: &str) -> &'static str {
    PACKAGES.iter().chain(&APART).rfind(|p| path.starts_with(**p)).expect("the first package contains all")
}

/// Fails with the list of violations, if there are any.
#[track_caller]
pub fn expect_none(rule: &str, violations: &[String]) {
    assert!(violations.is_empty(), "{rule}: {} violations\n{}", violations.len(), violations.join("\n"));
}
