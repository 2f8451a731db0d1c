//! Compute pipelines of the tracer, and their bind group layouts.

use super::compute::Kernel;
use crate::gpu::scene_buffer::{GpuSceneBuffer, Storage};
use crate::shader::SHADERS;

/// Invocations of a workgroup.
pub(super) const WORKGROUP: u32 = 64;

/// The kernels, specialized to a scene.
#[derive(Debug)]
pub(super) struct Passes {
    pub generate: wgpu::ComputePipeline,
    pub start: wgpu::ComputePipeline,
    pub extend: wgpu::ComputePipeline,
    pub shade: wgpu::ComputePipeline,
    pub count_shadows: wgpu::ComputePipeline,
    pub shadow: wgpu::ComputePipeline,
    pub count_paths: wgpu::ComputePipeline,
    pub resolve: wgpu::ComputePipeline,
    pub scene_layout: wgpu::BindGroupLayout,
    pub frame_layout: wgpu::BindGroupLayout,
    /// One writable storage buffer: the plan for `count_pass`, the film for `resolve_pass`.
    pub written_layout: wgpu::BindGroupLayout,
    /// The plan as a read-only storage buffer.
    pub plan_layout: wgpu::BindGroupLayout,
}

impl Passes {
    pub fn new(
        device: &wgpu::Device,
        scene_buffer: &GpuSceneBuffer,
        storage: Storage,
        constants: &[(&'static str, f64)],
        edit: impl Fn(String) -> String,
    ) -> Self {
        let layout = |entries: &[wgpu::BindGroupLayoutEntry]| {
            device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some("trace"), entries })
        };
        let scene_layout = layout(&[scene_buffer.layout_entry(0)]);
        let frame_layout = layout(&[
            buffer(0, wgpu::BufferBindingType::Uniform),
            buffer(1, wgpu::BufferBindingType::Storage { read_only: true }),
            buffer(2, wgpu::BufferBindingType::Storage { read_only: false }),
            buffer(3, wgpu::BufferBindingType::Storage { read_only: false }),
            buffer(4, wgpu::BufferBindingType::Storage { read_only: false }),
        ]);
        let written_layout = layout(&[buffer(0, wgpu::BufferBindingType::Storage { read_only: false })]);
        let plan_layout = layout(&[buffer(0, wgpu::BufferBindingType::Storage { read_only: true })]);

        let pipeline = |module: &str, entry: &str, third: Option<&wgpu::BindGroupLayout>| {
            let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some(entry),
                bind_group_layouts: &[Some(&scene_layout), Some(&frame_layout), third],
                immediate_size: 0,
            });
            let source = edit(SHADERS.compose_with(&[storage.module(), module], "").source);
            // WebGPU rejects values for overrides that a shader does not declare.
            let has = |name: &str| source.contains(&format!("override {name}:"));
            let constants: Vec<_> = constants.iter().copied().filter(|(name, _)| has(name)).collect();
            Kernel { module, source, entry, layout: Some(&layout), constants: &constants }.pipeline(device)
        };
        Self {
            generate: pipeline("generate_pass", "generate", None),
            start: pipeline("count_pass", "start", Some(&written_layout)),
            extend: pipeline("extend_pass", "extend", Some(&plan_layout)),
            shade: pipeline("shade_pass", "shade", Some(&plan_layout)),
            count_shadows: pipeline("count_pass", "count_shadows", Some(&written_layout)),
            shadow: pipeline("shadow_pass", "shadow", Some(&plan_layout)),
            count_paths: pipeline("count_pass", "count_paths", Some(&written_layout)),
            resolve: pipeline("resolve_pass", "resolve", Some(&written_layout)),
            scene_layout,
            frame_layout,
            written_layout,
            plan_layout,
        }
    }
}

fn buffer(binding: u32, ty: wgpu::BufferBindingType) -> wgpu::BindGroupLayoutEntry {
    wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::COMPUTE,
        ty: wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None },
        count: None,
    }
}
