//! Stages of a frame: the interface that their passes share.

use super::binding::{Binding, INPUTS};
use super::compute::{ComputeShader, PipelineKey, WORKGROUP_WIDTH};
use super::groups::Resource;
use super::history::History;
use super::quads::Quads;
use super::recorder::{Recorder, Workgroups};
use super::textures::{Batch, batches};
use super::uniforms::FrameUniforms;
use super::{Frame, Target, Textures};
use crate::context::ContextDesc;
use crate::frame::Exposure;
use crate::kernel::debug_view::DebugView;
use crate::method::{HistoryLayout, Overrides};
use crate::uniforms::ORIGINS;
use std::fmt::Debug;
use wgpu::{Buffer, Device, TextureView};

/// Which inputs and outputs a frame has, and other properties: each combination has its own pipelines.
#[derive(Clone, Copy, Debug)]
pub(super) struct Specialization {
    /// Set of [bits](Binding::bit).
    present: u32,
    has_regions: bool,
    /// Whether colors are radiance.
    is_exposed: bool,
    /// View to output in place of the frame, without storing anything.
    pub view: Option<DebugView>,
    pub debug: Option<DebugView>,
    /// Whether quads may be shaded in part.
    is_partial: bool,
    /// Number of the settings.
    generation: u64,
}

impl Specialization {
    /// Properties of a frame with whole quads, and of its target.
    pub fn of(frame: &Frame<'_>, target: &Target<'_>, view: Option<DebugView>, generation: u64) -> Self {
        Self {
            present: frame.present() | target.counters.map_or(0, |_| Binding::Counters.bit()),
            has_regions: frame.has_regions() || target.has_regions(),
            is_exposed: matches!(frame.exposure, Exposure::Scene { .. }),
            view,
            debug: target.debug.map(|debug| debug.view),
            is_partial: false,
            generation,
        }
    }

    /// Properties of the plan of a frame: the color is not read, but its regions decide how views are processed.
    pub fn of_plan(frame: &Frame<'_>, generation: u64) -> Self {
        Self::of(frame, &Target::new(frame.color), None, generation)
    }

    /// The same for frames whose quads may be shaded in part, or not.
    pub fn partial(self, is_partial: bool) -> Self {
        Self { is_partial, ..self }
    }

    fn has(&self, binding: Binding) -> bool {
        self.present & binding.bit() != 0
    }

    /// The pipeline of `shader` for such frames.
    pub fn pipeline(&self, device: &Device, desc: &ContextDesc, shader: &ComputeShader) -> wgpu::ComputePipeline {
        let bound = shader.bindings().iter().fold(0, |set, (number, _)| set | 1_u32 << number);
        let code = |view: Option<DebugView>| view.map_or(0, |view| view as u64);
        let bits = u64::from(self.present & bound)
            | u64::from(self.has_regions) << 32
            | u64::from(self.is_exposed) << 33
            | u64::from(self.is_partial && bound & Binding::QuadAround.bit() != 0) << 34
            | code(self.view) << 40
            | code(self.debug) << 48;
        let key = PipelineKey { bits, generation: self.generation };
        shader.keyed_pipeline(device, key, || self.overrides(desc, bound))
    }

    /// Override values of shaders that use the set `bound` of bindings.
    fn overrides(&self, desc: &ContextDesc, bound: u32) -> Overrides {
        use Binding::{Color, Counters, Debug, Depth, Motion, Output, Past, QuadAround, Uniforms};
        let has = |binding| u32::from(self.has(binding));
        let settings = &desc.settings;
        let is_tested = self.has(Depth) && settings.depth_test.is_some();
        let is_sparse = matches!(settings.history_layout(), HistoryLayout::Sparse { .. });
        let code = |view: Option<DebugView>| view.map_or(0, |view| view as u32);
        let list = [
            (Uniforms, "REGIONS", u32::from(self.has_regions)),
            (Color, "EXPOSED", u32::from(self.is_exposed)),
            (Depth, "DEPTH_TEST", u32::from(is_tested)),
            (Motion, "CAMERA_MOTION", desc.motion.camera_code()),
            (Uniforms, "NOISY", u32::from(settings.noisy)),
            (Counters, "COUNT", has(Counters)),
            (Past, "HAS_SPARSE_HISTORY", u32::from(is_sparse)),
            (Output, "VIEW", code(self.view)),
            (Output, "KEEP_ALPHA", u32::from(desc.keep_alpha)),
            (Output, "HAS_ALPHA", u32::from(desc.has_alpha_history())),
            (Debug, "DEBUG_VIEW", code(self.debug)),
            (QuadAround, "PARTIAL", self.is_partial.into()),
        ];
        let inputs = INPUTS.iter().filter_map(|input| Some((input.binding, input.has?, has(input.binding))));
        let list = inputs.chain(list).filter(|(binding, ..)| binding.bit() & bound != 0);
        list.map(|(_, name, value)| (name, value)).chain(settings.overrides()).collect()
    }
}

