//! Hits for a list of rays on a device, for tests and measurements.

use super::compute::Kernel;
use super::passes::WORKGROUP;
use super::scene_buffer::{GpuSceneBuffer, Storage, traversal_constants};
use crate::scene_buffer::SceneBuffer;
use crate::shader::SHADERS;
use afterimage_lab::device::{Headless, bind_group, empty_buffer};
use afterimage_lab::rays::{Geometry, Hit, Ray};
use std::sync::Arc;
use wgpu::BufferUsages;

/// Kind of traversal query.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HitQuery {
    /// Nearest hit.
    Closest,
    /// Whether the ray hits anything.
    Any,
}

/// A pipeline that only traverses.
#[derive(Debug)]
pub struct GpuRays {
    gpu: Arc<Headless>,
    pipeline: wgpu::ComputePipeline,
    query: HitQuery,
}

/// Rays and their hits on the device.
#[derive(Debug)]
pub struct Batch {
    group: wgpu::BindGroup,
    hits: wgpu::Buffer,
    count: u32,
}

impl GpuRays {
    /// Largest number of rays in a batch, from WebGPU's default limits: 65,535 workgroups per dispatch and 128 MiB per
    /// binding.
    pub const MAX_RAYS: usize = 4_000_000;

    /// A pipeline for `scene_buffer`. `source` is WGSL; `None` uses [`source`](Self::source), which accepts every hit.
    pub fn new(
        gpu: &Arc<Headless>,
        scene_buffer: &SceneBuffer,
        geometry: &Geometry,
        storage: Storage,
        query: HitQuery,
        source: Option<&str>,
    ) -> Self {
        let source = source.map_or_else(|| Self::source(storage), str::to_owned);
        let kernel = Kernel {
            module: "hits",
            source,
            entry: match query {
                HitQuery::Closest => "closest_hits",
                HitQuery::Any => "any_hits",
            },
            layout: None,
            constants: &traversal_constants(scene_buffer, geometry, false, storage),
        };
        Self { pipeline: kernel.pipeline(&gpu.device), gpu: gpu.clone(), query }
    }

    /// WGSL source of this crate's kernel.
    pub fn source(storage: Storage) -> String {
        SHADERS.compose_with(&[storage.module(), "accept_all", "hits_pass"], "").source
    }

    /// Uploads rays; those beyond [`MAX_RAYS`](Self::MAX_RAYS) are left out.
    pub fn batch(&self, scene_buffer: &GpuSceneBuffer, rays: &[Ray]) -> Batch {
        let rays = &rays[..rays.len().min(Self::MAX_RAYS)];
        let floats: Vec<[f32; 8]> = rays
            .iter()
            .map(|r| {
                let (o, d) = (r.origin, r.direction);
                [o.x, o.y, o.z, r.t_max, d.x, d.y, d.z, 0.0]
            })
            .collect();
        let buffer = |size: usize, usage| {
            empty_buffer(&self.gpu.device, "rays", size.max(32) as u64, BufferUsages::STORAGE | usage)
        };
        let input = buffer(rays.len() * 32, BufferUsages::COPY_DST);
        self.gpu.queue.write_buffer(&input, 0, bytemuck::cast_slice(&floats));
        let hits = buffer(rays.len() * 16, BufferUsages::COPY_SRC);
        let resources = [scene_buffer.binding(), input.as_entire_binding(), hits.as_entire_binding()];
        let group = bind_group(&self.gpu.device, "hits", &self.pipeline.get_bind_group_layout(0), resources);
        Batch { group, hits, count: rays.len() as u32 }
    }

    /// Traces a batch and waits for the result.
    pub fn run(&self, batch: &Batch) {
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &batch.group, &[]);
        pass.dispatch_workgroups(batch.count.div_ceil(WORKGROUP), 1, 1);
        drop(pass);
        self.gpu.queue.submit([encoder.finish()]);
        self.gpu.wait();
    }

    /// Hits of a batch that has run. [`HitQuery::Any`] reports only whether there is a hit, with all fields 0.
    pub fn hits(&self, batch: &Batch) -> Vec<Option<Hit>> {
        let words: Vec<[u32; 4]> = bytemuck::pod_collect_to_vec(&self.gpu.read_buffer(&batch.hits));
        let hit = |&[triangle, t, u, v]: &[u32; 4]| {
            let found = match self.query {
                HitQuery::Closest => triangle != u32::MAX,
                HitQuery::Any => triangle == 1,
            };
            let triangle = if self.query == HitQuery::Any { 0 } else { triangle };
            found.then(|| Hit { triangle, t: f32::from_bits(t), u: f32::from_bits(u), v: f32::from_bits(v) })
        };
        words[..batch.count as usize].iter().map(hit).collect()
    }
}
