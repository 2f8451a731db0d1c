//! `--stereo`: through how many eyes, and where each looks.

use super::setup::Setup;
use crate::failure::Failure;
use afterimage_lab::scanpath::{About, Sample, Scanpath, Screen, write_csv};
use afterimage_lab::trace::stereo::GazePoint;
use afterimage_lab::trace::view::View;

/// Largest distance of pupils, metres: people have 0.05 to 0.075.
const MOST_IPD_M: f64 = 0.2;

/// One eye, which is the camera, or two beside it.
pub struct Eyes {
    /// Metres between two.
    pub ipd_m: Option<f64>,
    /// Where each looked last.
    last: Vec<[f32; 2]>,
}

impl Eyes {
    pub fn new(ipd_m: Option<f64>, size: [u32; 2]) -> Result<Self, Failure> {
        if let Some(ipd_m) = ipd_m
            && !(ipd_m > 0.0 && ipd_m <= MOST_IPD_M)
        {
            return Err(Failure::Input(format!(
                "--stereo {ipd_m}: expected the distance of the pupils in metres, above 0 and up to {MOST_IPD_M}; people have 0.063"
            )));
        }
        let middle = size.map(|s| 0.5 * (s as f32 - 1.0));
        Ok(Self { ipd_m, last: vec![middle; if ipd_m.is_some() { 2 } else { 1 }] })
    }

    /// Names of two eyes, which are folders; a camera of its own has none.
    pub fn names(&self) -> &'static [&'static str] {
        if self.ipd_m.is_some() { &["left", "right"] } else { &[""] }
    }

    /// What each sees.
    pub fn views(&self, head: &View) -> Vec<View> {
        self.ipd_m.map_or_else(|| vec![*head], |ipd_m| head.stereo(ipd_m).to_vec())
    }

    /// Where each looks while the head looks at `gaze_px`: at the same point. An eye that has no pixel for it stays where it was.
    pub fn gaze(&mut self, setup: &Setup, head: &View, views: &[View], gaze_px: [f32; 2]) -> Vec<[f32; 2]> {
        if self.ipd_m.is_none() {
            return vec![gaze_px];
        }
        let effects = setup.tracer.effects(&setup.world);
        let point = GazePoint::seen(&setup.world, head, gaze_px, effects);
        for (last, view) in self.last.iter_mut().zip(views) {
            *last = point.px(view).unwrap_or(*last);
        }
        self.last.clone()
    }
}

/// Where an eye looked, as a scanpath on a screen of the frame's size, which `run --gaze` reads.
pub fn scanpath_csv(eye: &str, size_px: [u32; 2], fps: f32, gaze_px: &[[f32; 2]]) -> Result<String, Failure> {
    // Pixels of a scanpath count from the screen's corner.
    let sample = |(i, px): (usize, &[f32; 2])| Sample { t_s: i as f64 / f64::from(fps), px: Some(px.map(|v| v + 0.5)) };
    let samples = gaze_px.iter().enumerate().map(sample).collect();
    let screen = Screen { size_px, size_cm: None, distance_cm: None };
    let path = Scanpath::new(eye, screen, About::default(), samples)?;
    let mut csv = vec![];
    write_csv(&path, &mut csv).map_err(|e| Failure::Work(format!("{eye}: {e}")))?;
    Ok(String::from_utf8_lossy(&csv).into_owned())
}

/// A path below the folder of an eye, with / on any system.
pub fn below(eye: &str, name: &str) -> String {
    if eye.is_empty() { name.to_owned() } else { format!("{eye}/{name}") }
}
