//! Checks of a renderer's inputs: the findings, and the rules that lead to them. The executors gather the evidence
//! (`cpu::Doctor`, `gpu::Doctor`); the rules are the same for both.

mod camera;
mod color;
mod depth;
mod door;
mod finding;
mod foveation;
mod jitter;
mod motion;
mod observation;
mod shape;
mod sharpness;

pub(crate) use door::Door;
pub use finding::{Check, Fault, Finding, Outcome};
#[cfg(feature = "cpu")]
pub(crate) use observation::Tile;
#[cfg(feature = "gpu")]
pub(crate) use observation::tile_count;
pub(crate) use observation::{Description, Observation, StillSurfaces, maps};

use crate::context::ContextDesc;
use crate::error::SettingsError;
use crate::frame::{Exposure, FrameInputs, Reset};
use crate::uniforms::ViewState;

/// Number of frames that are kept; with more, the oldest ones are forgotten.
const KEPT: usize = 16;

/// A view that is examined, and the observations of its last frames.
#[derive(Clone, Debug)]
pub(crate) struct Chart {
    pub desc: ContextDesc,
    pub view: usize,
    door: Door,
    past: Option<Past>,
    state: ViewState,
    observations: Vec<Observation>,
}

#[derive(Clone, Copy, Debug)]
struct Past {
    gaze_px: [f32; 2],
    jitter_px: [f32; 2],
    exposure: f32,
}

impl Chart {
    /// No observations of view `view`; an error for a view that the context does not have.
    pub fn new(desc: &ContextDesc, view: usize, door: Door) -> Result<Self, SettingsError> {
        if view >= desc.view_count as usize {
            let expected = format!("the index of one of the context's {} views", desc.view_count);
            return Err(SettingsError { setting: "view", found: view.to_string(), expected });
        }
        Ok(Self { desc: *desc, view, door, past: None, state: ViewState::default(), observations: vec![] })
    }

    /// Observation of the next frame, without its words.
    pub fn next<C, S, V>(&mut self, frame: &FrameInputs<'_, C, S, V>) -> Observation {
        let view = frame.views[self.view];
        let gaze_px = view.gaze.resolve(self.past.map(|p| p.gaze_px), &view.geometry);
        self.desc.depth = view.depth_convention(&self.desc);
        let exposure = frame.exposure.of_colors();
        // A frame is compared with the one before unless there was a cut or the exposure changed.
        let continues = frame.reset == Reset::None && !matches!(frame.exposure, Exposure::Changed { .. });
        let past = self.past.filter(|past| continues && past.exposure == exposure);
        self.state = self.state.with(&view, frame.exposure);
        let still = || StillSurfaces::new(&self.desc, &view, &self.state);
        let now = Description {
            has_depth: frame.depth.is_some(),
            has_vectors: frame.motion.is_some(),
            has_motion: frame.motion.is_some() && !self.desc.motion.lacks_camera(),
            still: if frame.depth.is_some() { still() } else { None },
            has_lod: frame.lod.is_some(),
            ..Description::new(&self.desc, view, gaze_px, past.map(|p| p.gaze_px))
        };
        self.past = Some(Past { gaze_px, jitter_px: view.jitter_px, exposure });
        Observation { now, past_jitter_px: past.map(|p| p.jitter_px), words: vec![] }
    }

    pub fn add(&mut self, observation: Observation) {
        if self.observations.len() == KEPT {
            self.observations.remove(0);
        }
        self.observations.push(observation);
    }

    /// Words of the observations, in their order.
    pub fn words(&self) -> Vec<&[u32]> {
        self.observations.iter().map(|o| &o.words[..]).collect()
    }

    /// One finding a check.
    pub fn findings(&self) -> Vec<Finding> {
        let (desc, seen) = (&self.desc, &self.observations);
        let motion = camera::check(desc, seen, self.door).unwrap_or_else(|| motion::check(desc, seen, self.door));
        let jitter = jitter::check(desc, seen, &motion, self.door);
        let depth = depth::check(desc, seen, &motion, self.door);
        let color = color::check(desc, seen);
        let [gaze, foveation] = foveation::check(desc, seen);
        // If a fault can look like another one, report only the fault that must be mended first.
        let after = |first: &Finding, why, finding: Finding| match first.fault() {
            Some(_) => Finding::cannot_tell(finding.check, why),
            None => finding,
        };
        let motion = after(&jitter, "the vectors contain the jitter", motion);
        let gaze = after(&color, "colors are encoded", gaze);
        let foveation = after(&color, "colors are encoded", foveation);
        vec![motion, jitter, depth, color, gaze, foveation]
    }
}
