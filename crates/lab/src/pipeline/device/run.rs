//! A method on a device.

use super::{DeviceFormats, WRITTEN};
use crate::device::Headless;
use afterimage::gpu::{Afterimage, Frame, Recorded, Target, Timestamps};
use afterimage::internal::ContextDesc;
use afterimage::internal::{Sources, method_pass};
use afterimage::{CreateError, DebugView, FrameError, FrameStats};
use std::sync::Arc;
use wgpu::{Buffer, CommandEncoder, Texture};

/// Run of a method on a device: context, output and counters.
#[derive(Debug)]
pub struct DeviceRun {
    gpu: Arc<Headless>,
    post: Afterimage,
    output: Texture,
    counters: Buffer,
    debug: Option<Texture>,
}

impl DeviceRun {
    /// Creates a run with `desc`'s settings; its output has the color format of `formats`.
    ///
    /// # Errors
    /// [`CreateError`] if a setting is out of range or the device does not support it.
    pub fn new(gpu: &Arc<Headless>, desc: &ContextDesc, formats: DeviceFormats) -> Result<Self, CreateError> {
        Ok(Self::of(gpu, Afterimage::new(&gpu.device, desc, formats.color)?, formats))
    }

    /// Creates a run with `source` as shader text of the method's pass.
    ///
    /// # Errors
    /// As for [`new`](Self::new).
    pub fn with_shader(
        gpu: &Arc<Headless>,
        desc: &ContextDesc,
        formats: DeviceFormats,
        source: &str,
    ) -> Result<Self, CreateError> {
        Self::with_sources(gpu, desc, formats, Sources::default().with(method_pass(&desc.settings), source))
    }

    /// Creates a run with other texts of the passes.
    ///
    /// # Errors
    /// As for [`new`](Self::new).
    pub fn with_sources(
        gpu: &Arc<Headless>,
        desc: &ContextDesc,
        formats: DeviceFormats,
        sources: Sources,
    ) -> Result<Self, CreateError> {
        Ok(Self::of(gpu, Afterimage::with_sources(&gpu.device, desc, formats.color, sources)?, formats))
    }

    fn of(gpu: &Arc<Headless>, post: Afterimage, formats: DeviceFormats) -> Self {
        let output = gpu.texture(post.desc().size_px, 1, formats.color, WRITTEN);
        Self { post, output, counters: gpu.counters(), debug: None, gpu: gpu.clone() }
    }

    /// Context of the post-process.
    pub fn post(&self) -> &Afterimage {
        &self.post
    }

    /// Context of the post-process, to change its settings or to empty its history.
    pub fn post_mut(&mut self) -> &mut Afterimage {
        &mut self.post
    }

    /// Records the method's pass.
    ///
    /// # Errors
    /// [`FrameError`] if the frame does not match the context.
    pub fn record(
        &mut self,
        encoder: &mut CommandEncoder,
        frame: &Frame<'_>,
        timestamps: Option<Timestamps<'_>>,
    ) -> Result<Recorded, FrameError> {
        let target = Target { timestamps, ..Target::new(&self.output) };
        self.post.record(&self.gpu.device, encoder, frame, target)
    }

    /// Records a debug view of the decisions that [`record`](Self::record) of this frame makes, and counts them for
    /// [`stats`](Self::stats). Call it before `record`, which replaces the history. Counting is separate because it
    /// would make `record` a fifth slower.
    ///
    /// # Errors
    /// As for `record`.
    pub fn record_view(
        &mut self,
        encoder: &mut CommandEncoder,
        frame: &Frame<'_>,
        view: DebugView,
    ) -> Result<Recorded, FrameError> {
        let (gpu, size, format) = (&self.gpu, self.post.desc().size_px, self.output.format());
        let debug = &*self.debug.get_or_insert_with(|| gpu.texture(size, 1, format, WRITTEN));
        let target = Target { counters: Some(&self.counters), ..Target::new(debug) };
        self.post.record_view(&gpu.device, encoder, frame, target, view)
    }

    /// Output of the last [`record`](Self::record).
    pub fn output(&self) -> &Texture {
        &self.output
    }

    /// Debug view of the last [`record_view`](Self::record_view).
    pub fn debug(&self) -> Option<&Texture> {
        self.debug.as_ref()
    }

    /// Waits for submitted work and reads the counters of the last [`record_view`](Self::record_view).
    pub fn stats(&self) -> FrameStats {
        self.gpu.read_counters(&self.counters)
    }
}
