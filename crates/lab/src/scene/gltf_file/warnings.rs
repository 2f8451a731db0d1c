//! What a file asks for and is not done.

use std::fmt::Write;

/// Names that are spelled out with one warning.
const NAMED: usize = 3;

/// Warnings, each once, with what it is about.
#[derive(Default)]
pub(super) struct Warnings {
    entries: Vec<Entry>,
}

struct Entry {
    text: String,
    names: Vec<String>,
    /// The thing that was named last, for things report one after the other.
    last: String,
    count: u64,
}

impl Entry {
    fn new(text: &str) -> Self {
        Self { text: text.to_owned(), names: Vec::new(), last: String::new(), count: 0 }
    }
}

impl Warnings {
    /// A warning that stands alone.
    pub fn add(&mut self, text: impl AsRef<str>) {
        let text = text.as_ref();
        if self.entries.iter().all(|e| e.text != text) {
            self.entries.push(Entry::new(text));
        }
    }

    /// A warning about one of several things. The texts are few, the things may be many; each counts once.
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

    /// All of them, one line each.
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
