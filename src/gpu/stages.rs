//! Passes of a frame: the stages that the table of methods lists, in their order.

use super::compute::{ComputeShader, Sources};
use super::history::History;
use super::levels::fill::{self, Fill};
use super::levels::mip_chain::{CandidatePass, MipChainPass};
use super::method_pass::MethodPass;
use super::planned::quad_samples::{self, QuadSamplePasses};
use super::recorder::Recorder;
use super::stage::{Job, Passes, Specialization};
use crate::context::ContextDesc;
use crate::method::{Overrides, Stage};
use wgpu::{Device, TextureFormat};

#[derive(Debug)]
pub(super) struct Stages {
    stages: Vec<(Stage, Box<dyn Passes>)>,
    output: TextureFormat,
    sources: Sources,
}

impl Stages {
    /// Stages of the settings, for outputs of format `output`.
    pub fn new(device: &Device, desc: &ContextDesc, output: TextureFormat, sources: Sources) -> Self {
        let mut stages = Self { stages: vec![], output, sources };
        stages.update(device, desc, true);
        stages
    }

    pub fn sources(&self) -> &Sources {
        &self.sources
    }

    /// Follows a change of settings. `has_same_pass`: whether the method's pass is still the same. Stages that the
    /// settings still have are kept.
    pub fn update(&mut self, device: &Device, desc: &ContextDesc, has_same_pass: bool) {
        let mut kept = std::mem::take(&mut self.stages);
        kept.retain(|(stage, _)| *stage != Stage::Method || has_same_pass);
        for stage in desc.settings.stages() {
            let place = kept.iter().position(|(other, _)| *other == stage);
            let passes = place.map(|i| kept.swap_remove(i).1).unwrap_or_else(|| self.make(stage, device, desc));
            self.stages.push((stage, passes));
        }
    }

    fn make(&self, stage: Stage, device: &Device, desc: &ContextDesc) -> Box<dyn Passes> {
        let sources = &self.sources;
        match stage {
            Stage::Candidates => Box::new(CandidatePass::new(device, desc, sources)),
            Stage::Fill => Box::new(Fill::new(device, desc, sources)),
            Stage::Quads => Box::new(QuadSamplePasses::new(device, desc, sources)),
            Stage::Method => Box::new(MethodPass::new(device, desc, self.output, sources)),
            Stage::MipChain => Box::new(MipChainPass::new(device, desc, sources, false)),
        }
    }

    pub fn resize(&mut self, device: &Device, desc: &ContextDesc) {
        self.stages.iter_mut().for_each(|(_, passes)| passes.resize(device, desc));
    }

    pub fn prewarm(&self, device: &Device, desc: &ContextDesc, special: Specialization) {
        self.passes().for_each(|passes| passes.prewarm(device, desc, special));
    }

    /// Shader and override values of each compiled pipeline.
    pub fn pipelines(&self) -> impl Iterator<Item = (&'static str, Overrides)> + '_ {
        self.passes().flat_map(Passes::shaders).flat_map(ComputeShader::pipelines)
    }

    pub fn record<'a>(&'a self, job: &mut Job<'a>) {
        self.passes().for_each(|passes| passes.record(job));
    }

    /// Adds the dispatches that complete a history that was resampled.
    pub fn complete(&self, device: &Device, recorder: &mut Recorder, history: &History) {
        self.passes().for_each(|passes| passes.complete(device, recorder, history));
    }

    fn passes(&self) -> impl Iterator<Item = &dyn Passes> {
        self.stages.iter().map(|(_, passes)| &**passes)
    }
}

/// Bytes of the textures that the stages of a context hold between frames, without its history.
pub(super) fn memory_bytes_of(desc: &ContextDesc) -> u64 {
    let bytes = |stage| match stage {
        Stage::Fill => fill::color(desc).bytes(),
        Stage::Quads => quad_samples::memory_bytes(desc),
        Stage::Candidates | Stage::Method | Stage::MipChain => 0,
    };
    desc.settings.stages().into_iter().map(bytes).sum()
}
