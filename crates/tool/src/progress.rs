//! Progress of long work.

use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal;

/// A bar of `length` steps on a terminal, nothing elsewhere. `counted`: what stands behind it, as of indicatif's templates.
pub fn bar(length: u64, counted: &str) -> ProgressBar {
    if !std::io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let style = ProgressStyle::with_template(&format!("{{bar:40}} {counted}, {{eta}} left"));
    ProgressBar::new(length).with_style(style.expect("templates are constants"))
}
