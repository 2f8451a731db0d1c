//! Mip chains of stored surfaces and of noisy candidates.

use super::Variant;
use super::buffer::filled;
use super::compute::{ComputeShader, WORKGROUP_WIDTH, float_texture, storage_texture, uniform};
use super::history::{History, array_view, candidate_plan, levels_view};
use super::stage::{Job, Passes};
use super::textures::batches;
use super::uniforms::CandidateUniforms;
use crate::frame::ContextDesc;
use crate::kernel::foveate::level_len;
use crate::method::Overrides;
use crate::shader::SHADERS;
use wgpu::{BindGroup, BindingResource, BufferUsages, ComputePass, Device, Texture, TextureFormat, TextureView};

/// Format of the levels.
pub(super) const FORMAT: TextureFormat = TextureFormat::Rgba16Float;

/// Content of a mip chain.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum MipChainKind {
    /// Stored surfaces.
    Surfaces,
    /// Noisy candidates.
    Candidates,
}

/// Pass that fills a level of a mip chain from the next finer one.
#[derive(Debug)]
pub(super) struct MipChainPass {
    shader: ComputeShader,
    kind: MipChainKind,
}

/// Dispatch that fills one level.
#[derive(Debug)]
pub(super) struct MipLevel {
    group: BindGroup,
    workgroups: [u32; 3],
}

impl MipChainPass {
    pub fn new(device: &Device, kind: MipChainKind) -> Self {
        let source = SHADERS.compose("mip_chain_pass").source;
        let types = [uniform(), float_texture(), storage_texture(FORMAT)];
        Self { shader: ComputeShader::new(device, "mip_chain_pass", source, &types), kind }
    }

    /// The dispatches that fill `texture`, the mip chain of views of `size_px`, from its second level on.
    pub fn levels(&self, device: &Device, texture: &Texture, size_px: [u32; 2]) -> Vec<MipLevel> {
        (1..texture.mip_level_count())
            .map(|coarse| {
                // Mip 0 of the texture is level 1 of the mip chain.
                let fine_size = size_px.map(|s| level_len(s, coarse));
                let [width, height] = size_px.map(|s| level_len(s, coarse + 1));
                let bytes = bytemuck::bytes_of(&fine_size);
                let buffer = filled(device, "afterimage uniforms", bytes, BufferUsages::UNIFORM);
                let [fine, target] = [coarse - 1, coarse].map(|level| levels_view(texture, level, Some(1), None));
                let resources = [
                    buffer.as_entire_binding(),
                    BindingResource::TextureView(&fine),
                    BindingResource::TextureView(&target),
                ];
                let layers = texture.depth_or_array_layers();
                MipLevel {
                    group: self.shader.group(device, resources),
                    workgroups: [width.div_ceil(WORKGROUP_WIDTH), height, layers],
                }
            })
            .collect()
    }

    fn overrides(&self) -> [(&'static str, u32); 1] {
        [("CANDIDATES", u32::from(self.kind == MipChainKind::Candidates))]
    }

    /// Records the dispatches of `levels`.
    fn fill(&self, device: &Device, pass: &mut ComputePass<'_>, levels: &[MipLevel]) {
        pass.set_pipeline(&self.shader.pipeline(device, &self.overrides()));
        for level in levels {
            pass.set_bind_group(0, &level.group, &[]);
            let [x, y, z] = level.workgroups;
            pass.dispatch_workgroups(x, y, z);
        }
    }
}

impl Passes for MipChainPass {
    fn extend(&self, device: &Device, desc: &ContextDesc, history: &mut History) {
        for planes in &mut history.sets {
            planes.mip_levels = self.levels(device, &planes.textures[1], desc.size_px);
        }
    }

    fn prewarm(&self, device: &Device, _: &ContextDesc, _: Variant) {
        self.shader.pipeline(device, &self.overrides());
    }

    fn pipelines(&self) -> Vec<(&'static str, Overrides)> {
        self.shader.pipelines()
    }

    fn record<'a>(&'a self, device: &Device, pass: &mut ComputePass<'_>, job: &mut Job<'a>) {
        if job.view.is_none() {
            self.complete(device, pass, job.history);
        }
    }

    fn complete(&self, device: &Device, pass: &mut ComputePass<'_>, history: &History) {
        self.fill(device, pass, &history.split().1.mip_levels);
    }
}

/// Passes that fill the mip chain of a frame's noisy candidates.
#[derive(Debug)]
pub(super) struct CandidatePass {
    first: ComputeShader,
    rest: MipChainPass,
}

/// Mip chain of a frame's noisy candidates.
#[derive(Debug)]
pub(super) struct Candidates {
    /// View of all levels, to read.
    pub view: TextureView,
    target: TextureView,
    levels: Vec<MipLevel>,
}

impl CandidatePass {
    pub fn new(device: &Device) -> Self {
        let source = SHADERS.compose("candidate_pass").source;
        let types = [uniform(), float_texture(), float_texture(), storage_texture(FORMAT)];
        Self {
            first: ComputeShader::new(device, "candidate_pass", source, &types),
            rest: MipChainPass::new(device, MipChainKind::Candidates),
        }
    }
}

impl Passes for CandidatePass {
    /// An empty mip chain for each view.
    fn extend(&self, device: &Device, desc: &ContextDesc, history: &mut History) {
        history.candidates = candidate_plan(desc).map(|plan| {
            let texture = plan.create(device, desc);
            Candidates {
                view: levels_view(&texture, 0, None, None),
                target: array_view(&texture),
                levels: self.rest.levels(device, &texture, desc.size_px),
            }
        });
    }

    fn prewarm(&self, device: &Device, desc: &ContextDesc, variant: Variant) {
        self.first.pipeline(device, &[]);
        self.rest.prewarm(device, desc, variant);
    }

    fn pipelines(&self) -> Vec<(&'static str, Overrides)> {
        [self.first.pipelines(), self.rest.pipelines()].concat()
    }

    fn record<'a>(&'a self, device: &Device, pass: &mut ComputePass<'_>, job: &mut Job<'a>) {
        let frame = &job.frame;
        let (Some(noise), Some(candidates)) = (frame.noise, &job.history.candidates) else { return };
        let size = frame.views[0].geometry.size_px();
        for batch in batches(frame.views.len(), frame.color.is_regions() || noise.is_regions()) {
            let first = batch.views.start as usize;
            let uniforms = CandidateUniforms {
                size,
                color_origin: frame.color.packed_origin(first),
                noise_origin: noise.packed_origin(first),
                first_view: batch.views.start,
                ..CandidateUniforms::default()
            };
            let buffer = filled(device, "afterimage uniforms", bytemuck::bytes_of(&uniforms), BufferUsages::UNIFORM);
            let [color, noise] = [frame.color, noise].map(|textures| textures.bind(&batch));
            let resources = [
                buffer.as_entire_binding(),
                BindingResource::TextureView(&color),
                BindingResource::TextureView(&noise),
                BindingResource::TextureView(&candidates.target),
            ];
            let group = self.first.group(device, resources);
            self.first.dispatch(device, pass, &[], &group, size.map(|s| level_len(s, 1)), batch.views.len() as u32);
        }
        self.rest.fill(device, pass, &candidates.levels);
    }
}
