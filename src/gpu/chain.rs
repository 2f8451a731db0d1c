//! The coarser levels of remembered surfaces or of noisy candidates, each from the next finer one.

use super::WORKGROUP_WIDTH;
use super::filled;
use super::history::levels_view;
use crate::kernel::foveate::level_len;
use crate::shader::SHADERS;
use wgpu::{BindGroup, BufferUsages, ComputePass, ComputePipeline, Device, Texture};

/// What the levels are of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ChainKind {
    /// Remembered surfaces.
    Surfaces,
    /// Noisy candidates.
    Candidates,
}

/// The pass that makes a level.
#[derive(Debug)]
pub(super) struct ChainPass {
    pipeline: ComputePipeline,
}

/// One level to be made.
#[derive(Debug)]
pub(super) struct ChainLevel {
    group: BindGroup,
    workgroups: [u32; 3],
}

impl ChainPass {
    pub fn new(device: &Device, kind: ChainKind) -> Self {
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("afterimage chain"),
            source: wgpu::ShaderSource::Wgsl(SHADERS.compose("chain_pass").source.into()),
        });
        let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some("afterimage chain"),
            layout: None,
            module: &module,
            entry_point: Some("main"),
            compilation_options: wgpu::PipelineCompilationOptions {
                constants: &[("CANDIDATES", f64::from(u8::from(kind == ChainKind::Candidates)))],
                ..wgpu::PipelineCompilationOptions::default()
            },
            cache: None,
        });
        Self { pipeline }
    }

    /// The dispatches that fill `texture`, the chain of views of `size_px`, from its second level on.
    pub fn levels(&self, device: &Device, texture: &Texture, size_px: [u32; 2]) -> Vec<ChainLevel> {
        (1..texture.mip_level_count())
            .map(|coarse| {
                // Level 0 of the texture is level 1 of the chain.
                let fine_size = size_px.map(|s| level_len(s, coarse));
                let [width, height] = size_px.map(|s| level_len(s, coarse + 1));
                let buffer =
                    filled(device, "afterimage constants", bytemuck::bytes_of(&fine_size), BufferUsages::UNIFORM);
                let [fine, target] = [coarse - 1, coarse].map(|level| levels_view(texture, level, Some(1)));
                let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
                    label: Some("afterimage chain"),
                    layout: &self.pipeline.get_bind_group_layout(0),
                    entries: &[
                        wgpu::BindGroupEntry { binding: 0, resource: buffer.as_entire_binding() },
                        wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::TextureView(&fine) },
                        wgpu::BindGroupEntry { binding: 2, resource: wgpu::BindingResource::TextureView(&target) },
                    ],
                });
                let layers = texture.depth_or_array_layers();
                ChainLevel { group, workgroups: [width.div_ceil(WORKGROUP_WIDTH), height, layers] }
            })
            .collect()
    }

    /// Records them.
    pub fn record(&self, pass: &mut ComputePass<'_>, levels: &[ChainLevel]) {
        pass.set_pipeline(&self.pipeline);
        for level in levels {
            pass.set_bind_group(0, &level.group, &[]);
            let [x, y, z] = level.workgroups;
            pass.dispatch_workgroups(x, y, z);
        }
    }
}
