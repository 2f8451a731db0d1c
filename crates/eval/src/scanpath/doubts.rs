//! What looks wrong in a scanpath: units that its columns do not have, and lost gaze.

use super::sample_times::median_step;
use super::{Sample, Scanpath};

/// Samples a second below which times are hardly seconds. Webcams give 15 and more.
const LEAST_HZ: f64 = 10.0;
/// Samples a second above which times are hardly what their unit says. The fastest trackers give 5000.
const MOST_HZ: f64 = 10_000.0;
/// Share of a recording that one pause hardly is.
const PAUSE_SHARE: f64 = 0.9;
/// Share of the valid samples within a pixel of a corner from which coordinates are hardly pixels. Not all: gaze from 0
/// to 1 may lie a little off the screen.
const CORNER_SHARE: f64 = 0.9;
/// Smallest side of a screen in pixels on which a pixel is a corner.
const LEAST_SIDE_PX: u32 = 16;

impl Scanpath {
    /// What looks wrong, one line each: all gaze within a pixel of a corner (coordinates from 0 to 1?), fewer than ten
    /// samples a second (milliseconds?) or more than 10000 (seconds?), more than half of the gaze lost.
    pub fn warnings(&self) -> Vec<String> {
        [self.corner(), self.too_slow(), self.too_fast(), self.loss()]
            .into_iter()
            .flatten()
            .map(|doubt| format!("{}: {doubt}", self.name()))
            .collect()
    }

    fn corner(&self) -> Option<String> {
        let size = self.screen().size_px;
        let near = |px: &[f32; 2], corner: [bool; 2]| {
            (0..2).all(|i| (px[i] - if corner[i] { size[i] as f32 } else { 0.0 }).abs() <= 1.0)
        };
        let valid = || self.samples().iter().filter_map(|s: &Sample| s.px.as_ref());
        let least = CORNER_SHARE * valid().count() as f64;
        let corners = [[false, false], [true, false], [false, true], [true, true]];
        let is_there = |corner| valid().filter(|px| near(px, corner)).count() as f64 >= least;
        (size.iter().all(|side| *side >= LEAST_SIDE_PX) && corners.into_iter().any(is_there)).then(|| {
            format!(
                "all gaze lies within a pixel of a corner of {}x{} pixels; are the coordinates 0 to 1? Multiply them \
                 by the screen's size",
                size[0], size[1]
            )
        })
    }

    /// Why a long recording may have wrong times, without the name of the scanpath: fewer than ten samples a second, or
    /// one pause that is nearly all of it.
    pub fn doubt_of_times(&self) -> Option<String> {
        self.too_slow().or_else(|| self.pause())
    }

    fn too_slow(&self) -> Option<String> {
        let median = self.median_step_s()?;
        (median * LEAST_HZ > 1.0)
            .then(|| format!("{}; are the times milliseconds? Divide them by 1000", self.rate_of(median)))
    }

    fn pause(&self) -> Option<String> {
        let steps = self.samples().windows(2).map(|pair| (pair[0].t_s, pair[1].t_s - pair[0].t_s));
        let (start_s, pause_s) = steps.max_by(|a, b| a.1.total_cmp(&b.1))?;
        (self.samples().len() > 2 && pause_s > PAUSE_SHARE * self.duration_s())
            .then(|| format!("no sample for {pause_s:.3e} s after {start_s:.3} s; is a time wrong? Mend or cut it"))
    }

    fn too_fast(&self) -> Option<String> {
        let median = self.median_step_s()?;
        (median * MOST_HZ < 1.0)
            .then(|| format!("{}; are the times another unit than the file says?", self.rate_of(median)))
    }

    /// The median, because a recording may have pauses.
    fn median_step_s(&self) -> Option<f64> {
        median_step(self.samples().iter().map(|sample| sample.t_s), |_| true)
    }

    fn rate_of(&self, step_s: f64) -> String {
        let (samples, duration_s, rate_hz) = (self.samples().len(), self.duration_s(), 1.0 / step_s);
        format!("{samples} samples in {duration_s:.3} s are {rate_hz:.2} a second")
    }

    fn loss(&self) -> Option<String> {
        let (lost, all) = (self.lost(), self.samples().len());
        (2 * lost > all).then(|| format!("the gaze is lost in {lost} of {all} samples, more than half"))
    }
}
