//! Resamples a scanpath on a screen to one gaze point per frame.

use super::{Scanpath, Screen};
use crate::error::InputError;
use afterimage::ViewGeometry;

/// Tolerance in seconds for comparing sample and frame times: covers the rounding of `start_s + i / fps` over hours,
/// and is far below the sample spacing of any recording.
const TIME_SLACK_S: f64 = 1e-9;

/// Mapping of screen positions to frame positions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GazeMap {
    /// Keeps visual angles: the middle of the screen maps to the view's forward direction, and a gaze 5 degrees from it
    /// on the screen is 5 degrees from it in the view. Needs the screen's size in centimetres and its distance.
    Angle,
    /// Stretches the screen to the frame, edge to edge.
    Fit,
}

impl GazeMap {
    /// [`GazeMap::Angle`] if the screen's geometry is known, else [`GazeMap::Fit`].
    pub fn default_for(screen: &Screen) -> Self {
        if screen.tangent_per_px().is_some() { Self::Angle } else { Self::Fit }
    }
}

/// Gaze of each frame: the last valid sample at or before the frame's time, neither interpolated nor predicted.
///
/// Frame `i` is displayed `start_s + i / fps` seconds after the recording's first sample. A lookup takes O(log
/// samples).
#[derive(Clone, Debug, PartialEq)]
pub struct FrameGaze {
    /// Times (on the recording's clock) and frame positions of the valid samples.
    valid: Vec<(f64, [f32; 2])>,
    map: GazeMap,
    first_s: f64,
    fps: f64,
    frames: u64,
}

impl FrameGaze {
    /// Resamples `path` for frames of `view` at `fps` frames per second, from `start_s` seconds after its first sample.
    ///
    /// Samples so far off the screen that their pixel overflows an `f32` count as lost.
    ///
    /// # Errors
    /// [`Request`](InputError::Request) if `fps` is not a positive number, `start_s` is negative, not finite or beyond
    /// the recording's end, or `map` is [`GazeMap::Angle`] and the screen's geometry is not known.
    pub fn new(path: &Scanpath, view: &ViewGeometry, map: GazeMap, start_s: f64, fps: f64) -> Result<Self, InputError> {
        if !(fps.is_finite() && fps > 0.0) {
            return Err(InputError::request("fps", format!("{fps} frames per second"), "expected a number above 0"));
        }
        let left_s = path.duration_s() - start_s;
        if !(start_s >= 0.0 && left_s >= -TIME_SLACK_S) {
            return Err(InputError::request(
                "start",
                format!("{start_s} s is not within {}", path.name()),
                format!("expected 0 to {} s", path.duration_s()),
            ));
        }
        let to_frame = mapping(path, view, map)?;
        let valid = path.samples().iter().filter_map(|sample| {
            let px = to_frame(sample.px?)?;
            px.iter().all(|v| v.is_finite()).then_some((sample.t_s, px))
        });
        Ok(Self {
            valid: valid.collect(),
            map,
            first_s: path.begin_s() + start_s,
            fps,
            // A float to integer cast saturates.
            frames: (((left_s + TIME_SLACK_S) * fps).floor().max(0.0) as u64).saturating_add(1),
        })
    }

    /// Number of frames up to the recording's last sample: `floor((duration - start) * fps) + 1`.
    pub fn frames(&self) -> u64 {
        self.frames
    }

    /// The mapping in use.
    pub fn map(&self) -> GazeMap {
        self.map
    }

    /// Gaze in frame `index` in pixels; (0, 0) is the **centre** of the top left pixel, y down. Finite, but possibly
    /// outside of the frame. `None` before the first valid sample: the caller chooses a fallback. Past
    /// [`FrameGaze::frames`] the last valid sample is held.
    pub fn px(&self, index: u64) -> Option<[f32; 2]> {
        self.last_valid(index).map(|(_, px)| px)
    }

    /// Last known gaze in frame `index`, from a tracker whose samples arrive `latency_s` seconds late. Until the first
    /// valid sample arrives, it is the position of that sample, as if the eye had rested there.
    pub fn late_px(&self, index: u64, latency_s: f64) -> Option<[f32; 2]> {
        self.last_valid_at(self.time_s(index) - latency_s).or(self.valid.first().copied()).map(|(_, px)| px)
    }

    /// Age in seconds, at least 0, of the sample behind [`FrameGaze::px`]. An age of more than a few sample intervals
    /// means that the gaze is lost and held; a caller may respond with a wider fovea.
    pub fn age_s(&self, index: u64) -> Option<f64> {
        self.last_valid(index).map(|(t_s, _)| (self.time_s(index) - t_s).max(0.0))
    }

    fn last_valid(&self, index: u64) -> Option<(f64, [f32; 2])> {
        self.last_valid_at(self.time_s(index))
    }

    /// Last valid sample at or before a time.
    fn last_valid_at(&self, time_s: f64) -> Option<(f64, [f32; 2])> {
        let after = self.valid.partition_point(|(t_s, _)| *t_s <= time_s + TIME_SLACK_S);
        after.checked_sub(1).map(|last| self.valid[last])
    }

    /// Display time of frame `index` on the recording's clock.
    fn time_s(&self, index: u64) -> f64 {
        self.first_s + index as f64 / self.fps
    }
}

/// Function from corner-based screen pixels to centre-based frame pixels.
fn mapping(
    path: &Scanpath,
    view: &ViewGeometry,
    map: GazeMap,
) -> Result<impl Fn([f32; 2]) -> Option<[f32; 2]>, InputError> {
    let screen = path.screen();
    let tangent_per_px = match map {
        GazeMap::Fit => None,
        GazeMap::Angle => Some(screen.tangent_per_px().ok_or_else(|| {
            InputError::request(
                path.name(),
                "visual angles are unknown, because the screen's size in cm or its distance is",
                "use the gaze map `fit`, or state the screen's size and distance: `screen_mm` and `distance_mm`",
            )
        })?),
    };
    let size = screen.size_px.map(f64::from);
    let frame = view.size_px().map(f64::from);
    let view = *view;
    Ok(move |px: [f32; 2]| {
        let px = px.map(f64::from);
        match tangent_per_px {
            Some(slope) => {
                let tangent = [0, 1].map(|i| ((px[i] - 0.5 * size[i]) * slope[i]) as f32);
                view.project([tangent[0], tangent[1], 1.0])
            }
            None => Some([0, 1].map(|i| (px[i] / size[i] * frame[i] - 0.5) as f32)),
        }
    })
}
