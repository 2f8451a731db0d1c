//! Makes the foveated frame, or takes the one that a source rendered.

use super::candidate::{Candidate, InMemory, needs_lod};
use super::poison::poisoned;
use crate::frame::{Content, RenderedFrame};
#[cfg(feature = "full")]
use crate::frame::{DeviceFrame, OnDevice};
use crate::lattices::{SampleOrder, SparseGeometry, levels};
use afterimage::simulator::Pyramid;
use afterimage::{Filter, Foveation, Gaze, Image, Lattices, ViewFrame, ViewGeometry};
use std::borrow::Cow;

/// Foveation of a pipeline.
pub(super) struct Foveator {
    pub geometry: ViewGeometry,
    pub foveation: Foveation,
    pub sparse_geometry: SparseGeometry,
    pub sample_order: SampleOrder,
    /// Share of the foveated pixels that get invalid colors.
    pub poison: f32,
    /// Whether all frames are equal.
    is_still: bool,
    /// Mip chain of a still.
    still: Option<Pyramid>,
}

impl Foveator {
    /// A simulator of a foveation, without samples that move.
    pub fn new(geometry: ViewGeometry, foveation: Foveation, is_still: bool) -> Self {
        Self {
            geometry,
            foveation,
            sparse_geometry: SparseGeometry::default(),
            sample_order: SampleOrder::default(),
            poison: 0.0,
            is_still,
            still: None,
        }
    }

    /// Lattices of frame `index`, if frames are sparse.
    pub fn lattices(&self, gaze_px: [f32; 2], index: u64) -> Option<Lattices> {
        let is_sparse = self.foveation.filter == Filter::Sparse;
        is_sparse.then(|| {
            let lattices = self.sample_order.lattices(&self.foveation, &self.geometry, gaze_px, index);
            self.sparse_geometry.of(lattices)
        })
    }

    /// Keeps the mip chain of a still for the next frame.
    pub fn keep(&mut self, pyramid: Option<Pyramid>) {
        self.still = pyramid.filter(|_| self.is_still);
    }

    /// The foveated frame: a simulator's, or the one that its source rendered. `is_read`: some method reads it in
    /// memory.
    pub fn candidate<'a>(&mut self, frame: &'a RenderedFrame, ecc_deg: &Image<f32>, is_read: bool) -> Candidate<'a> {
        let mut candidate = match &frame.content {
            Content::FullRate => self.simulated(frame, ecc_deg, is_read),
            Content::Foveated(foveated) => {
                let noise = Some(&foveated.noise);
                // Lattices say how coarse a sparse frame is.
                let has_lod = foveated.lattices.is_none();
                let color = InMemory { has_lod, noise, ..InMemory::new(Cow::Borrowed(&foveated.color)) };
                let view = self.view(frame);
                Candidate { view, lods: foveated.lod.clone(), in_memory: Some(color), pyramid: None }
            }
            #[cfg(feature = "full")]
            Content::OnDevice(content) => self.on_device(frame, content, is_read),
        };
        if let Some(in_memory) = candidate.in_memory.as_mut().filter(|_| self.poison > 0.0) {
            in_memory.color =
                Cow::Owned(poisoned(in_memory.color.clone().into_owned(), self.poison, frame.index as u32));
            in_memory.is_poisoned = true;
        }
        candidate
    }

    fn simulated<'a>(&mut self, frame: &'a RenderedFrame, ecc_deg: &Image<f32>, is_read: bool) -> Candidate<'a> {
        let lattices = self.lattices(frame.gaze_px, frame.index);
        let lods = match &lattices {
            Some(lattices) => levels(lattices, self.geometry.size_px()),
            None => self.foveation.lod_map(&self.geometry, frame.gaze_px, ecc_deg),
        };
        // Runs on a device use the GPU simulator, which equals this one bit for bit on software devices.
        let pyramid = is_read.then(|| match self.still.take() {
            Some(pyramid) => pyramid,
            // Of sparse frames, only samples are read.
            None => {
                let most = if lattices.is_some() { 0 } else { self.foveation.max_level() };
                Pyramid::new(frame.reference.color.clone(), most)
            }
        });
        let has_lod = needs_lod(self.foveation.filter);
        let in_memory = pyramid.as_ref().map(|pyramid| {
            let color = Cow::Owned(self.foveation.render(pyramid, &lods));
            InMemory { has_lod, ..InMemory::new(color) }
        });
        Candidate { view: ViewFrame { lattices, ..self.view(frame) }, lods, in_memory, pyramid }
    }

    /// What a source foveated on a device; it is read only if a method runs elsewhere.
    #[cfg(feature = "full")]
    fn on_device<'a>(&self, frame: &'a RenderedFrame, content: &'a OnDevice, is_read: bool) -> Candidate<'a> {
        let size = self.geometry.size_px();
        let has_geometry = frame.geometry == SparseGeometry::Samples;
        let (lods, in_memory) = match content {
            OnDevice::Atlas(sparse) => {
                let in_memory = is_read.then(|| {
                    let geometry = has_geometry.then(|| geometry_of(&sparse.atlas));
                    InMemory { geometry, ..InMemory::new(Cow::Owned(color_of(&sparse.atlas))) }
                });
                (levels(&sparse.lattices, size), in_memory)
            }
            OnDevice::Samples(samples) => (levels(&samples.lattices, size), None),
            OnDevice::Composed(composed) => {
                let in_memory = is_read.then(|| {
                    let geometry = has_geometry.then(|| (composed.read_distance(), composed.read_motion()));
                    InMemory { has_lod: true, geometry, ..InMemory::new(Cow::Owned(composed.read_color())) }
                });
                (composed.read_lod(), in_memory)
            }
        };
        Candidate { view: self.view(frame), lods, in_memory, pyramid: None }
    }

    fn view(&self, frame: &RenderedFrame) -> ViewFrame {
        let view = ViewFrame::new(self.geometry, Gaze::At { px: frame.gaze_px });
        let lattices = frame.content.lattices().map(|lattices| frame.geometry.of(lattices));
        ViewFrame { previous_from_current: frame.reference.previous_from_current, lattices, ..view }
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
