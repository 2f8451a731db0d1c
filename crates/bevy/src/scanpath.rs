//! Recorded scanpaths as gaze.

use crate::gaze::Gaze;
use bevy::prelude::*;
use std::fmt;
use std::path::Path;

/// Recorded gaze positions: lines `t_s,x_px,y_px,valid` below a line of these names, with `# key: value` lines above,
/// of which `screen_px: 1920x1080` is needed. Times ascend. Positions are in pixels from the screen's top-left corner.
/// `valid` is 0 where the gaze was lost, as are positions `nan`.
///
/// ```
/// use bevy::math::Vec2;
/// use bevy_afterimage::Scanpath;
///
/// let text = "# screen_px: 200x100\nt_s,x_px,y_px,valid\n0,100,50,1\n0.5,150,25,1\n";
/// let scanpath = Scanpath::parse(text)?;
/// assert_eq!(scanpath.at(0.4), Some(Vec2::new(0.5, 0.5)));
/// assert_eq!(scanpath.at(0.5), Some(Vec2::new(0.75, 0.25)));
/// # Ok::<(), bevy_afterimage::ScanpathError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scanpath(Vec<(f64, Option<Vec2>)>);

/// A scanpath that cannot be read: one line that says why.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ScanpathError(String);

impl fmt::Display for ScanpathError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for ScanpathError {}

const COLUMNS: &str = "t_s,x_px,y_px,valid";

/// Of `WIDTHxHEIGHT`.
fn screen_size(text: &str) -> Option<Vec2> {
    let (width, height) = text.trim().split_once('x')?;
    let size = Vec2::new(width.parse().ok()?, height.parse().ok()?);
    (size.is_finite() && size.min_element() >= 1.0).then_some(size)
}

impl Scanpath {
    /// Reads a file.
    ///
    /// # Errors
    /// [`ScanpathError`] if the file cannot be read, or is not a scanpath.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, ScanpathError> {
        let path = path.as_ref();
        let read = std::fs::read_to_string(path).map_err(|error| error.to_string());
        let parsed = read.and_then(|text| Self::parse(&text).map_err(|error| error.to_string()));
        parsed.map_err(|problem| ScanpathError(format!("{}: {problem}", path.display())))
    }

    /// Reads the text of a file.
    ///
    /// # Errors
    /// [`ScanpathError`] if the text is not a scanpath.
    pub fn parse(text: &str) -> Result<Self, ScanpathError> {
        let mut screen: Option<Vec2> = None;
        let mut has_columns = false;
        let mut samples: Vec<(f64, Option<Vec2>)> = vec![];
        for (number, line) in (1..).zip(text.lines().map(str::trim)) {
            let refuse = |expected: &str| ScanpathError(format!("line {number}: expected {expected}"));
            if let Some(comment) = line.strip_prefix('#') {
                if let Some(size) = comment.trim().strip_prefix("screen_px:") {
                    let expected = "the screen's size, as in `# screen_px: 1920x1080`";
                    screen = Some(screen_size(size).ok_or_else(|| refuse(expected))?);
                }
            } else if !has_columns && line == COLUMNS {
                has_columns = true;
            } else if !has_columns {
                return Err(refuse(&format!("the columns `{COLUMNS}`")));
            } else if !line.is_empty() {
                let expected = "the screen's size above, as in `# screen_px: 1920x1080`";
                let screen = screen.ok_or_else(|| refuse(expected))?;
                let fields: Vec<f64> = line.split(',').filter_map(|field| field.trim().parse().ok()).collect();
                let [t, x, y, valid] = fields[..] else { return Err(refuse("four numbers")) };
                if !t.is_finite() || samples.last().is_some_and(|&(last, _)| t < last) {
                    return Err(refuse("finite times in ascending order"));
                }
                let uv = Vec2::new(x as f32, y as f32) / screen;
                samples.push((t, (valid > 0.0 && uv.is_finite()).then_some(uv)));
            }
        }
        if samples.is_empty() {
            return Err(ScanpathError(format!("no samples: expected lines below `{COLUMNS}`")));
        }
        Ok(Self(samples))
    }

    /// Time of the last sample, in seconds.
    pub fn end_s(&self) -> f64 {
        self.0.last().map_or(0.0, |&(t, _)| t)
    }

    /// Position at a time, as [`Gaze::uv`]: that of the latest sample; of the first one before it. `None`: lost.
    pub fn at(&self, t_s: f64) -> Option<Vec2> {
        let after = self.0.partition_point(|&(t, _)| t <= t_s);
        self.0.get(after.saturating_sub(1)).and_then(|&(_, uv)| uv)
    }
}

/// Plays a scanpath, again and again: sets the resource [`Gaze`] in each frame, by the application's time.
#[derive(Clone, Debug, Default)]
pub struct ScanpathPlugin {
    /// What is played.
    pub scanpath: Scanpath,
    /// Time in the scanpath at which the application starts, in seconds.
    pub start_s: f64,
}

#[derive(Resource)]
struct Playing(ScanpathPlugin);

impl Plugin for ScanpathPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<Gaze>().insert_resource(Playing(self.clone())).add_systems(PreUpdate, play);
    }
}

fn play(playing: Res<Playing>, time: Res<Time>, mut gaze: ResMut<Gaze>) {
    let ScanpathPlugin { scanpath, start_s } = &playing.0;
    let t_s = (start_s + time.elapsed_secs_f64()) % scanpath.end_s().max(f64::MIN_POSITIVE);
    gaze.set_if_neq(Gaze { uv: scanpath.at(t_s) });
}

#[cfg(test)]
#[path = "../tests/unit/scanpath.rs"]
mod tests;
