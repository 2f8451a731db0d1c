//! `--gaze`, `--gaze-map`, `--start`: resolved to one position per frame.

use super::gaze_log::GazeLogArgs;
use super::{Named, by_name, gaze_frames};
use crate::failure::{Failure, warn};
use afterimage::ViewGeometry;
use afterimage_lab::scanpath::{FrameGaze, GazeMap, HeadPath, Scanpath, Screen, SyntheticOptions, generate};
use clap::Args;
use std::path::Path;

/// Duration of a fixed or synthetic gaze, seconds.
pub(super) const DEFAULT_SECONDS: f64 = 5.0;
/// Frames up to which a recording counts whose times are hardly seconds: a minute of 60 frames a second.
const MOST_FRAMES_IN_DOUBT: u64 = 3600;

/// Heading of these options in the help.
const HEADING: &str = "Gaze";

/// Gaze of a clip.
#[derive(Args, Clone, Debug)]
pub struct GazeArgs {
    /// Scanpath or export of an eye tracker (FILE; docs/gaze-logs.md), gaze.csv of a run, one fixed frame pixel (X,Y),
    /// or synthetic[:SEED]
    #[arg(long, default_value = "synthetic:0", value_name = "GAZE", allow_hyphen_values = true, help_heading = HEADING)]
    pub gaze: String,
    /// Map from screen to frame: keep visual angles, or stretch; default: angle if the file states the screen's
    /// geometry
    #[arg(long, value_parser = by_name::<GazeMap>(), help_heading = HEADING)]
    pub gaze_map: Option<GazeMap>,
    /// Start time in the scanpath, seconds
    #[arg(long, default_value_t = 0.0, value_name = "S", help_heading = HEADING)]
    pub start: f64,
    #[command(flatten)]
    pub log: GazeLogArgs,
}

impl Named for GazeMap {
    fn rows() -> Vec<(Self, &'static str, &'static str)> {
        vec![
            (Self::Angle, "angle", "Keep visual angles, screen center to frame center"),
            (Self::Fit, "fit", "Stretch screen to frame"),
        ]
    }
}

/// One gaze position per frame.
pub struct Track {
    /// Frame pixels; `None`: tracking lost.
    pub px: Vec<Option<[f32; 2]>>,
    /// What a late tracker says of each frame; `None` without latency.
    pub late_px: Option<Vec<Option<[f32; 2]>>>,
    /// Frames that a recording covers, after which its last position is held; `None` if it has no end.
    pub recorded: Option<u64>,
    /// Map from screen to frame: `angle`, `fit`, or `none` for positions that are frame pixels already.
    pub map: &'static str,
}

impl GazeArgs {
    /// Resolves the options for `frames` frames, by default for the duration of the gaze. With `--camera head`, `head`
    /// is the scanpath, read or generated already. `latency_ms`: of the tracker.
    pub fn resolve(
        &self,
        view: &ViewGeometry,
        fps: f32,
        frames: Option<u64>,
        head: Option<&HeadPath>,
        latency_ms: f64,
    ) -> Result<Track, Failure> {
        self.check_start()?;
        let is_late = latency_ms > 0.0;
        let default_frames = (DEFAULT_SECONDS * f64::from(fps)).ceil() as u64;
        if let Some(px) = fixed(&self.gaze)? {
            self.log.refuse_for(&format!("--gaze {}", self.gaze))?;
            warn(&fractions(px, view.size_px()).into_iter().collect::<Vec<_>>());
            let count = frames.unwrap_or(default_frames) as usize;
            let px = vec![Some(px); count];
            return Ok(Track { late_px: is_late.then(|| px.clone()), px, recorded: None, map: "none" });
        }
        if let Some(rows) = gaze_frames::read(&self.gaze)? {
            self.log.refuse_for(&format!("--gaze {}", self.gaze))?;
            return self.of_frames(&rows, fps, frames, latency_ms);
        }
        let synthetic = synthetic_seed(&self.gaze)?;
        if synthetic.is_some() {
            self.log.refuse_for(&format!("--gaze {}", self.gaze))?;
        }
        let mut warnings = vec![];
        let path = match (head, synthetic) {
            (Some(head), _) => head.scanpath().clone(),
            (None, Some(seed)) => {
                let seconds = frames.unwrap_or(default_frames) as f64 / f64::from(fps) + self.start;
                make_synthetic(seed, seconds + 0.1, view)?.into()
            }
            (None, None) => {
                let log = self.log.read(&self.gaze, None)?;
                warnings = log.warnings;
                log.scanpath.into()
            }
        };
        let map = self.gaze_map.unwrap_or_else(|| GazeMap::default_for(path.screen()));
        let gaze = FrameGaze::new(&path, view, map, self.start, f64::from(fps))?;
        let available = if synthetic.is_some() { default_frames } else { gaze.frames() };
        let count = frames.unwrap_or(available);
        if frames.is_none()
            && count > MOST_FRAMES_IN_DOUBT
            && let Some(doubt) = path.doubt_of_times()
        {
            let name = &self.gaze;
            return Err(Failure::Input(format!("{name}: {doubt}, or give --frames ({count} for all of it)")));
        }
        warn(&warnings);
        let px: Vec<_> = (0..count).map(|i| gaze.px(i)).collect();
        if px.iter().all(Option::is_none) {
            return Err(Failure::Input(format!(
                "{}: the gaze is lost in all {count} frames from {} s on; choose another --start",
                self.gaze, self.start
            )));
        }
        let late_px = is_late.then(|| (0..count).map(|i| gaze.late_px(i, 1e-3 * latency_ms)).collect());
        let recorded = synthetic.is_none().then(|| gaze.frames());
        Ok(Track { px, late_px, recorded, map: map.name() })
    }

