//! Fills every pixel of a sparse frame, for methods that read whole frames. CPU twin: `src/cpu/fill.rs`.

use super::Textures;
use super::binding::Binding;
use super::compute::{ComputeShader, Sources};
use super::plane::{Plane, PlaneDesc};
use super::stage::{Job, Passes, Specialization};
use crate::foveation::Filter;
use crate::frame::ContextDesc;
use crate::method::Overrides;
use wgpu::{Device, TextureFormat};

/// Pass that fills sparse frames, and the filled color of the current one.
#[derive(Debug)]
pub(super) struct Fill {
    shader: ComputeShader,
    color: Plane,
}

impl Fill {
    pub fn new(device: &Device, desc: &ContextDesc, sources: &Sources) -> Self {
        Self { shader: shader(device, desc, sources), color: color(desc).create(device) }
    }
}

impl Passes for Fill {
    fn resize(&mut self, device: &Device, desc: &ContextDesc) {
        self.color = color(desc).create(device);
    }

    fn prewarm(&self, device: &Device, desc: &ContextDesc, special: &mut Specialization) {
        special.pipeline(device, desc, &self.shader);
    }

    fn pipelines(&self) -> Vec<(&'static str, Overrides)> {
        self.shader.pipelines()
    }

    fn record<'a>(&'a self, job: &mut Job<'a>) {
        for batch in job.batches() {
            job.dispatch(&self.shader, &batch, &[(Binding::Write, (&self.color.whole).into())], job.desc.size_px);
        }
        job.textures[Binding::Color as usize] = Some(Textures::Layers(&self.color.texture));
    }
}

/// The pass of the samples that frames have.
fn shader(device: &Device, desc: &ContextDesc, sources: &Sources) -> ComputeShader {
    let by_quads = desc.settings.foveation.filter == Filter::Quads;
    sources.shader(device, if by_quads { "quad_fill_pass" } else { "fill_pass" })
}

/// The filled color, whose format stores samples bit for bit.
pub(super) fn color(desc: &ContextDesc) -> PlaneDesc {
    PlaneDesc::new("afterimage filled color", TextureFormat::Rgba32Float, desc.size_px, desc.view_count)
}
