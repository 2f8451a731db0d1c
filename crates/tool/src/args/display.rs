//! `--display-peak`, `--display-contrast`, `--display-ambient`: the display on which JOD shows the frames.

use super::{parse_contrast, parse_lux, parse_nits};
use afterimage_metric::Display;
use clap::Args;

/// Heading of these options in the help.
const HEADING: &str = "Display of JOD";

/// Display of JOD.
#[derive(Args, Clone, Copy, Debug)]
pub struct DisplayArgs {
    /// Luminance of the display's white for JOD, cd/m2. A brighter display shows more
    #[arg(long, default_value_t = Display::default().peak_nits, value_parser = parse_nits, value_name = "CD_M2", help_heading = HEADING)]
    pub display_peak: f32,
    /// Luminance of white over that of black in a dark room
    #[arg(long, default_value_t = Display::default().contrast, value_parser = parse_contrast, value_name = "RATIO", help_heading = HEADING)]
    pub display_contrast: f32,
    /// Light of the room on the display, lux, of which it reflects 0.5 %. An office has 500; a headset 0
    #[arg(long, default_value_t = Display::default().ambient_lux, value_parser = parse_lux, value_name = "LUX", help_heading = HEADING)]
    pub display_ambient: f32,
}

impl DisplayArgs {
    /// The display.
    pub fn display(&self) -> Display {
        Display { peak_nits: self.display_peak, contrast: self.display_contrast, ambient_lux: self.display_ambient }
    }
}