    /// The gaze that another clip had in each frame.
    fn of_frames(&self, rows: &[[f32; 2]], fps: f32, frames: Option<u64>, latency_ms: f64) -> Result<Track, Failure> {
        let first = (self.start * f64::from(fps)).round() as usize;
        let Some(rows) = rows.get(first..).filter(|rows| !rows.is_empty()) else {
            let (gaze, count) = (&self.gaze, rows.len());
            return Err(Failure::Input(format!("--start {}: {gaze} ends before, after {count} frames", self.start)));
        };
        let count = frames.unwrap_or(rows.len() as u64) as usize;
        let delay = (1e-3 * latency_ms * f64::from(fps)).ceil() as usize;
        let delayed =
            |delay: usize| (0..count).map(|i| Some(rows[i.saturating_sub(delay).min(rows.len() - 1)])).collect();
        let late_px = (delay > 0).then(|| delayed(delay));
        Ok(Track { px: delayed(0), late_px, recorded: Some(rows.len() as u64), map: "none" })
    }

    pub(super) fn check_start(&self) -> Result<(), Failure> {
        if !(self.start >= 0.0 && self.start.is_finite()) {
            return Err(Failure::Input(format!("--start {}: expected seconds, 0 or more", self.start)));
        }
        Ok(())
    }
}

fn make_synthetic(seed: u64, seconds: f64, view: &ViewGeometry) -> Result<Scanpath, Failure> {
    let options =
        SyntheticOptions { seed, duration_s: seconds, screen: Screen::of_view(view), ..SyntheticOptions::default() };
    Ok(generate(&options)?.path)
}

/// `X,Y` in frame pixels.
pub(super) fn fixed(text: &str) -> Result<Option<[f32; 2]>, Failure> {
    let Some((x, y)) = text.split_once(',') else {
        return Ok(None);
    };
    match (x.trim().parse::<f32>(), y.trim().parse::<f32>()) {
        (Ok(x), Ok(y)) if x.is_finite() && y.is_finite() => Ok(Some([x, y])),
        // A file name may contain a comma.
        _ if Path::new(text).exists() => Ok(None),
        _ => {
            Err(Failure::Input(format!("--gaze {text}: expected X,Y in frame pixels, a CSV file, or synthetic[:SEED]")))
        }
    }
}

/// The warning for a fixed gaze that looks like shares of the frame: from 0 to 1, and no whole pixels.
fn fractions(px: [f32; 2], size_px: [u32; 2]) -> Option<String> {
    let is_share = px.iter().all(|v| (0.0..=1.0).contains(v)) && px.iter().any(|v| v.fract() != 0.0);
    let [x, y] = [0, 1].map(|i| (px[i] * (size_px[i] - 1) as f32).round());
    (is_share && size_px.iter().all(|side| *side > 2)).then(|| {
        let [w, h] = size_px;
        format!(
            "--gaze {},{} is in the corner of {w}x{h} pixels; for this share of the frame give {x},{y}",
            px[0], px[1]
        )
    })
}

pub(super) fn synthetic_seed(text: &str) -> Result<Option<u64>, Failure> {
    match text.strip_prefix("synthetic") {
        Some("") => Ok(Some(0)),
        Some(rest) if rest.starts_with(':') => rest[1..].parse().map(Some).map_err(|_| {
            Failure::Input(format!("--gaze {text}: expected synthetic:SEED with a whole number, such as synthetic:7"))
        }),
        _ => Ok(None),
    }
}
