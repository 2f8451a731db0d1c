//! Makes the foveated frame, or takes the one that a source rendered.

use super::candidate::{Candidate, InMemory, needs_lod};
use crate::frame::{Content, DeviceContent, RenderedFrame};
use crate::quad_views::Geometry;
use afterimage::internal::{Foveation, FoveationKind, Pyramid, ViewFrame};
use afterimage::{Gaze, Image, ViewGeometry};
use std::borrow::Cow;

/// Foveation of a pipeline.
pub(super) struct Foveator {
    pub geometry: ViewGeometry,
    pub foveation: Foveation,
    /// Depth and motion of quad views.
    pub view_geometry: Geometry,
    /// Whether all frames are equal.
    is_still: bool,
    /// Mip chain of a still.
    still: Option<Pyramid>,
}

impl Foveator {
    /// A simulator of a foveation.
    pub fn new(geometry: ViewGeometry, foveation: Foveation, is_still: bool) -> Self {
        Self { geometry, foveation, view_geometry: Geometry::default(), is_still, still: None }
    }

    /// Keeps the mip chain of a still for the next frame.
    pub fn keep(&mut self, pyramid: Option<Pyramid>) {
        self.still = pyramid.filter(|_| self.is_still);
    }

    /// The foveated frame: a simulator's, or the one that its source rendered. `is_read`: some method reads it in
    /// memory.
    pub fn candidate<'a>(&mut self, frame: &'a RenderedFrame, is_read: bool) -> Candidate<'a> {
        match &frame.content {
            Content::FullRate | Content::Jittered(_) => self.simulated(frame, is_read),
            Content::Foveated(foveated) => {
                let noise = foveated.noise.as_ref();
                let color = InMemory { has_lod: true, noise, ..InMemory::new(Cow::Borrowed(&foveated.color)) };
                let view = self.view(frame);
                Candidate { view, lods: foveated.lod.clone(), in_memory: Some(color), pyramid: None }
            }
            Content::Surfaces => {
                let lods = self.foveation.lod_map(&self.geometry, frame.gaze_px);
                let unshaded = InMemory::new(Cow::Owned(Image::filled([0; 2], [0.0; 3])));
                Candidate { view: self.view(frame), lods, in_memory: Some(unshaded), pyramid: None }
            }
            Content::OnDevice(content) => self.on_device(frame, content.as_ref(), is_read),
        }
    }

    fn simulated<'a>(&mut self, frame: &'a RenderedFrame, is_read: bool) -> Candidate<'a> {
        let lods = self.foveation.lod_map(&self.geometry, frame.gaze_px);
        // Runs on a device use the GPU simulator, which equals this one bit for bit on software devices.
        let is_still = self.is_still && matches!(frame.content, Content::FullRate);
        let pyramid = is_read.then(|| match self.still.take().filter(|_| is_still) {
            Some(pyramid) => pyramid,
            // Methods read only the shaded pixels of planned frames.
            None => {
                let is_sampled = self.foveation.kind == FoveationKind::Quads;
                let most = if is_sampled { 0 } else { self.foveation.max_level() };
                Pyramid::new(frame.given().color.clone(), most)
            }
        });
        let has_lod = needs_lod(self.foveation.kind);
        let in_memory = pyramid.as_ref().map(|pyramid| {
            let color = Cow::Owned(self.foveation.render(pyramid, &lods));
            InMemory { has_lod, ..InMemory::new(color) }
        });
        Candidate { view: self.view(frame), lods, in_memory, pyramid }
    }

    /// A frame that its source foveated on a device. It is read back only if a method runs elsewhere.
    fn on_device<'a>(&self, frame: &RenderedFrame, content: &dyn DeviceContent, is_read: bool) -> Candidate<'a> {
        let color = if is_read { content.read_color() } else { None };
        let lods = content.lods();
        let is_shaded = lods.is_some();
        let in_memory = color.map(|color| {
            let has_geometry = frame.geometry == Geometry::Samples || !is_shaded;
            let geometry = if has_geometry { content.read_geometry() } else { None };
            InMemory { has_lod: is_shaded, geometry, ..InMemory::new(Cow::Owned(color)) }
        });
        let lods = lods.unwrap_or_else(|| self.foveation.lod_map(&self.geometry, frame.gaze_px));
        Candidate { view: self.view(frame), lods, in_memory, pyramid: None }
    }

    fn view(&self, frame: &RenderedFrame) -> ViewFrame {
        let view = ViewFrame::new(self.geometry, Gaze::At { px: frame.gaze_px });
        let previous_from_current = frame.reference.previous_from_current;
        ViewFrame { previous_from_current, jitter_px: frame.jitter_px, ..view }
    }
}
