//! Progress bars.

use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal;

/// A progress bar of the frames of a clip.
pub fn of_frames(frames: u64) -> ProgressBar {
    bar(frames, "frame {pos}/{len}")
}

/// A progress bar of `length` steps; hidden if stderr is not a terminal. `counted`: indicatif template of the text
/// behind the bar.
pub fn bar(length: u64, counted: &str) -> ProgressBar {
    if !std::io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let style = ProgressStyle::with_template(&format!("{{bar:40}} {counted}, {{eta}} left"));
    ProgressBar::new(length).with_style(style.expect("templates are constants"))
}
