//! `--camera head`: the scanpath that moves the camera, and gives the gaze in it.

use super::gaze::{DEFAULT_SECONDS, GazeArgs, fixed, synthetic_seed};
use crate::failure::{Failure, warn};
use afterimage_lab::scanpath::{HeadOptions, HeadPath};
use afterimage_lab::scene::{Scene, SceneLimits};
use afterimage_lab::source::is_scene;
use afterimage_trace::head_in_scene;

/// Smallest number of samples per second of a generated head.
const LEAST_RATE_HZ: f64 = 500.0;

/// The head that moves a camera of this name; `None` for other cameras and for inputs without one.
pub fn head_path(
    camera: Option<&str>,
    gaze: &GazeArgs,
    scene: &str,
    fps: Option<f32>,
    frames: Option<u64>,
) -> Result<Option<HeadPath>, Failure> {
    let is_walking = match camera {
        Some("head") => false,
        Some("head-walk") => true,
        _ => return Ok(None),
    };
    if !is_scene(scene) {
        return Ok(None);
    }
    gaze.check_start()?;
    let fps = f64::from(fps.unwrap_or(60.0));
    let path = match synthetic_seed(&gaze.gaze)? {
        Some(seed) => {
            let seconds = frames.map_or(DEFAULT_SECONDS, |n| n as f64 / fps) + gaze.start + 0.1;
            // A sample at the time of every frame: then gaze and pose are of the same moment.
            let rate_hz = fps * (LEAST_RATE_HZ / fps).ceil();
            let options = HeadOptions { seed, duration_s: seconds, rate_hz, is_walking, ..HeadOptions::default() };
            let scene = Scene::open_clip(scene, None, &SceneLimits::default())?;
            head_in_scene(&scene, &options)?.path
        }
        None if is_walking => {
            return Err(Failure::Input(format!(
                "--camera head-walk: a walk is generated; give --gaze synthetic:SEED, or --camera head for the poses in {}",
                gaze.gaze
            )));
        }
        None if fixed(&gaze.gaze)?.is_some() => {
            return Err(Failure::Input(format!(
                "--camera head: --gaze {} has no poses of a head; give a scanpath that has (FILE.csv), or synthetic:SEED",
                gaze.gaze
            )));
        }
        None => {
            let log = gaze.log.read(&gaze.gaze, None)?;
            warn(&log.warnings);
            log.scanpath
        }
    };
    Ok(Some(HeadPath::new(path.into(), gaze.start)?))
}
