//! Statistics in the panel: frames per second, and pass times and quality over the last seconds.

use super::graph::Graph;
use super::panel;
use super::state::{Side, State};
use super::times::{Pass, PassTimes};
use image::RgbImage;
use std::time::{Duration, Instant};

/// Interval at which the panel is redrawn and quality is measured.
const INTERVAL: Duration = Duration::from_millis(250);
/// Weight of the newest frame in the moving average of the frame time.
const NEWEST_WEIGHT: f64 = 0.1;

/// Colors, the same in every graph.
const RENDER: (&str, [u8; 3]) = ("render", [190, 160, 255]);
const FOVEATION: (&str, [u8; 3]) = ("foveation", [120, 200, 255]);
const LEFT: (&str, [u8; 3]) = ("left", [250, 190, 80]);
const RIGHT: (&str, [u8; 3]) = ("right", [235, 120, 160]);
const SCREEN: (&str, [u8; 3]) = ("screen", [140, 220, 130]);

/// Statistics and the panel that shows them.
pub struct PanelStats {
    begun: Instant,
    last: Option<Instant>,
    seconds_a_frame: Option<f64>,
    milliseconds: Graph,
    periphery_db: Graph,
    /// Text lines above the rows.
    pub lines: Vec<String>,
    pub panel: RgbImage,
    drawn: Option<Instant>,
}

impl PanelStats {
    pub fn new() -> Self {
        Self {
            begun: Instant::now(),
            last: None,
            seconds_a_frame: None,
            milliseconds: Graph::new("milliseconds", &[RENDER, FOVEATION, LEFT, RIGHT, SCREEN]),
            periphery_db: Graph::new("periphery, PSNR dB", &[LEFT, RIGHT]),
            lines: vec![],
            panel: RgbImage::new(1, 1),
            drawn: None,
        }
    }

    /// Clears all statistics.
    pub fn clear(&mut self) {
        self.milliseconds.clear();
        self.periphery_db.clear();
        (self.last, self.seconds_a_frame, self.drawn) = (None, None, None);
    }

    /// Seconds since the last frame; 0 before the first.
    pub fn since_last_s(&self) -> f64 {
        self.last.map_or(0.0, |last| last.elapsed().as_secs_f64())
    }

    /// Frames per second, moving average.
    pub fn fps(&self) -> f64 {
        self.seconds_a_frame.map_or(0.0, |s| 1.0 / s)
    }

    /// Adds a frame that was shown.
    pub fn frame(&mut self, times: &PassTimes) {
        if self.last.is_some() {
            let seconds = self.since_last_s();
            let mean = self.seconds_a_frame.get_or_insert(seconds);
            *mean += NEWEST_WEIGHT * (seconds - *mean);
        }
        self.last = Some(Instant::now());
        let now_s = self.begun.elapsed().as_secs_f64();
        for pass in Pass::ALL {
            if let Some(ms) = times.ms(pass) {
                self.milliseconds.push(pass as usize, now_s, ms);
            }
        }
    }

    /// Adds the PSNR of a side's periphery in dB; `None` (no error) is skipped.
    pub fn quality(&mut self, side: Side, psnr_db: Option<f64>) {
        if let Some(psnr_db) = psnr_db {
            self.periphery_db.push(side as usize, self.begun.elapsed().as_secs_f64(), psnr_db);
        }
    }

    /// Whether the last drawing of the panel is older than [`INTERVAL`].
    pub fn is_due(&self) -> bool {
        self.drawn.is_none_or(|drawn| drawn.elapsed() >= INTERVAL)
    }

    /// Draws the panel.
    pub fn draw(&mut self, state: &State, lines: Vec<String>) {
        self.lines = lines;
        self.panel = panel::draw(state, &self.lines, &[&self.milliseconds, &self.periphery_db]);
        self.drawn = Some(Instant::now());
    }
}
