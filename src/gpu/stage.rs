//! A stage of a frame: what its passes have in common.

use super::history::History;
use super::uniforms::FrameUniforms;
use super::{Frame, Target, Variant};
use crate::frame::ContextDesc;
use crate::kernel::debug_view::DebugView;
use crate::method::Overrides;
use std::fmt::Debug;
use wgpu::{Buffer, ComputePass, Device, Texture, TextureView};

/// A frame to record: its description, and what follows from it. A stage replaces what it fills.
pub(super) struct Job<'a> {
    pub desc: &'a ContextDesc,
    pub frame: Frame<'a>,
    pub target: &'a Target<'a>,
    /// Of the frame as it was given, so that prewarmed pipelines suffice.
    pub variant: Variant,
    /// View to output in place of the frame, without storing anything.
    pub view: Option<DebugView>,
    pub uniforms: FrameUniforms,
    pub history: &'a History,
    /// Lattices, if a stage reads samples.
    pub lattices: Option<Buffer>,
    /// Gain and fit for each sample, for smr.
    pub lights: Option<TextureView>,
    /// Quads that a plan chose, if it planned anything.
    pub repair_mask: Option<&'a TextureView>,
}

/// A stage on the device.
pub(super) trait Passes: Debug + wgpu::WasmNotSendSync {
    /// Follows a change of the context's size.
    fn resize(&mut self, _device: &Device, _desc: &ContextDesc) {}

    /// Adds what the stage writes to a history that was just made.
    fn extend(&self, _device: &Device, _desc: &ContextDesc, _history: &mut History) {}

    /// Compiles the pipelines of a variant.
    fn prewarm(&self, device: &Device, desc: &ContextDesc, variant: Variant);

    /// Shader and override values of each compiled pipeline.
    fn pipelines(&self) -> Vec<(&'static str, Overrides)>;

    /// Bytes of textures that were made at a frame, in addition to
    /// [`memory_bytes_of`](super::Afterimage::memory_bytes_of).
    fn added_bytes(&self) -> u64 {
        0
    }

    /// Distance of every pixel, if the stage fills it.
    fn filled_depth(&self) -> Option<&Texture> {
        None
    }

    /// Records the passes of a frame.
    fn record<'a>(&'a self, device: &Device, pass: &mut ComputePass<'_>, job: &mut Job<'a>);

    /// Completes a history that was written by other passes than those of a frame.
    fn complete(&self, _device: &Device, _pass: &mut ComputePass<'_>, _history: &History) {}
}
