//! Mip chains of stored surfaces and of noisy candidates.

use super::Frame;
use super::buffer::filled;
use super::compute::{ComputeShader, WORKGROUP_WIDTH, float_texture, storage_texture, uniform};
use super::history::{array_view, levels_view, mip_chain_texture};
use crate::frame::ContextDesc;
use crate::kernel::foveate::level_len;
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
        Self { shader: ComputeShader::new(device, "afterimage mip chain", source, &types), kind }
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
                let [fine, target] = [coarse - 1, coarse].map(|level| levels_view(texture, level, Some(1)));
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

    /// Records the dispatches of `levels`.
    pub fn record(&self, device: &Device, pass: &mut ComputePass<'_>, levels: &[MipLevel]) {
        let is_candidates = u32::from(self.kind == MipChainKind::Candidates);
        pass.set_pipeline(&self.shader.pipeline(device, &[("CANDIDATES", is_candidates)]));
        for level in levels {
            pass.set_bind_group(0, &level.group, &[]);
            let [x, y, z] = level.workgroups;
            pass.dispatch_workgroups(x, y, z);
        }
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
    pub texture: Texture,
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
            first: ComputeShader::new(device, "afterimage candidates", source, &types),
            rest: MipChainPass::new(device, MipChainKind::Candidates),
        }
    }

    /// An empty mip chain of `count` levels for each view.
    pub fn levels(&self, device: &Device, desc: &ContextDesc, count: u32) -> Candidates {
        let texture = mip_chain_texture(device, desc, count);
        Candidates {
            view: levels_view(&texture, 0, None),
            target: levels_view(&texture, 0, Some(1)),
            levels: self.rest.levels(device, &texture, desc.size_px),
            texture,
        }
    }

    /// Records all levels of a frame's candidates; nothing for a frame without noise.
    pub fn record(&self, device: &Device, pass: &mut ComputePass<'_>, frame: &Frame<'_>, candidates: &Candidates) {
        let Some(noise) = frame.noise else { return };
        let size_px = [frame.color.width(), frame.color.height()];
        let size = filled(device, "afterimage uniforms", bytemuck::bytes_of(&size_px), BufferUsages::UNIFORM);
        let [color, noise] = [frame.color, noise].map(array_view);
        let resources = [
            size.as_entire_binding(),
            BindingResource::TextureView(&color),
            BindingResource::TextureView(&noise),
            BindingResource::TextureView(&candidates.target),
        ];
        let group = self.first.group(device, resources);
        let half = size_px.map(|s| level_len(s, 1));
        self.first.dispatch(device, pass, &[], &group, half, frame.color.depth_or_array_layers());
        self.rest.record(device, pass, &candidates.levels);
    }
}