/// A frame to record: its description, and state that follows from it. A stage that fills an input replaces that input
/// here.
pub(super) struct Job<'a> {
    pub device: &'a Device,
    pub desc: &'a ContextDesc,
    /// Inputs and outputs, by the numbers of their bindings.
    pub textures: [Option<Textures<'a>>; ORIGINS],
    pub counters: Option<&'a Buffer>,
    pub special: Specialization,
    pub uniforms: FrameUniforms,
    pub history: &'a History,
    /// Gain and fit at each shaded quad, for smr.
    pub rectified: Option<&'a TextureView>,
    /// Shaded quads, of a frame shaded by quads.
    pub quads: Option<&'a Quads>,
    pub recorder: &'a mut Recorder,
}

impl Job<'_> {
    /// Views that are processed in one dispatch.
    pub fn batches(&self) -> impl Iterator<Item = Batch> + use<> {
        batches(self.desc.view_count as usize, self.special.has_regions)
    }

    /// The view `view` alone.
    pub fn batch_of(&self, view: u32) -> Batch {
        Batch { views: view..view + 1, regions: self.special.has_regions }
    }

    /// Adds a dispatch of a pass with one invocation for each texel of `size`. `own`: what the pass binds in addition
    /// to what all share; what the frame does not have is a placeholder.
    pub fn dispatch(&mut self, shader: &ComputeShader, batch: &Batch, own: &[(Binding, Resource)], size: [u32; 2]) {
        let workgroups = [size[0].div_ceil(WORKGROUP_WIDTH), size[1], batch.views.len() as u32];
        self.add(shader, batch, own, workgroups.into());
    }

    /// Adds a dispatch whose numbers of workgroups are in a buffer, at a place in bytes.
    pub fn dispatch_indirect(
        &mut self,
        shader: &ComputeShader,
        batch: &Batch,
        own: &[(Binding, Resource)],
        (buffer, place): (&Buffer, u64),
    ) {
        self.add(shader, batch, own, Workgroups::Indirect(buffer.clone(), place));
    }

    fn add(&mut self, shader: &ComputeShader, batch: &Batch, own: &[(Binding, Resource)], workgroups: Workgroups) {
        let mut uniforms = FrameUniforms { first_view: batch.views.start, ..self.uniforms };
        for (i, view) in uniforms.views.iter_mut().enumerate().take(self.desc.view_count as usize) {
            view.origins = self.textures.map(|textures| textures.map_or(0, |textures| textures.packed_origin(i)));
        }
        let pipeline = self.special.pipeline(self.device, self.desc, shader);
        let resource = |number: u32| match own.iter().find(|(binding, _)| *binding as u32 == number) {
            Some((_, resource)) => Some(resource.clone()),
            None if number == Binding::QuadMask as u32 => Some((&self.quads?.mask.whole).into()),
            None if number == Binding::QuadAround as u32 => Some((&self.quads?.around.whole).into()),
            None if number == Binding::Counters as u32 => self.counters.map(Resource::from),
            None => match self.textures.get(number as usize).copied().flatten() {
                Some(textures) => Some(textures.bind(batch)),
                None => self.history.bound(number),
            },
        };
        self.recorder.add(self.device, (shader, pipeline), Some(&uniforms), resource, workgroups);
    }
}

/// A stage on the device.
pub(super) trait Passes: Debug + wgpu::WasmNotSendSync {
    /// Follows a change of the context's size.
    fn resize(&mut self, _device: &Device, _desc: &ContextDesc) {}

    /// Shaders that were made.
    fn shaders(&self) -> Vec<&ComputeShader>;

    /// Compiles the pipelines of a variant.
    fn prewarm(&self, device: &Device, desc: &ContextDesc, special: Specialization) {
        for shader in self.shaders() {
            special.pipeline(device, desc, shader);
        }
    }

    /// Adds the dispatches of a frame.
    fn record<'a>(&'a self, job: &mut Job<'a>);

    /// Adds the dispatches that complete a history which passes outside a frame have written, such as a resize.
    fn complete(&self, _device: &Device, _recorder: &mut Recorder, _history: &History) {}
}
