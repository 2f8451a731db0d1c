//! One compute shader of a filter: its bindings, and its pipelines with and without levels of detail.

use crate::gpu::WORKGROUP_WIDTH;
use std::sync::OnceLock;
use wgpu::{
    BindGroupDescriptor, BindGroupEntry, BindGroupLayout, BindGroupLayoutDescriptor, BindGroupLayoutEntry,
    BindingResource, BindingType, BufferBindingType, ComputePass, ComputePipeline, ComputePipelineDescriptor, Device,
    PipelineCompilationOptions, PipelineLayout, PipelineLayoutDescriptor, ShaderModule, ShaderModuleDescriptor,
    ShaderSource, ShaderStages, StorageTextureAccess, TextureFormat, TextureSampleType, TextureViewDimension,
};

#[derive(Debug)]
pub(super) struct Pass {
    label: &'static str,
    constants: &'static [(&'static str, f64)],
    bindings: BindGroupLayout,
    layout: PipelineLayout,
    module: ShaderModule,
    plain: OnceLock<ComputePipeline>,
    with_lod: OnceLock<ComputePipeline>,
}

impl Pass {
    /// `constants` are the values of the shader's overrides besides `WRITE_LOD`; `types` its bindings from 0 on.
    pub fn new(
        device: &Device,
        label: &'static str,
        source: String,
        types: &[BindingType],
        constants: &'static [(&'static str, f64)],
    ) -> Self {
        let module = device.create_shader_module(ShaderModuleDescriptor {
            label: Some(label),
            source: ShaderSource::Wgsl(source.into()),
        });
        let entry = |(binding, &ty): (usize, &BindingType)| BindGroupLayoutEntry {
            binding: binding as u32,
            visibility: ShaderStages::COMPUTE,
            ty,
            count: None,
        };
        let entries: Vec<_> = types.iter().enumerate().map(entry).collect();
        let bindings =
            device.create_bind_group_layout(&BindGroupLayoutDescriptor { label: Some(label), entries: &entries });
        let layout = device.create_pipeline_layout(&PipelineLayoutDescriptor {
            label: Some(label),
            bind_group_layouts: &[Some(&bindings)],
            ..PipelineLayoutDescriptor::default()
        });
        Self { label, constants, bindings, layout, module, plain: OnceLock::new(), with_lod: OnceLock::new() }
    }

    /// Dispatches one invocation for each of `size` texels of each view.
    pub fn record(
        &self,
        device: &Device,
        pass: &mut ComputePass<'_>,
        resources: &[BindingResource<'_>],
        write_lod: bool,
        size: [u32; 2],
        view_count: u32,
    ) {
        let entries: Vec<_> = resources
            .iter()
            .enumerate()
            .map(|(i, resource)| BindGroupEntry { binding: i as u32, resource: resource.clone() })
            .collect();
        let group = device.create_bind_group(&BindGroupDescriptor {
            label: Some(self.label),
            layout: &self.bindings,
            entries: &entries,
        });
        pass.set_pipeline(self.pipeline(device, write_lod));
        pass.set_bind_group(0, &group, &[]);
        pass.dispatch_workgroups(size[0].div_ceil(WORKGROUP_WIDTH), size[1], view_count);
    }

    /// Made at its first use.
    fn pipeline(&self, device: &Device, write_lod: bool) -> &ComputePipeline {
        let made = if write_lod { &self.with_lod } else { &self.plain };
        made.get_or_init(|| {
            let mut constants = self.constants.to_vec();
            if write_lod {
                constants.push(("WRITE_LOD", 1.0));
            }
            device.create_compute_pipeline(&ComputePipelineDescriptor {
                label: Some(self.label),
                layout: Some(&self.layout),
                module: &self.module,
                entry_point: Some("main"),
                compilation_options: PipelineCompilationOptions {
                    constants: &constants,
                    ..PipelineCompilationOptions::default()
                },
                cache: None,
            })
        })
    }
}

/// Type of a uniform buffer.
pub(super) fn uniform() -> BindingType {
    BindingType::Buffer { ty: BufferBindingType::Uniform, has_dynamic_offset: false, min_binding_size: None }
}

/// Type of a color texture to read.
pub(super) fn sampled() -> BindingType {
    BindingType::Texture {
        sample_type: TextureSampleType::Float { filterable: false },
        view_dimension: TextureViewDimension::D2Array,
        multisampled: false,
    }
}

/// Type of a texture to write.
pub(super) fn storage(format: TextureFormat) -> BindingType {
    BindingType::StorageTexture {
        access: StorageTextureAccess::WriteOnly,
        format,
        view_dimension: TextureViewDimension::D2Array,
    }
}
