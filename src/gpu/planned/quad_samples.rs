//! Comparison of the samples of shaded quads with history, before the pass of smr that reconstructs the pixels. CPU
//! twin: `src/cpu/planned/quad_samples.rs`.

use crate::context::ContextDesc;
use crate::gpu::binding::Binding;
use crate::gpu::compute::{ComputeShader, Sources, WORKGROUP_WIDTH};
use crate::gpu::plane::{Plane, PlaneDesc};
use crate::gpu::quads::{PIXEL_GROUPS, QUAD_GROUPS, size_quads};
use crate::gpu::stage::{Job, Passes};
use crate::kernel::reconstruction::BLOCK_QUADS;
use wgpu::{Device, TextureFormat};

/// Passes over the samples, and the rectification of history at the quads. The comparisons lie in the texture of this
/// frame's history until the method's pass writes that.
#[derive(Debug)]
pub(crate) struct QuadSamplePasses {
    observe: ComputeShader,
    blocks: ComputeShader,
    rectify: ComputeShader,
    block_gains: Plane,
    rectified: Plane,
}

impl QuadSamplePasses {
    pub fn new(device: &Device, desc: &ContextDesc, sources: &Sources) -> Self {
        let observe = if desc.has_albedo { "quad_observe_albedo_pass" } else { "quad_observe_pass" };
        Self {
            observe: sources.shader(device, observe),
            blocks: sources.shader(device, "quad_blocks_pass"),
            rectify: sources.shader(device, "quad_rectify_pass"),
            block_gains: block_gains(desc).create(device),
            rectified: rectified(desc).create(device),
        }
    }
}

impl Passes for QuadSamplePasses {
    fn resize(&mut self, device: &Device, desc: &ContextDesc) {
        self.block_gains = block_gains(desc).create(device);
        self.rectified = rectified(desc).create(device);
    }

    fn shaders(&self) -> Vec<&ComputeShader> {
        vec![&self.observe, &self.blocks, &self.rectify]
    }

    fn record<'a>(&'a self, job: &mut Job<'a>) {
        let Some(quads) = job.quads else { return };
        let next = &job.history.split().1.planes[0];
        // As `frame.single_pixels` tells the shader.
        let observe_groups = if job.desc.settings.foveation.single_pixels { QUAD_GROUPS } else { PIXEL_GROUPS };
        for (i, view) in (0..).zip(&quads.views) {
            let own = [(Binding::List, (&view.list).into()), (Binding::Write, (&next.levels[0]).into())];
            job.dispatch_indirect(&self.observe, &job.batch_of(i), &own, (&view.state, observe_groups));
        }
        let [columns, rows] = self.block_gains.desc.size_px;
        for batch in job.batches() {
            let own = [(Binding::Read, (&next.whole).into()), (Binding::Write, (&self.block_gains.whole).into())];
            // A workgroup a block.
            job.dispatch(&self.blocks, &batch, &own, [columns * WORKGROUP_WIDTH, rows]);
        }
        for (i, view) in (0..).zip(&quads.views) {
            let own = [
                (Binding::List, (&view.list).into()),
                (Binding::Read, (&next.whole).into()),
                (Binding::ReadSecond, (&self.block_gains.whole).into()),
                (Binding::Write, (&self.rectified.whole).into()),
            ];
            job.dispatch_indirect(&self.rectify, &job.batch_of(i), &own, (&view.state, QUAD_GROUPS));
        }
        job.rectified = Some(&self.rectified.whole);
    }
}

/// Bytes of the textures.
pub(crate) fn memory_bytes(desc: &ContextDesc) -> u64 {
    block_gains(desc).bytes() + rectified(desc).bytes()
}

/// Gains of the blocks of all views.
fn block_gains(desc: &ContextDesc) -> PlaneDesc {
    let size = size_quads(desc).map(|side| side.div_ceil(BLOCK_QUADS));
    PlaneDesc::new("afterimage blocks", TextureFormat::R32Uint, size, desc.view_count)
}

/// Rectification of history at the quads of all views.
fn rectified(desc: &ContextDesc) -> PlaneDesc {
    PlaneDesc::new("afterimage quads", TextureFormat::Rgba32Uint, size_quads(desc), desc.view_count)
}
