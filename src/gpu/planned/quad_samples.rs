//! Comparison of the samples of shaded quads with history, before the pass of smr that reconstructs the pixels. CPU
//! twin: `src/cpu/planned/quad_samples.rs`.

use crate::context::ContextDesc;
use crate::gpu::binding::Binding;
use crate::gpu::compute::{ComputeShader, Sources};
use crate::gpu::plane::{Plane, PlaneDesc};
use crate::gpu::quads::{PIXEL_GROUPS, QUAD_GROUPS, size_quads};
use crate::gpu::stage::{Job, Passes};
use wgpu::{Device, TextureFormat};

/// Passes over the samples, and the rectification of history at the quads. The comparisons lie in the texture of this
/// frame's history until the method's pass writes that.
#[derive(Debug)]
pub(crate) struct QuadSamplePasses {
    observe: ComputeShader,
    rectify: ComputeShader,
    rectified: Plane,
}

impl QuadSamplePasses {
    pub fn new(device: &Device, desc: &ContextDesc, sources: &Sources) -> Self {
        let observe = if desc.has_albedo { "quad_observe_albedo_pass" } else { "quad_observe_pass" };
        Self {
            observe: sources.shader(device, observe),
            rectify: sources.shader(device, "quad_rectify_pass"),
            rectified: rectified(desc).create(device),
        }
    }
}

impl Passes for QuadSamplePasses {
    fn resize(&mut self, device: &Device, desc: &ContextDesc) {
        self.rectified = rectified(desc).create(device);
    }

    fn shaders(&self) -> Vec<&ComputeShader> {
        vec![&self.observe, &self.rectify]
    }

    fn record<'a>(&'a self, job: &mut Job<'a>) {
        let Some(quads) = job.quads else { return };
        let next = &job.history.split().1.planes[0];
        let observed = [(Binding::Write, &next.levels[0])];
        let rectify = [(Binding::Read, &next.whole), (Binding::Write, &self.rectified.whole)];
        // As `frame.single_pixels` tells the shader.
        let observe_groups = if job.desc.settings.foveation.single_pixels { QUAD_GROUPS } else { PIXEL_GROUPS };
        for (shader, views, arguments) in
            [(&self.observe, &observed[..], observe_groups), (&self.rectify, &rectify[..], QUAD_GROUPS)]
        {
            for (i, view) in (0..).zip(&quads.views) {
                let mut own = vec![(Binding::List, (&view.list).into())];
                own.extend(views.iter().map(|&(binding, view)| (binding, view.into())));
                job.dispatch_indirect(shader, &job.batch_of(i), &own, (&view.state, arguments));
            }
        }
        job.rectified = Some(&self.rectified.whole);
    }
}

/// Rectification of history at the quads of all views.
pub(crate) fn rectified(desc: &ContextDesc) -> PlaneDesc {
    PlaneDesc::new("afterimage quads", TextureFormat::Rgba32Uint, size_quads(desc), desc.view_count)
}
