//! Checker of a renderer's inputs, on images in memory.

use super::doctor_pass::{self, Examined};
use super::{Frame, check_inputs};
use crate::doctor::{Chart, Description, Finding, Observation, maps};
use crate::error::{FrameError, SettingsError};
use crate::frame::{ContextDesc, Reset};
use crate::image::Image;

/// Checks whether the frames of a renderer are what a [`ContextDesc`] says.
#[derive(Clone, Debug)]
pub struct Doctor {
    desc: ContextDesc,
    view: usize,
    chart: Chart,
    /// Light, gaze and jitter of the last frame.
    past: Option<Past>,
}

#[derive(Clone, Debug)]
struct Past {
    light: Image<f32>,
    gaze_px: [f32; 2],
    jitter_px: Option<[f32; 2]>,
}

impl Doctor {
    /// A doctor that has seen nothing, for view `view` of a context of `desc`.
    ///
    /// # Errors
    /// [`SettingsError`] if the description is out of range, or has no such view.
    pub fn new(desc: &ContextDesc, view: usize) -> Result<Self, SettingsError> {
        crate::doctor::check_view(desc, view)?;
        desc.validate()?;
        Ok(Self { desc: *desc, view, chart: Chart::default(), past: None })
    }

    /// Looks at a frame: the same that the post-process gets, one after the other. `jitter_px`: offset in pixels, right
    /// and down, by which the projection moved this frame's picture, if it is known.
    ///
    /// # Errors
    /// [`FrameError`] as for [`CpuAfterimage::process`](super::CpuAfterimage::process); then the frame was not looked at.
    pub fn observe(&mut self, frame: &Frame<'_>, jitter_px: Option<[f32; 2]>) -> Result<(), FrameError> {
        check_inputs(&self.desc, frame)?;
        let (desc, view) = (&self.desc, self.view);
        let light = doctor_pass::light(frame.color[view]);
        let past = self.past.take().filter(|_| frame.reset == Reset::None);
        let held = past.as_ref().map(|p| p.gaze_px);
        let gaze_px = frame.views[view].gaze.resolve(held, desc.size_px);
        let now = Description {
            has_depth: frame.depth.is_some(),
            has_motion: frame.motion.is_some(),
            has_lod: frame.lod.is_some(),
            jitter_px,
            ..Description::new(desc, frame.views[view], gaze_px, held)
        };
        let examined = Examined {
            color: frame.color[view],
            depth: frame.depth.map(|d| d[view]),
            motion: frame.motion.map(|m| m[view]),
            now: &light,
            past: past.as_ref().map_or(&light, |p| &p.light),
            maps: &maps(desc),
        };
        let words = doctor_pass::words(&examined, &now.tiles);
        self.chart.add(Observation { now, past_jitter_px: past.and_then(|p| p.jitter_px), words });
        self.past = Some(Past { light, gaze_px, jitter_px });
        Ok(())
    }

    /// One finding for each [`Check`](crate::Check), from all frames seen so far (the last 16).
    pub fn findings(&self) -> Vec<Finding> {
        self.chart.findings(&self.desc)
    }

    /// Words of the frames seen so far, for the tests.
    #[doc(hidden)]
    pub fn words(&self) -> Vec<&[u32]> {
        self.chart.words()
    }
}
