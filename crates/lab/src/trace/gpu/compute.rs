//! Builders that all kernels of the tracer share: compute pipelines, bind groups, buffers.

use std::borrow::Cow;
use wgpu::{
    BindGroup, BindGroupLayout, BindingResource, Buffer, BufferUsages, ComputePipeline, Device, PipelineLayout,
};

/// A WGSL entry point and how it is specialized.
pub(super) struct Kernel<'a> {
    /// Label of the shader module.
    pub module: &'a str,
    pub source: String,
    pub entry: &'a str,
    /// `None`: derived from the shader.
    pub layout: Option<&'a PipelineLayout>,
    /// Values of overrides. The shader must declare every one of them.
    pub constants: &'a [(&'a str, f64)],
}

impl Kernel<'_> {
    /// Compiles the kernel. No kernel uses workgroup memory, so none is cleared.
    pub fn pipeline(self, device: &Device) -> ComputePipeline {
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(self.module),
            source: wgpu::ShaderSource::Wgsl(Cow::Owned(self.source)),
        });
        device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(self.entry),
            layout: self.layout,
            module: &module,
            entry_point: Some(self.entry),
            compilation_options: wgpu::PipelineCompilationOptions {
                constants: self.constants,
                zero_initialize_workgroup_memory: false,
            },
            cache: None,
        })
    }
}

/// Binds `resources` to bindings 0, 1, 2 and so on.
pub(super) fn bind_group(
    device: &Device,
    label: &str,
    layout: &BindGroupLayout,
    resources: &[BindingResource<'_>],
) -> BindGroup {
    let entries: Vec<_> = (0..)
        .zip(resources)
        .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource: resource.clone() })
        .collect();
    device.create_bind_group(&wgpu::BindGroupDescriptor { label: Some(label), layout, entries: &entries })
}

/// A buffer of `size` zero bytes.
pub(super) fn empty_buffer(device: &Device, label: &str, size: u64, usage: BufferUsages) -> Buffer {
    device.create_buffer(&wgpu::BufferDescriptor { label: Some(label), size, usage, mapped_at_creation: false })
}
