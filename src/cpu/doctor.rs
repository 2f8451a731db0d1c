//! Checker of a renderer's inputs, on images in memory.

use super::doctor_pass::{self, Examined};
use super::frame::{Frame, check_inputs};
use crate::context::ContextDesc;
use crate::doctor::{Chart, Door, Finding, maps};
use crate::error::{FrameError, SettingsError};
use crate::image::Image;

/// Checks whether a renderer's frames match a [`ContextDesc`]: motion vectors, depth, colors, gaze and foveation of one
/// view. Give it some consecutive frames in which the camera moves and the eye looks around. With
/// [`FoveationKind::Quads`](crate::internal::FoveationKind::Quads), shade them at full rate, without the plan; motion,
/// jitter, depth and color are checked.
///
/// ```
/// use afterimage::cpu::{Doctor, Frame};
/// use afterimage::doctor::Fault;
/// use afterimage::internal::{ContextDesc, FoveationKind, ViewFrame};
/// use afterimage::{Gaze, Image, ViewGeometry};
///
/// // A pattern moves to the right by 2 pixels a frame. It was to the left before, but the vectors point to the right.
/// let size = [160, 96];
/// let pattern = |x: f32, y: f32| 0.5 + 0.2 * (0.4 * x + 0.2 * y).sin() + 0.2 * (0.1 * x - 0.3 * y).cos();
/// let motion = Image::filled(size, [2.0, 0.0]);
/// let views = [ViewFrame::new(ViewGeometry::flat(size, 70.0)?, Gaze::At { px: [40.0, 30.0] })];
///
/// let mut desc = ContextDesc::new(size);
/// desc.settings.foveation.kind = FoveationKind::Off;
/// let mut doctor = Doctor::new(&desc, 0)?;
/// for index in 0..4 {
///     let color = Image::from_fn(size, |[x, y]| [pattern(x as f32 - 2.0 * index as f32, y as f32); 3]);
///     let (colors, motions) = ([&color], [&motion]);
///     let frame = Frame { motion: Some(&motions), ..Frame::new(&colors, &views, index) };
///     doctor.observe(&frame)?;
/// }
/// let finding = &doctor.findings()[0];
/// assert_eq!(finding.fault(), Some(Fault::MotionDirection));
/// println!("{finding}");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Doctor {
    chart: Chart,
    /// Roots of the last frame.
    past: Option<Image<f32>>,
}

impl Doctor {
    /// A doctor that has seen no frame yet, for view `view` of a context with the description `desc`.
    ///
    /// # Errors
    /// [`SettingsError`] if the description is out of range, or has no such view.
    pub fn new(desc: &ContextDesc, view: usize) -> Result<Self, SettingsError> {
        let chart = Chart::new(desc, view, Door::Context)?;
        desc.validate()?;
        Ok(Self { chart, past: None })
    }

    /// Examines a frame. Give it the same frames as the post-process, in the same order.
    ///
    /// # Errors
    /// [`FrameError`] if a size, a number of images or a value does not fit the description; then the frame was not
    /// examined.
    pub fn observe(&mut self, frame: &Frame<'_>) -> Result<(), FrameError> {
        check_inputs(&self.chart.desc, frame)?;
        let view = self.chart.view;
        let exposure = frame.exposure.of_colors();
        let roots = doctor_pass::root_means(frame.color[view], exposure);
        let mut observation = self.chart.next(frame);
        let examined = Examined {
            color: frame.color[view],
            exposure,
            depth: frame.depth.map(|d| d[view]),
            motion: frame.motion.map(|m| m[view]),
            now: &roots,
            past: self.past.as_ref().filter(|_| observation.now.has_past).unwrap_or(&roots),
            maps: &maps(&self.chart.desc),
            still: observation.now.still,
        };
        observation.words = doctor_pass::words(&examined, &observation.now.tiles);
        self.chart.add(observation);
        self.past = Some(roots);
        Ok(())
    }

    /// One finding for each [`Check`](crate::doctor::Check), from all frames seen so far (the last 16).
    pub fn findings(&self) -> Vec<Finding> {
        self.chart.findings()
    }

    /// Words of the frames seen so far, oldest first.
    pub fn words(&self) -> Vec<&[u32]> {
        self.chart.words()
    }
}
