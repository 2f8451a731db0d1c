//! Builder of the tracer's compute pipelines.

use std::borrow::Cow;
use wgpu::{ComputePipeline, Device, PipelineLayout};

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
