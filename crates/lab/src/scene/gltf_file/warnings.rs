//! Warnings about features of a file that are ignored or approximated.

use std::fmt::Write;

/// Largest number of names listed in one warning.
const NAMED: usize = 3;

/// Warnings, each text once, with the names of the objects concerned.
#[derive(Clone, Default)]
pub(super) struct Warnings {
    entries: Vec<Entry>,
}

#[derive(Clone)]
struct Entry {
    text: String,
    names: Vec<String>,
    /// Name of the last object. An object reports its warnings in a row, so this detects repetition.
    last: String,
    count: u64,
}

impl Entry {
    fn new(text: &str) -> Self {
        Self { text: text.to_owned(), names: Vec::new(), last: String::new(), count: 0 }
    }
}

impl Warnings {
    /// Adds a warning without an object.
    pub fn add(&mut self, text: impl AsRef<str>) {
        let text = text.as_ref();
        if self.entries.iter().all(|e| e.text != text) {
            self.entries.push(Entry::new(text));
        }
    }

    /// Adds a warning about an object. There are few texts and possibly many objects; each object counts once.
    pub fn about(&mut self, text: &str, name: impl FnOnce() -> String) {
        let at = self.entries.iter().position(|e| e.text == text).unwrap_or_else(|| {
            self.entries.push(Entry::new(text));
            self.entries.len() - 1
        });
        let entry = &mut self.entries[at];
        let name = name();
        if entry.last != name {
            entry.count += 1;
            if entry.names.len() < NAMED {
                entry.names.push(name.clone());
            }
            entry.last = name;
        }
    }

    /// One line per warning.
    pub fn into_lines(self) -> Vec<String> {
        let line = |entry: Entry| {
            let mut line = entry.text;
            if !entry.names.is_empty() {
                let _ = write!(line, ": {}", entry.names.join(", "));
                let more = entry.count - entry.names.len() as u64;
                if more > 0 {
                    let _ = write!(line, " and {more} more");
                }
            }
            line
        };
        self.entries.into_iter().map(line).collect()
    }
}
