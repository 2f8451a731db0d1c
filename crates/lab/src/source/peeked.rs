//! A source whose first frame was read ahead.

use super::{CameraPose, FrameSource, SourceInfo};
use crate::clock::Elapsed;
#[cfg(feature = "full")]
use crate::device::Headless;
use crate::error::InputError;
#[cfg(feature = "full")]
use crate::frame::{ComposedFrame, DeviceFrame, DeviceSamples, SparseFrame};
use crate::frame::{FoveatedFrame, Guide, SourceFrame};
#[cfg(feature = "full")]
use crate::lattices::SparseGeometry;
#[cfg(feature = "full")]
use crate::quad_views::QuadViews;
#[cfg(feature = "full")]
use afterimage::Lattices;
use glam::DMat4;
#[cfg(feature = "full")]
use std::sync::Arc;

/// Reads frame 0 when it is made, as a check that the input can be read, and hands that out when it is asked for first.
pub struct PeekedSource<'a> {
    source: &'a mut dyn FrameSource,
    first: Option<SourceFrame>,
}

impl<'a> PeekedSource<'a> {
    /// Reads frame 0 of `source`.
    ///
    /// # Errors
    /// As for [`FrameSource::frame`].
    pub fn new(source: &'a mut dyn FrameSource) -> Result<Self, InputError> {
        let first = Some(source.frame(0)?);
        Ok(Self { source, first })
    }
}

impl FrameSource for PeekedSource<'_> {
    fn info(&self) -> &SourceInfo {
        self.source.info()
    }

    fn frame(&mut self, index: u64) -> Result<SourceFrame, InputError> {
        match self.first.take() {
            Some(first) if index == 0 => Ok(first),
            _ => self.source.frame(index),
        }
    }

    fn foveated(
        &mut self,
        index: u64,
        gaze_px: [f32; 2],
        guide: Option<&Guide>,
    ) -> Result<Option<FoveatedFrame>, InputError> {
        self.source.foveated(index, gaze_px, guide)
    }

    #[cfg(feature = "full")]
    fn foveated_on(
        &mut self,
        device: &Arc<Headless>,
        index: u64,
        gaze_px: [f32; 2],
        geometry: SparseGeometry,
    ) -> Result<Option<DeviceSamples>, InputError> {
        self.source.foveated_on(device, index, gaze_px, geometry)
    }

    #[cfg(feature = "full")]
    fn sparse(&mut self, index: u64, lattices: &Lattices) -> Result<Option<SparseFrame>, InputError> {
        self.source.sparse(index, lattices)
    }

    #[cfg(feature = "full")]
    fn composed(&mut self, index: u64, views: &QuadViews) -> Result<Option<ComposedFrame>, InputError> {
        self.source.composed(index, views)
    }

    #[cfg(feature = "full")]
    fn device_frame(&self) -> Option<DeviceFrame> {
        self.source.device_frame()
    }

    fn render_time(&self) -> Option<Elapsed> {
        self.source.render_time()
    }

    fn camera_pose(&self, index: u64) -> Option<CameraPose> {
        self.source.camera_pose(index)
    }

    fn steer(&mut self, index: u64, before_and_now: Option<[DMat4; 2]>) {
        self.source.steer(index, before_and_now);
    }
}
