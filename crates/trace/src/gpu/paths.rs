//! Path state on the device, and the sequence of kernels over a batch.

use super::passes::{Passes, WORKGROUP};
use crate::gpu::scene_buffer::GpuSceneBuffer;
use afterimage::internal::filled;
use afterimage_lab::device::{Headless, bind_group, empty_buffer};
use bytemuck::{Pod, Zeroable};
use wgpu::BufferUsages;

/// Twin of `TraceFrame` in `shaders/trace/frame.wgsl`.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
pub(super) struct FrameUniforms {
    pub origin: [f32; 3],
    pub key: u32,
    pub corner: [f32; 3],
    pub lights: u32,
    pub right: [f32; 3],
    pub sky_probability: f32,
    pub down: [f32; 3],
    pub width: u32,
    pub sky: [f32; 3],
    pub items: u32,
    pub map_size: [u32; 2],
    pub capacity: u32,
    pub jitter: f32,
    pub film_base: u32,
    pub unused: [u32; 3],
}

/// Bytes of a path's state: `PATH_ROWS` rows of 16 bytes.
const PATH_BYTES: u64 = 8 * 16;

/// Sizes of the `counters` and `plan` buffers in bytes.
const COUNTER_BYTES: u64 = 5 * 4;
const PLAN_BYTES: u64 = 9 * 4;
/// Byte offset of `shadow`'s workgroup counts in the plan.
const PLAN_SHADOW: u64 = 3 * 4;

/// Buffers that are reused from frame to frame.
#[derive(Debug)]
pub(super) struct Paths {
    frame: wgpu::Buffer,
    paths: wgpu::Buffer,
    lists: wgpu::Buffer,
    plan: wgpu::Buffer,
    plan_written: wgpu::BindGroup,
    plan_read: wgpu::BindGroup,
}

/// Bindings of a list of work and of the film that receives it.
pub(super) struct Run<'a> {
    paths: &'a Paths,
    scene_buffer: wgpu::BindGroup,
    bound: wgpu::BindGroup,
    counters: wgpu::Buffer,
    film: wgpu::Buffer,
    film_bound: wgpu::BindGroup,
}

/// Counters that the kernels add to.
pub(super) struct Counters {
    pub rays: u64,
    pub nonfinite: u64,
}

impl Paths {
    pub fn new(device: &wgpu::Device, passes: &Passes, capacity: u32) -> Self {
        let plan = empty_buffer(device, "plan", PLAN_BYTES, BufferUsages::STORAGE | BufferUsages::INDIRECT);
        let bind = |layout| bind_group(device, "plan", layout, [plan.as_entire_binding()]);
        let uniform = BufferUsages::UNIFORM | BufferUsages::COPY_DST;
        Self {
            frame: empty_buffer(device, "frame", size_of::<FrameUniforms>() as u64, uniform),
            paths: empty_buffer(device, "paths", u64::from(capacity) * PATH_BYTES, BufferUsages::STORAGE),
            lists: empty_buffer(device, "lists", u64::from(capacity) * 12, BufferUsages::STORAGE),
            plan_written: bind(&passes.written_layout),
            plan_read: bind(&passes.plan_layout),
            plan,
        }
    }

    /// Uploads the film, and binds it and the list of work.
    pub fn run<'a>(
        &'a self,
        device: &wgpu::Device,
        passes: &Passes,
        scene_buffer: &GpuSceneBuffer,
        work: &wgpu::Buffer,
        film: &[[f32; 4]],
    ) -> Run<'a> {
        let to_read = BufferUsages::STORAGE | BufferUsages::COPY_SRC;
        let film = filled(device, "film", bytemuck::cast_slice(film), to_read);
        let counters = filled(device, "counters", &[0; COUNTER_BYTES as usize], to_read);
        let shared = [&self.frame, work, &self.paths, &self.lists, &counters].map(wgpu::Buffer::as_entire_binding);
        Run {
            paths: self,
            scene_buffer: bind_group(device, "trace", &passes.scene_layout, [scene_buffer.binding()]),
            bound: bind_group(device, "trace", &passes.frame_layout, shared),
            film_bound: bind_group(device, "trace", &passes.written_layout, [film.as_entire_binding()]),
            counters,
            film,
        }
    }
}

impl Run<'_> {
    /// Records all kernels over the batch that `uniforms` describes.
    pub fn record(
        &self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        passes: &Passes,
        uniforms: &FrameUniforms,
        max_depth: u32,
        timestamps: Option<wgpu::ComputePassTimestampWrites<'_>>,
    ) {
        // Copied through the encoder: a queue write would give all batches of a submission the last batch's uniforms.
        let contents = bytemuck::bytes_of(uniforms);
        let staged = filled(device, "frame", contents, BufferUsages::COPY_SRC);
        encoder.copy_buffer_to_buffer(&staged, 0, &self.paths.frame, 0, contents.len() as u64);

        let plan = &self.paths.plan;
        let (written, read) = (&self.paths.plan_written, &self.paths.plan_read);
        let desc = wgpu::ComputePassDescriptor { label: Some("trace"), timestamp_writes: timestamps };
        let mut pass = encoder.begin_compute_pass(&desc);
        pass.set_bind_group(0, &self.scene_buffer, &[]);
        pass.set_bind_group(1, &self.bound, &[]);
        let groups = uniforms.items.div_ceil(WORKGROUP);
        pass.set_pipeline(&passes.generate);
        pass.dispatch_workgroups(groups, 1, 1);
        pass.set_pipeline(&passes.start);
        pass.set_bind_group(2, written, &[]);
        pass.dispatch_workgroups(1, 1, 1);
        for bounce in 0..=max_depth {
            pass.set_bind_group(2, read, &[]);
            pass.set_pipeline(&passes.extend);
            pass.dispatch_workgroups_indirect(plan, 0);
            pass.set_pipeline(&passes.shade);
            pass.dispatch_workgroups_indirect(plan, 0);
            if bounce == max_depth {
                break;
            }
            pass.set_bind_group(2, written, &[]);
            pass.set_pipeline(&passes.count_shadows);
            pass.dispatch_workgroups(1, 1, 1);
            pass.set_bind_group(2, read, &[]);
            pass.set_pipeline(&passes.shadow);
            pass.dispatch_workgroups_indirect(plan, PLAN_SHADOW);
            pass.set_bind_group(2, written, &[]);
            pass.set_pipeline(&passes.count_paths);
            pass.dispatch_workgroups(1, 1, 1);
        }
        pass.set_bind_group(2, &self.film_bound, &[]);
        pass.set_pipeline(&passes.resolve);
        pass.dispatch_workgroups(groups, 1, 1);
    }

    /// Waits for all batches, then reads the film and the counters.
    pub fn read(&self, device: &Headless) -> (Vec<[f32; 4]>, Counters) {
        let film = device.read_buffer(&self.film);
        let words = device.read_buffer(&self.counters);
        let words: Vec<u32> = bytemuck::pod_collect_to_vec(&words);
        let counted =
            Counters { rays: u64::from(words[2]) | u64::from(words[3]) << 32, nonfinite: u64::from(words[4]) };
        (bytemuck::pod_collect_to_vec(&film), counted)
    }
}
