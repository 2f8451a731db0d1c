//! Frames that their source composes of quad views.

use super::{Candidate, Pipeline, SparseGeometry, Step};
use crate::clock::Stopwatch;
use crate::frame::{ComposedFrame, DeviceFrame, SourceFrame};
use afterimage::FrameError;

impl Pipeline {
    /// As [`step`](Self::step), for a frame that its source composed of [`quad_views`](Self::quad_views) for the gaze
    /// of [`look`](Self::look). `frame` is the full-rate frame, for the metrics and, with [`SparseGeometry::Full`], for
    /// depth and motion; `rendered` is that frame where it is on a device, too. What is composed on the pipeline's
    /// device stays there; metrics read the levels of detail.
    ///
    /// # Errors
    /// As for `step`.
    pub fn step_composed(
        &mut self,
        index: u64,
        frame: &SourceFrame,
        gaze_px: [f32; 2],
        rendered: Option<&DeviceFrame>,
        composed: &ComposedFrame,
    ) -> Result<Step, FrameError> {
        let watch = Stopwatch::start();
        let ecc_deg = self.geometry.eccentricity_map(gaze_px);
        let lods = composed.read_lod();
        let view = self.view(frame, gaze_px);
        let has_geometry = self.sparse_geometry == SparseGeometry::Samples;
        let color = self.foveates_in_memory().then(|| composed.read_color());
        #[cfg(feature = "ablation")]
        let color = color.map(|color| super::poisoned(color, self.poison, index as u32));
        let geometry = (color.is_some() && has_geometry).then(|| (composed.read_distance(), composed.read_motion()));
        if let Some(device) = &mut self.device {
            let gpu = device.gpu.clone();
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            if !has_geometry {
                device.inputs.import_or_upload(&mut encoder, frame, rendered);
            }
            gpu.queue.submit([encoder.finish()]);
            device.inputs.take_composed(composed, has_geometry);
            #[cfg(feature = "ablation")]
            if let Some(color) = color.as_ref().filter(|_| self.poison > 0.0) {
                device.inputs.upload_foveated(frame, color, Some(&lods), None);
            }
            gpu.wait();
            gpu.check()?;
        }
        let candidate = color.as_ref().map(|color| Candidate {
            color,
            lod_given: Some(&lods),
            noise: None,
            geometry: geometry.as_ref().map(|(depth, motion)| (depth, motion)),
        });
        let foveation_ms = watch.wall_ms();
        let tracked = self.tracker.advance(frame, &self.geometry, &ecc_deg, &lods);
        let outputs = self.run(index, frame, &view, candidate.as_ref(), None)?;
        Ok(Step { gaze_px, ecc_deg, lods, tracked, outputs, foveation_ms })
    }
}
