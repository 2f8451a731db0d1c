//! `--stereo`: views and gaze of one or two eyes.

use super::setup::Setup;
use crate::failure::Failure;
use afterimage_lab::view::View;
use afterimage_trace::stereo::GazePoint;

/// Largest distance between the pupils, meters: people have 0.05 to 0.075.
const MAX_IPD_M: f64 = 0.2;

/// One eye at the camera, or two beside it.
pub struct Eyes {
    /// Distance between the pupils, meters; `None`: one eye.
    pub ipd_m: Option<f64>,
    /// Last gaze of each eye, pixels.
    last: Vec<[f32; 2]>,
}

impl Eyes {
    pub fn new(ipd_m: Option<f64>, size: [u32; 2]) -> Result<Self, Failure> {
        if let Some(ipd_m) = ipd_m
            && !(ipd_m > 0.0 && ipd_m <= MAX_IPD_M)
        {
            return Err(Failure::Input(format!(
                "--stereo {ipd_m}: expected the distance between the pupils in meters, above 0 and up to {MAX_IPD_M}; typical is 0.063"
            )));
        }
        let middle = size.map(|s| 0.5 * (s as f32 - 1.0));
        Ok(Self { ipd_m, last: vec![middle; if ipd_m.is_some() { 2 } else { 1 }] })
    }

    /// Names of the eyes, which are their folders; empty for a single eye.
    pub fn names(&self) -> &'static [&'static str] {
        if self.ipd_m.is_some() { &["left", "right"] } else { &[""] }
    }

    /// View of each eye.
    pub fn views(&self, head: &View) -> Vec<View> {
        self.ipd_m.map_or_else(|| vec![*head], |ipd_m| head.stereo(ipd_m).to_vec())
    }

    /// Gaze of each eye at the point in space that the head's `gaze_px` shows. An eye that does not see the point keeps
    /// its last gaze.
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

/// Path of a file or folder within an eye's folder; separated by / on any system.
pub fn below(eye: &str, name: &str) -> String {
    if eye.is_empty() { name.to_owned() } else { format!("{eye}/{name}") }
}
