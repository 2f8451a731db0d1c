//! Fills every pixel of a sparse frame, for methods that read whole frames. CPU twin: `src/cpu/fill.rs`.

use super::Textures;
use super::binding::Binding;
use super::compute::{ComputeShader, Sources};
use super::plane::{Plane, PlaneDesc};
use super::stage::{Job, Passes, Specialization};
use crate::context::ContextDesc;
use crate::foveation::Filter;
use wgpu::{Device, TextureFormat};

/// Passes that fill frames of lattices and of quads, and the filled color of the current one.
#[derive(Debug)]
pub(super) struct Fill {
    lattices: ComputeShader,
    quads: ComputeShader,
    color: Plane,
}

impl Fill {
    pub fn new(device: &Device, desc: &ContextDesc, sources: &Sources) -> Self {
        Self {
            lattices: sources.shader(device, "fill_pass"),
            quads: sources.shader(device, "quad_fill_pass"),
            color: color(desc).create(device),
        }
    }

    /// The pass of the frames that the settings describe.
    fn shader(&self, desc: &ContextDesc) -> &ComputeShader {
        if desc.settings.foveation.filter == Filter::Quads { &self.quads } else { &self.lattices }
    }
}

impl Passes for Fill {
    fn resize(&mut self, device: &Device, desc: &ContextDesc) {
        self.color = color(desc).create(device);
    }

    fn prewarm(&self, device: &Device, desc: &ContextDesc, special: &mut Specialization) {
        special.pipeline(device, desc, self.shader(desc));
    }

    fn shaders(&self) -> Vec<&ComputeShader> {
        vec![&self.lattices, &self.quads]
    }

    fn record<'a>(&'a self, job: &mut Job<'a>) {
        let own = [(Binding::Write, (&self.color.whole).into())];
        for batch in job.batches() {
            job.dispatch(self.shader(job.desc), &batch, &own, job.desc.size_px);
        }
        job.uniforms.color_shift = 0;
        job.textures[Binding::Color as usize] = Some(Textures::Layers(&self.color.texture));
    }
}

/// The filled color, whose format stores samples bit for bit.
pub(super) fn color(desc: &ContextDesc) -> PlaneDesc {
    PlaneDesc::new("afterimage filled color", TextureFormat::Rgba32Float, desc.size_px, desc.view_count)
}
