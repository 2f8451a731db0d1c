//! Fills every pixel of a planned frame, for methods that read whole frames. CPU twin: `src/cpu/levels/fill.rs`.

use crate::context::ContextDesc;
use crate::gpu::Textures;
use crate::gpu::binding::Binding;
use crate::gpu::compute::{ComputeShader, Sources};
use crate::gpu::plane::{Plane, PlaneDesc};
use crate::gpu::stage::{Job, Passes};
use wgpu::{Device, TextureFormat};

/// The pass, and the filled color of the current frame.
#[derive(Debug)]
pub(crate) struct Fill {
    shader: ComputeShader,
    color: Plane,
}

impl Fill {
    pub fn new(device: &Device, desc: &ContextDesc, sources: &Sources) -> Self {
        Self { shader: sources.shader(device, "quad_fill_pass"), color: color(desc).create(device) }
    }
}

impl Passes for Fill {
    fn resize(&mut self, device: &Device, desc: &ContextDesc) {
        self.color = color(desc).create(device);
    }

    fn shaders(&self) -> Vec<&ComputeShader> {
        vec![&self.shader]
    }

    fn record<'a>(&'a self, job: &mut Job<'a>) {
        let own = [(Binding::Write, (&self.color.whole).into())];
        for batch in job.batches() {
            job.dispatch(&self.shader, &batch, &own, job.desc.size_px);
        }
        job.textures[Binding::Color as usize] = Some(Textures::Layers(&self.color.texture));
    }
}

/// The filled color, whose format stores samples bit for bit.
pub(crate) fn color(desc: &ContextDesc) -> PlaneDesc {
    PlaneDesc::new("afterimage filled color", TextureFormat::Rgba32Float, desc.size_px, desc.view_count)
}
