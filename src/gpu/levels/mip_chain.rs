//! Mip chains of stored surfaces and of noisy candidates.

use crate::context::ContextDesc;
use crate::gpu::binding::Binding;
use crate::gpu::buffer::filled;
use crate::gpu::compute::{ComputeShader, Sources, WORKGROUP_WIDTH};
use crate::gpu::groups::Resource;
use crate::gpu::history::History;
use crate::gpu::plane::Plane;
use crate::gpu::recorder::Recorder;
use crate::gpu::stage::{Job, Passes, Specialization};
use crate::kernel::foveate::level_len;
use std::num::NonZeroU64;
use wgpu::{Buffer, BufferUsages, Device};

/// Bytes from the size of one level to that of the next: at most 256 on every device.
const ALIGNMENT: usize = 256;
/// Levels that a mip chain can have.
const LEVELS: u32 = 16;

/// Pass that fills a level of a mip chain from the next finer one.
#[derive(Debug)]
pub(crate) struct MipChainPass {
    shader: ComputeShader,
    overrides: [(&'static str, u32); 1],
    size_px: [u32; 2],
    /// Size of each level.
    sizes: Buffer,
}

impl MipChainPass {
    /// The pass for stored surfaces, or for noisy candidates.
    pub fn new(device: &Device, desc: &ContextDesc, sources: &Sources, of_candidates: bool) -> Self {
        Self {
            shader: sources.shader(device, "mip_chain_pass"),
            overrides: [("CANDIDATES", u32::from(of_candidates))],
            size_px: desc.size_px,
            sizes: sizes(device, desc.size_px),
        }
    }

    /// Adds the dispatches that fill a mip chain from its second level on.
    fn fill(&self, device: &Device, recorder: &mut Recorder, chain: &Plane) {
        for (i, levels) in chain.levels.windows(2).enumerate() {
            // The first level of the texture is level 1 of the mip chain.
            let level = i as u32 + 1;
            let resource = |number: u32| {
                Some(match number {
                    _ if number == Binding::Read as u32 => (&levels[0]).into(),
                    _ if number == Binding::Write as u32 => (&levels[1]).into(),
                    _ => Resource::Buffer(self.sizes.clone(), u64::from(level) * ALIGNMENT as u64, NonZeroU64::new(8)),
                })
            };
            let [width, height] = self.size_px.map(|s| level_len(s, level + 1));
            let workgroups = [width.div_ceil(WORKGROUP_WIDTH), height, chain.desc.layers];
            let pipeline = self.shader.pipeline(device, &self.overrides);
            recorder.add(device, (&self.shader, pipeline), None, resource, workgroups);
        }
    }
}

fn sizes(device: &Device, size_px: [u32; 2]) -> Buffer {
    let mut bytes = vec![0; LEVELS as usize * ALIGNMENT];
    for (level, slot) in (0..).zip(bytes.chunks_mut(ALIGNMENT)) {
        slot[..8].copy_from_slice(bytemuck::bytes_of(&size_px.map(|s| level_len(s, level))));
    }
    filled(device, "afterimage mip levels", &bytes, BufferUsages::UNIFORM)
}

impl Passes for MipChainPass {
    fn resize(&mut self, device: &Device, desc: &ContextDesc) {
        (self.size_px, self.sizes) = (desc.size_px, sizes(device, desc.size_px));
    }

    fn prewarm(&self, device: &Device, _: &ContextDesc, _: Specialization) {
        self.shader.pipeline(device, &self.overrides);
    }

    fn shaders(&self) -> Vec<&ComputeShader> {
        vec![&self.shader]
    }

    fn record<'a>(&'a self, job: &mut Job<'a>) {
        if job.special.view.is_none() {
            self.complete(job.device, job.recorder, job.history);
        }
    }

    fn complete(&self, device: &Device, recorder: &mut Recorder, history: &History) {
        self.fill(device, recorder, &history.split().1.planes[1]);
    }
}

/// Passes that fill the mip chain of a frame's noisy candidates.
#[derive(Debug)]
pub(crate) struct CandidatePass {
    first: ComputeShader,
    rest: MipChainPass,
}

impl CandidatePass {
    pub fn new(device: &Device, desc: &ContextDesc, sources: &Sources) -> Self {
        Self { first: sources.shader(device, "candidate_pass"), rest: MipChainPass::new(device, desc, sources, true) }
    }
}

impl Passes for CandidatePass {
    fn resize(&mut self, device: &Device, desc: &ContextDesc) {
        self.rest.resize(device, desc);
    }

    fn prewarm(&self, device: &Device, desc: &ContextDesc, special: Specialization) {
        special.pipeline(device, desc, &self.first);
        self.rest.prewarm(device, desc, special);
    }

    fn shaders(&self) -> Vec<&ComputeShader> {
        vec![&self.first, &self.rest.shader]
    }

    fn record<'a>(&'a self, job: &mut Job<'a>) {
        let Some(candidates) = &job.history.candidates else { return };
        for batch in job.batches() {
            let own = [(Binding::Write, (&candidates.levels[0]).into())];
            job.dispatch(&self.first, &batch, &own, job.desc.size_px.map(|s| level_len(s, 1)));
        }
        self.rest.fill(job.device, job.recorder, candidates);
    }
}
