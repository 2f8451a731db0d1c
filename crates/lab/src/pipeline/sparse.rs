//! Sparse frames that a source rendered with their samples alone.

use super::{Candidate, Pipeline, Step};
use crate::clock::Stopwatch;
use crate::device::Headless;
use crate::frame::{DeviceFrame, DeviceSamples, SourceFrame, SparseFrame};
use crate::lattices::{SparseGeometry, levels};
use afterimage::{FrameError, Image, ViewFrame};
use std::sync::Arc;

impl Pipeline {
    /// As [`step`](Self::step), for a sparse frame that its source rendered with the samples of
    /// [`lattices`](Self::lattices) for the gaze of [`look`](Self::look). `frame` is the full-rate frame, for the
    /// metrics and, with [`SparseGeometry::Full`], for depth and motion; `rendered` is that frame where it is on a
    /// device, too. Samples on the pipeline's device stay there.
    ///
    /// # Errors
    /// As for `step`.
    pub fn step_sparse(
        &mut self,
        index: u64,
        frame: &SourceFrame,
        gaze_px: [f32; 2],
        rendered: Option<&DeviceFrame>,
        sparse: &SparseFrame,
    ) -> Result<Step, FrameError> {
        let size = self.geometry.size_px();
        let watch = Stopwatch::start();
        let ecc_deg = self.geometry.eccentricity_map(gaze_px);
        let lattices = self.sparse_geometry.of(sparse.lattices);
        let lods = levels(&lattices, size);
        let view = ViewFrame { lattices: Some(lattices), ..self.view(frame, gaze_px) };
        let has_geometry = self.sparse_geometry == SparseGeometry::Samples;
        let atlas = &sparse.atlas;
        let color = self.foveates_in_memory().then(|| color_of(atlas));
        #[cfg(feature = "ablation")]
        let color = color.map(|color| super::poisoned(color, self.poison, index as u32));
        let geometry = (color.is_some() && has_geometry).then(|| geometry_of(atlas));
        if let Some(device) = &mut self.device {
            let gpu = device.gpu.clone();
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            if !has_geometry {
                device.inputs.import_or_upload(&mut encoder, frame, rendered);
            }
            device.inputs.import_atlas(&mut encoder, atlas, has_geometry);
            gpu.queue.submit([encoder.finish()]);
            gpu.wait();
            #[cfg(feature = "ablation")]
            if let Some(color) = color.as_ref().filter(|_| self.poison > 0.0) {
                device.inputs.write_atlas_color(color);
            }
            gpu.check()?;
        }
        let candidate = color.as_ref().map(|color| Candidate {
            color,
            lod_given: None,
            noise: None,
            geometry: geometry.as_ref().map(|(depth, motion)| (depth, motion)),
        });
        let foveation_ms = watch.wall_ms();
        let tracked = self.tracker.advance(frame, &self.geometry, &ecc_deg, &lods);
        let outputs = self.run(index, frame, &view, candidate.as_ref(), None)?;
        Ok(Step { gaze_px, ecc_deg, lods, tracked, outputs, foveation_ms })
    }

    /// The device that all runs work on, if frames are foveated nowhere else: where
    /// [`step_samples`](Self::step_samples) takes samples.
    pub fn samples_device(&self) -> Option<Arc<Headless>> {
        self.device.as_ref().filter(|_| !self.foveates_in_memory()).map(|device| device.gpu.clone())
    }

    /// As [`step_foveated`](Self::step_foveated), for a sparse frame whose samples its source left on the
    /// [`samples_device`](Self::samples_device). `frame` is the full-rate frame, for the metrics and, with
    /// [`SparseGeometry::Full`], for depth and motion.
    ///
    /// # Errors
    /// As for `step`.
    pub fn step_samples(
        &mut self,
        index: u64,
        frame: &SourceFrame,
        gaze_px: [f32; 2],
        samples: &DeviceSamples,
    ) -> Result<Step, FrameError> {
        let size = self.geometry.size_px();
        let ecc_deg = self.geometry.eccentricity_map(gaze_px);
        let lattices = self.sparse_geometry.of(samples.lattices);
        let lods = levels(&lattices, size);
        let tracked = self.tracker.advance(frame, &self.geometry, &ecc_deg, &lods);
        let view = ViewFrame { lattices: Some(lattices), ..self.view(frame, gaze_px) };
        let has_geometry = self.sparse_geometry == SparseGeometry::Samples;
        if let Some(device) = &mut self.device {
            if !has_geometry {
                device.inputs.upload_others(frame);
            }
            device.inputs.set_samples(samples, has_geometry);
        }
        let outputs = self.run(index, frame, &view, None, None)?;
        Ok(Step { gaze_px, ecc_deg, lods, tracked, outputs, foveation_ms: 0.0 })
    }

    /// Depth and motion of sparse frames.
    pub fn sparse_geometry(&self) -> SparseGeometry {
        self.sparse_geometry
    }
}

/// Waits for all submitted work, then reads the color. Pixels that are not finite are black, as in imported frames.
fn color_of(atlas: &DeviceFrame) -> Image<[f32; 3]> {
    let color = crate::raster::read_color(&atlas.device, &atlas.color);
    color.map(|c| if c.iter().all(|v| v.is_finite()) { c } else { [0.0; 3] })
}

/// Waits for all submitted work, then reads distance and motion vectors.
fn geometry_of(atlas: &DeviceFrame) -> (Image<f32>, Image<[f32; 2]>) {
    let DeviceFrame { device, depth, motion, near, .. } = atlas;
    (crate::raster::read_distance(device, depth, *near), device.read(motion, 0))
}
