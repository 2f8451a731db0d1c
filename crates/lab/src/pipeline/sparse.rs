//! Sparse frames: lattices of samples that move every frame.

#[cfg(feature = "full")]
use super::{Candidate, Pipeline, Step};
#[cfg(feature = "full")]
use crate::clock::Stopwatch;
#[cfg(feature = "full")]
use crate::device::Headless;
#[cfg(feature = "full")]
use crate::frame::{DeviceFrame, DeviceSamples, SourceFrame, SparseFrame};
use afterimage::kernel::lattice::offset_px;
use afterimage::{Foveation, Image, Lattice, Lattices, ViewGeometry};
#[cfg(feature = "full")]
use afterimage::{FrameError, ViewFrame};
use rayon::prelude::*;
#[cfg(feature = "full")]
use std::sync::Arc;

/// Depth and motion of a sparse frame. Default: [`Full`](Self::Full).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SparseGeometry {
    /// At every pixel: a visibility buffer, a prepass, or shading-rate hardware.
    #[default]
    Full,
    /// At the samples alone ([`Lattices::with_geometry_at_samples`]): small views.
    Samples,
}

impl SparseGeometry {
    /// Lattices of a frame with such geometry.
    pub fn of(self, lattices: Lattices) -> Lattices {
        match self {
            Self::Full => lattices,
            Self::Samples => lattices.with_geometry_at_samples(),
        }
    }
}

/// Order in which the pixels of a block are sampled. Default: [`Bayer`](Self::Bayer).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SampleOrder {
    /// Bayer's matrix: the order of [`Foveation::lattices`].
    #[default]
    Bayer,
    /// Row by row.
    Scanline,
    /// The (0,2)-sequence of Sobol: any power of two of successive frames has as many samples in all columns, rows and
    /// boxes of a size.
    Sobol,
}

impl SampleOrder {
    /// All orders.
    pub const ALL: [Self; 3] = [Self::Bayer, Self::Scanline, Self::Sobol];

    /// Position of the sample in a block of `step` x `step` pixels (a power of two, at most 256) in frame `index`.
    pub fn offset_px(self, index: u64, step: u32) -> [u32; 2] {
        let turn = (index % u64::from(step * step)) as u32;
        match self {
            Self::Bayer => offset_px(index, step),
            Self::Scanline => [turn % step, turn / step],
            Self::Sobol => {
                let mut direction = 1 << 31;
                let mut second = 0;
                for bit in 0..u32::BITS {
                    second ^= if turn >> bit & 1 == 1 { direction } else { 0 };
                    direction ^= direction >> 1;
                }
                // The highest log2(step) bits.
                [turn.reverse_bits(), second].map(|v| ((u64::from(v) * u64::from(step)) >> 32) as u32)
            }
        }
    }

    /// [`Foveation::lattices`] with samples in this order.
    ///
    /// # Panics
    /// Never: the stack differs from a valid one in the offsets alone.
    pub fn lattices(self, foveation: &Foveation, geometry: &ViewGeometry, gaze_px: [f32; 2], index: u64) -> Lattices {
        let stack = foveation.lattices(geometry, gaze_px, index);
        let size = geometry.size_px();
        let moved = |lattice: &Lattice| {
            let ([low, _], offset) = (lattice.covered_px(), self.offset_px(index, lattice.step));
            Lattice { first_px: [0, 1].map(|i| low[i] + offset[i] % size[i]), ..*lattice }
        };
        // As in the default order, a lattice whose samples all lie beyond the view's edge is left out.
        let has_samples = |lattice: &Lattice| (0..2).all(|i| lattice.first_px[i] < size[i]);
        let moved: Vec<_> = stack.as_slice().iter().map(moved).filter(has_samples).collect();
        Lattices::new(&moved).expect("only the offsets are new")
    }
}

/// Level of detail of every pixel: log2 of the step of its lattice.
pub fn levels(lattices: &Lattices, size_px: [u32; 2]) -> Image<f32> {
    let mut levels = Image::filled(size_px, 0.0);
    let width = size_px[0] as usize;
    levels.pixels_mut().par_chunks_mut(width.max(1)).enumerate().for_each(|(y, row)| {
        // A finer lattice replaces coarser ones.
        for lattice in lattices.as_slice().iter().rev() {
            let [[left, top], [right, bottom]] = lattice.covered_px().map(|px| px.map(|v| v as usize));
            if (top..bottom).contains(&y) {
                row[left.min(width)..right.min(width)].fill(lattice.step.ilog2() as f32);
            }
        }
    });
    levels
}

#[cfg(feature = "full")]
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
            let is_here = |frame: &&DeviceFrame| Arc::ptr_eq(&frame.device, &gpu);
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            match rendered.filter(is_here) {
                _ if has_geometry => {}
                Some(rendered) => device.inputs.import(&mut encoder, rendered),
                None => device.inputs.upload(frame),
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
#[cfg(feature = "full")]
fn color_of(atlas: &DeviceFrame) -> Image<[f32; 3]> {
    let color = crate::raster::read_color(&atlas.device, &atlas.color);
    color.map(|c| if c.iter().all(|v| v.is_finite()) { c } else { [0.0; 3] })
}

/// Waits for all submitted work, then reads distance and motion vectors.
#[cfg(feature = "full")]
fn geometry_of(atlas: &DeviceFrame) -> (Image<f32>, Image<[f32; 2]>) {
    let DeviceFrame { device, depth, motion, near, .. } = atlas;
    (crate::raster::read_distance(device, depth, *near), device.read(motion, 0))
}
