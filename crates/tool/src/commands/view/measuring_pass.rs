//! A compute pass that reads pictures on the device and writes a buffer, to be read back.

use super::device;
use super::shader::SHADERS;
use afterimage::wgpu::{self, BindGroupEntry, BindingResource, Buffer, BufferUsages, ComputePipeline, Texture};
use afterimage_lab::device::Headless;
use bytemuck::NoUninit;

/// The pass, and the buffer that it writes.
pub struct MeasuringPass {
    name: &'static str,
    pipeline: ComputePipeline,
    results: Buffer,
}

impl MeasuringPass {
    /// The pass of the module `name`, which writes `bytes` at most.
    pub fn new(gpu: &Headless, name: &'static str, bytes: u64) -> Self {
        let label = Some(name);
        let source = wgpu::ShaderSource::Wgsl(SHADERS.compose(name).source.into());
        let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor { label, source });
        let pipeline = gpu.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label,
            layout: None,
            module: &module,
            entry_point: Some("main"),
            compilation_options: Default::default(),
            cache: None,
        });
        let usage = BufferUsages::STORAGE | BufferUsages::COPY_SRC;
        let descriptor = wgpu::BufferDescriptor { label, size: bytes, usage, mapped_at_creation: false };
        Self { name, pipeline, results: gpu.device.create_buffer(&descriptor) }
    }

    /// A buffer for `bytes` of the results that can be mapped.
    pub fn readback(&self, gpu: &Headless, bytes: u64) -> Buffer {
        let usage = BufferUsages::MAP_READ | BufferUsages::COPY_DST;
        let label = Some(self.name);
        gpu.device.create_buffer(&wgpu::BufferDescriptor { label, size: bytes, usage, mapped_at_creation: false })
    }

    /// Runs the pass in `workgroups`, and copies as much of its results as `readback` holds. Bindings: the constants,
    /// the pictures, the results.
    pub fn run(
        &self,
        gpu: &Headless,
        constants: &impl NoUninit,
        pictures: &[&Texture],
        workgroups: [u32; 3],
        readback: &Buffer,
    ) {
        let constants = device::constants(gpu, self.name, constants);
        let views: Vec<_> = pictures.iter().map(|picture| picture.create_view(&Default::default())).collect();
        let resources = [constants.as_entire_binding()]
            .into_iter()
            .chain(views.iter().map(BindingResource::TextureView))
            .chain([self.results.as_entire_binding()]);
        let entries: Vec<_> =
            (0..).zip(resources).map(|(binding, resource)| BindGroupEntry { binding, resource }).collect();
        let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some(self.name),
            layout: &self.pipeline.get_bind_group_layout(0),
            entries: &entries,
        });
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &group, &[]);
        let [x, y, z] = workgroups;
        pass.dispatch_workgroups(x, y, z);
        drop(pass);
        encoder.copy_buffer_to_buffer(&self.results, 0, readback, 0, readback.size());
        gpu.queue.submit([encoder.finish()]);
    }
}
