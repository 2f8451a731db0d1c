//! Stages of a frame: the interface that their passes share.

use super::history::History;
use super::uniforms::FrameUniforms;
use super::{Frame, Target, Variant};
use crate::frame::ContextDesc;
use crate::kernel::debug_view::DebugView;
use crate::method::Overrides;
use std::fmt::Debug;
use wgpu::{Buffer, ComputePass, Device, Texture, TextureView};

/// A frame to record: its description, and state that follows from it. A stage that fills an input replaces that input
/// here.
pub(super) struct Job<'a> {
    pub desc: &'a ContextDesc,
    pub frame: Frame<'a>,
    pub target: &'a Target<'a>,
    /// Variant of the frame as the caller gave it, so that prewarmed pipelines suffice.
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

    /// Adds the stage's own textures to a new history.
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

    /// Completes a history that passes outside a frame have written, such as a resize.
    fn complete(&self, _device: &Device, _pass: &mut ComputePass<'_>, _history: &History) {}
}
