//! The coarser levels of a frame's noisy candidates.

use super::chain::{ChainKind, ChainLevel, ChainPass};
use super::filled;
use super::history::{array_view, chain_texture, levels_view};
use super::{Frame, WORKGROUP_WIDTH};
use crate::frame::ContextDesc;
use crate::kernel::foveate::level_len;
use crate::shader::SHADERS;
use wgpu::{
    BindGroupDescriptor, BindGroupEntry, BindGroupLayout, BindGroupLayoutDescriptor, BindGroupLayoutEntry, BindingType,
    BufferBindingType, BufferUsages, ComputePass, ComputePipeline, Device, ShaderStages, StorageTextureAccess, Texture,
    TextureFormat, TextureSampleType, TextureView, TextureViewDimension,
};

/// The passes that make them.
#[derive(Debug)]
pub(super) struct CandidatePass {
    layout: BindGroupLayout,
    first: ComputePipeline,
    rest: ChainPass,
}

/// The levels.
#[derive(Debug)]
pub(super) struct Candidates {
    pub texture: Texture,
    /// To read: all of them.
    pub view: TextureView,
    target: TextureView,
    levels: Vec<ChainLevel>,
}

impl CandidatePass {
    pub fn new(device: &Device) -> Self {
        // Not the layout that wgpu would derive: colors may be of a format that no sampler filters.
        let texture = BindingType::Texture {
            sample_type: TextureSampleType::Float { filterable: false },
            view_dimension: TextureViewDimension::D2Array,
            multisampled: false,
        };
        let target = BindingType::StorageTexture {
            access: StorageTextureAccess::WriteOnly,
            format: TextureFormat::Rgba16Float,
            view_dimension: TextureViewDimension::D2Array,
        };
        let size =
            BindingType::Buffer { ty: BufferBindingType::Uniform, has_dynamic_offset: false, min_binding_size: None };
        let entries: Vec<_> = (0..)
            .zip([size, texture, texture, target])
            .map(|(binding, ty)| BindGroupLayoutEntry { binding, visibility: ShaderStages::COMPUTE, ty, count: None })
            .collect();
        let layout = device.create_bind_group_layout(&BindGroupLayoutDescriptor {
            label: Some("afterimage candidates"),
            entries: &entries,
        });
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("afterimage candidates"),
            source: wgpu::ShaderSource::Wgsl(SHADERS.compose("candidate_pass").source.into()),
        });
        let first = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some("afterimage candidates"),
            layout: Some(&device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some("afterimage candidates"),
                bind_group_layouts: &[Some(&layout)],
                ..wgpu::PipelineLayoutDescriptor::default()
            })),
            module: &module,
            entry_point: Some("main"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            cache: None,
        });
        Self { layout, first, rest: ChainPass::new(device, ChainKind::Candidates) }
    }

    /// Room for `count` levels of each view.
    pub fn levels(&self, device: &Device, desc: &ContextDesc, count: u32) -> Candidates {
        let texture = chain_texture(device, desc, count);
        Candidates {
            view: levels_view(&texture, 0, None),
            target: levels_view(&texture, 0, Some(1)),
            levels: self.rest.levels(device, &texture, desc.size_px),
            texture,
        }
    }

    /// Records the making of all levels from what a frame brings; nothing without noise.
    pub fn record(&self, device: &Device, pass: &mut ComputePass<'_>, frame: &Frame<'_>, candidates: &Candidates) {
        let Some(noise) = frame.noise else { return };
        let size_px = [frame.color.width(), frame.color.height()];
        let size = filled(device, "afterimage constants", bytemuck::bytes_of(&size_px), BufferUsages::UNIFORM);
        let [color, noise] = [frame.color, noise].map(array_view);
        let group = device.create_bind_group(&BindGroupDescriptor {
            label: Some("afterimage candidates"),
            layout: &self.layout,
            entries: &[
                BindGroupEntry { binding: 0, resource: size.as_entire_binding() },
                BindGroupEntry { binding: 1, resource: wgpu::BindingResource::TextureView(&color) },
                BindGroupEntry { binding: 2, resource: wgpu::BindingResource::TextureView(&noise) },
                BindGroupEntry { binding: 3, resource: wgpu::BindingResource::TextureView(&candidates.target) },
            ],
        });
        let [width, height] = size_px.map(|s| level_len(s, 1));
        pass.set_pipeline(&self.first);
        pass.set_bind_group(0, &group, &[]);
        pass.dispatch_workgroups(width.div_ceil(WORKGROUP_WIDTH), height, frame.color.depth_or_array_layers());
        self.rest.record(pass, &candidates.levels);
    }
}
