//! Checks of a renderer's inputs: the findings, and the rules that lead to them. The executors gather the evidence
//! (`cpu::Doctor`, `gpu::Doctor`); the rules are the same for both.

mod color;
mod depth;
mod finding;
mod foveation;
mod jitter;
mod motion;
mod observation;
mod sharpness;

pub use finding::{Check, Fault, Finding, Outcome};
#[cfg(feature = "cpu")]
pub(crate) use observation::Tile;
#[cfg(feature = "gpu")]
pub(crate) use observation::tile_count;
pub(crate) use observation::{Description, Observation, maps};

use crate::context::ContextDesc;
use crate::error::SettingsError;
use crate::foveation::Filter;
use crate::frame::{Exposure, FrameInputs, Reset};

/// Number of frames that are kept; with more, the oldest ones are forgotten.
const KEPT: usize = 16;

/// Observations of the last frames.
#[derive(Clone, Debug, Default)]
pub(crate) struct Chart {
    observations: Vec<Observation>,
}

impl Chart {
    /// Adds the observation of a frame.
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
    pub fn findings(&self, desc: &ContextDesc) -> Vec<Finding> {
        let seen = &self.observations;
        let motion = motion::check(desc, seen);
        let jitter = jitter::check(desc, seen, &motion);
        let depth = depth::check(desc, seen, &motion);
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

/// Whether a frame can be compared with the one before, whose colors had the exposure `before`.
pub(crate) fn continues<C, S, V>(frame: &FrameInputs<'_, C, S, V>, before: f32) -> bool {
    let has_changed = matches!(frame.exposure, Exposure::Changed { .. }) || frame.exposure.of_colors() != before;
    frame.reset == Reset::None && !has_changed
}

/// Rejects lattices, which the rules do not cover yet, and the index of a view that a context does not have.
pub(crate) fn check_view(desc: &ContextDesc, view: usize) -> Result<(), SettingsError> {
    let filter = desc.settings.foveation.filter;
    if filter == Filter::Sparse {
        let expected = "another filter: the doctor does not know lattices yet".into();
        return Err(SettingsError { setting: "foveation filter", found: filter.name().into(), expected });
    }
    if view < desc.view_count as usize {
        return Ok(());
    }
    let expected = format!("the index of one of the context's {} views", desc.view_count);
    Err(SettingsError { setting: "view", found: view.to_string(), expected })
}
