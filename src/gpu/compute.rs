//! Builder of compute pipelines: a shader, its bindings, and a pipeline for each set of override values.

use crate::method::Overrides;
use std::collections::HashMap;
use std::sync::{Mutex, PoisonError};
use wgpu::{
    BindGroup, BindGroupDescriptor, BindGroupEntry, BindGroupLayout, BindGroupLayoutDescriptor, BindGroupLayoutEntry,
    BindingResource, BindingType, BufferBindingType, ComputePass, ComputePipeline, ComputePipelineDescriptor, Device,
    PipelineCompilationOptions, PipelineLayout, PipelineLayoutDescriptor, ShaderModule, ShaderModuleDescriptor,
    ShaderSource, ShaderStages, StorageTextureAccess, TextureFormat, TextureSampleType, TextureViewDimension,
};

/// Width of a workgroup in invocations; its height is 1. Equal to `@workgroup_size` in the shaders.
pub const WORKGROUP_WIDTH: u32 = 64;

/// A compute shader with the entry point `main` and one bind group.
#[derive(Debug)]
pub struct ComputeShader {
    name: &'static str,
    /// Label of the shader's objects on the device, for captures of a frame.
    label: String,
    /// Binding numbers, in the order of the resources of a [`group`](Self::group).
    numbers: Vec<u32>,
    bindings: BindGroupLayout,
    layout: PipelineLayout,
    module: ShaderModule,
    /// Pipelines by override values, compiled at their first use.
    pipelines: Mutex<HashMap<Overrides, ComputePipeline>>,
}

impl ComputeShader {
    /// A shader with bindings of `types`, numbered from 0.
    pub fn new(device: &Device, name: &'static str, source: String, types: &[BindingType]) -> Self {
        let bindings: Vec<_> = (0..).zip(types.iter().copied()).collect();
        Self::with_bindings(device, name, source, &bindings)
    }

    /// A shader with numbered bindings.
    pub fn with_bindings(device: &Device, name: &'static str, source: String, bindings: &[(u32, BindingType)]) -> Self {
        let label = format!("afterimage {name}");
        let module = device.create_shader_module(ShaderModuleDescriptor {
            label: Some(&label),
            source: ShaderSource::Wgsl(source.into()),
        });
        let numbers = bindings.iter().map(|(number, _)| *number).collect();
        let entries: Vec<_> = bindings
            .iter()
            .map(|&(binding, ty)| BindGroupLayoutEntry { binding, visibility: ShaderStages::COMPUTE, ty, count: None })
            .collect();
        let bindings =
            device.create_bind_group_layout(&BindGroupLayoutDescriptor { label: Some(&label), entries: &entries });
        let layout = device.create_pipeline_layout(&PipelineLayoutDescriptor {
            label: Some(&label),
            bind_group_layouts: &[Some(&bindings)],
            ..PipelineLayoutDescriptor::default()
        });
        Self { name, label, numbers, bindings, layout, module, pipelines: Mutex::default() }
    }

    /// A bind group of `resources`, in the order of the bindings.
    pub fn group<'a>(&self, device: &Device, resources: impl IntoIterator<Item = BindingResource<'a>>) -> BindGroup {
        let entries: Vec<_> = self
            .numbers
            .iter()
            .zip(resources)
            .map(|(&binding, resource)| BindGroupEntry { binding, resource })
            .collect();
        device.create_bind_group(&BindGroupDescriptor {
            label: Some(&self.label),
            layout: &self.bindings,
            entries: &entries,
        })
    }

    /// The pipeline for a set of override values, compiled at its first use.
    pub fn pipeline(&self, device: &Device, overrides: &[(&'static str, u32)]) -> ComputePipeline {
        // A poisoned lock is harmless: a thread that panicked here inserted nothing.
        let mut pipelines = self.pipelines.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(pipeline) = pipelines.get(overrides) {
            return pipeline.clone();
        }
        let constants: Vec<_> = overrides.iter().map(|&(name, value)| (name, f64::from(value))).collect();
        let pipeline = device.create_compute_pipeline(&ComputePipelineDescriptor {
            label: Some(&self.label),
            layout: Some(&self.layout),
            module: &self.module,
            entry_point: Some("main"),
            compilation_options: PipelineCompilationOptions {
                constants: &constants,
                // Only counters use workgroup memory, and zeroing it costs a barrier.
                zero_initialize_workgroup_memory: !overrides.contains(&("COUNT", 0)),
            },
            cache: None,
        });
        pipelines.insert(overrides.to_vec(), pipeline.clone());
        pipeline
    }

    /// Name of the shader, and override values, of each compiled pipeline.
    pub fn pipelines(&self) -> Vec<(&'static str, Overrides)> {
        let pipelines = self.pipelines.lock().unwrap_or_else(PoisonError::into_inner);
        pipelines.keys().map(|overrides| (self.name, overrides.clone())).collect()
    }

    /// Dispatches one invocation a texel, for `width` x `height` texels in each of `layers` layers.
    pub fn dispatch(
        &self,
        device: &Device,
        pass: &mut ComputePass<'_>,
        overrides: &[(&'static str, u32)],
        group: &BindGroup,
        [width, height]: [u32; 2],
        layers: u32,
    ) {
        pass.set_pipeline(&self.pipeline(device, overrides));
        pass.set_bind_group(0, group, &[]);
        pass.dispatch_workgroups(width.div_ceil(WORKGROUP_WIDTH), height, layers);
    }
}

/// Binding type of a uniform buffer.
pub fn uniform() -> BindingType {
    BindingType::Buffer { ty: BufferBindingType::Uniform, has_dynamic_offset: false, min_binding_size: None }
}

/// Binding type of a storage buffer.
pub fn storage_buffer(read_only: bool) -> BindingType {
    BindingType::Buffer {
        ty: BufferBindingType::Storage { read_only },
        has_dynamic_offset: false,
        min_binding_size: None,
    }
}

/// Binding type of a 2D array texture of floats to read.
pub fn float_texture() -> BindingType {
    sampled(TextureSampleType::Float { filterable: false })
}

/// Binding type of a 2D array texture of unsigned integers to read.
pub fn uint_texture() -> BindingType {
    sampled(TextureSampleType::Uint)
}

fn sampled(sample_type: TextureSampleType) -> BindingType {
    BindingType::Texture { sample_type, view_dimension: TextureViewDimension::D2Array, multisampled: false }
}

/// Binding type of a 2D array texture to write.
pub fn storage_texture(format: TextureFormat) -> BindingType {
    BindingType::StorageTexture {
        access: StorageTextureAccess::WriteOnly,
        format,
        view_dimension: TextureViewDimension::D2Array,
    }
}
