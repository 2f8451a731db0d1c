//! Passes of a frame: the stages that the table of methods lists, in their order.

use super::fill::Fill;
use super::fill_geometry::GeometryFill;
use super::history::History;
use super::method_pass::MethodPass;
use super::mip_chain::{CandidatePass, MipChainKind, MipChainPass};
use super::sparse::SamplePasses;
use super::stage::{Job, Passes};
use super::{Variant, fill, sparse};
use crate::frame::ContextDesc;
use crate::method::{Overrides, Stage};
use crate::shader::SHADERS;
use wgpu::{CommandEncoder, ComputePass, ComputePassDescriptor, Device, Texture, TextureFormat};

/// The stages of a context.
#[derive(Debug)]
pub(super) struct Stages(Vec<(Stage, Box<dyn Passes>)>);

impl Stages {
    /// Stages of the settings, with the WGSL text `source` for the method's pass.
    pub fn new(device: &Device, desc: &ContextDesc, output: TextureFormat, source: &str) -> Self {
        let made = |stage| (stage, make(stage, device, desc, output, source));
        Self(desc.settings.stages().into_iter().map(made).collect())
    }

    /// Follows a change of settings. `has_same_pass`: whether the method's pass is still the same. Stages that the
    /// settings still have are kept.
    pub fn update(&mut self, device: &Device, desc: &ContextDesc, output: TextureFormat, has_same_pass: bool) {
        let mut kept = std::mem::take(&mut self.0);
        kept.retain(|(stage, _)| *stage != Stage::Method || has_same_pass);
        for stage in desc.settings.stages() {
            self.0.push(match kept.iter().position(|(other, _)| *other == stage) {
                Some(i) => kept.swap_remove(i),
                None => {
                    let source = SHADERS.compose(desc.settings.pass_shader().name).source;
                    (stage, make(stage, device, desc, output, &source))
                }
            });
        }
    }

    /// Replaces the passes of a stage, for tests that plant errors.
    pub fn replace(&mut self, stage: Stage, passes: impl Passes + 'static) {
        let slot = self.0.iter_mut().find(|(other, _)| *other == stage);
        slot.expect("the settings have the stage").1 = Box::new(passes);
    }

    /// Empty history.
    pub fn history(&self, device: &Device, desc: &ContextDesc) -> History {
        let mut history = History::new(device, desc);
        self.passes().for_each(|passes| passes.extend(device, desc, &mut history));
        history
    }

    /// Follows a change of the context's size.
    pub fn resize(&mut self, device: &Device, desc: &ContextDesc) {
        self.0.iter_mut().for_each(|(_, passes)| passes.resize(device, desc));
    }

    /// Compiles the pipelines of a variant.
    pub fn prewarm(&self, device: &Device, desc: &ContextDesc, variant: Variant) {
        self.passes().for_each(|passes| passes.prewarm(device, desc, variant));
    }

    /// Shader and override values of each compiled pipeline.
    pub fn pipelines(&self) -> impl Iterator<Item = (&'static str, Overrides)> + '_ {
        self.passes().flat_map(Passes::pipelines)
    }

    /// Bytes of textures that were made at a frame, in addition to [`memory_bytes_of`].
    pub fn added_bytes(&self) -> u64 {
        self.passes().map(Passes::added_bytes).sum()
    }

    /// Distance of every pixel of a frame that had it at its samples only.
    pub fn filled_depth(&self) -> Option<&Texture> {
        self.passes().find_map(Passes::filled_depth)
    }

    /// Records a frame.
    pub fn record<'a>(&'a self, device: &Device, encoder: &mut CommandEncoder, mut job: Job<'a>) {
        let mut pass = encoder.begin_compute_pass(&ComputePassDescriptor {
            label: Some("afterimage"),
            timestamp_writes: job.target.timestamps.map(|t| t.writes()),
        });
        self.passes().for_each(|passes| passes.record(device, &mut pass, &mut job));
    }

    /// Records the passes that fill depth and motion of a frame that has them at its samples only.
    pub fn record_geometry<'a>(&'a self, device: &Device, pass: &mut ComputePass<'_>, job: &mut Job<'a>) {
        let geometry = self.0.iter().filter(|(stage, _)| *stage == Stage::Geometry);
        geometry.for_each(|(_, passes)| passes.record(device, pass, job));
    }

    /// Completes a history that was resampled.
    pub fn complete(&self, device: &Device, encoder: &mut CommandEncoder, history: &History) {
        let mut pass = encoder.begin_compute_pass(&ComputePassDescriptor::default());
        self.passes().for_each(|passes| passes.complete(device, &mut pass, history));
    }

    fn passes(&self) -> impl Iterator<Item = &dyn Passes> {
        self.0.iter().map(|(_, passes)| &**passes)
    }
}

fn make(stage: Stage, device: &Device, desc: &ContextDesc, output: TextureFormat, source: &str) -> Box<dyn Passes> {
    match stage {
        Stage::Candidates => Box::new(CandidatePass::new(device)),
        Stage::Fill => Box::new(Fill::new(device, desc)),
        Stage::Geometry => Box::new(GeometryFill::new()),
        Stage::Samples => Box::new(SamplePasses::new(device, desc)),
        Stage::Method => Box::new(MethodPass::new(device, &desc.settings, output, source)),
        Stage::MipChain => Box::new(MipChainPass::new(device, MipChainKind::Surfaces)),
    }
}

/// Bytes of the textures that the stages of a context hold between frames, without its history.
pub(super) fn memory_bytes_of(desc: &ContextDesc) -> u64 {
    let bytes = |stage| match stage {
        Stage::Fill => fill::memory_bytes(desc),
        Stage::Samples => sparse::memory_bytes(desc),
        Stage::Geometry | Stage::Candidates | Stage::Method | Stage::MipChain => 0,
    };
    desc.settings.stages().into_iter().map(bytes).sum()
}
