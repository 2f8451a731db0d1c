//! Pass of a method: its pipelines are specialized to the inputs of a frame and to the settings. What is absent is
//! switched off by `override` constants and bound to placeholders, which a specialized shader does not read.

use super::binding::Binding;
use super::compute::{ComputeShader, Sources};
use super::stage::{Job, Passes, Specialization};
use crate::context::ContextDesc;
use crate::method::PassShader;
use std::sync::OnceLock;
use wgpu::{Device, TextureFormat};

#[derive(Debug)]
pub(super) struct MethodPass {
    shader: ComputeShader,
    /// The pass that also writes a debug view; made at its first use.
    with_view: OnceLock<ComputeShader>,
    pass: PassShader,
    output: TextureFormat,
    sources: Sources,
}

impl MethodPass {
    /// The pass for outputs of format `output`.
    pub fn new(device: &Device, desc: &ContextDesc, output: TextureFormat, sources: &Sources) -> Self {
        let pass = desc.settings.pass_shader();
        let name = if desc.has_albedo { "quad_albedo_pass" } else { pass.name };
        let pass = PassShader { name, ..pass };
        let shader = sources.shader_of(device, pass.name, &writing(device, &sources.text(pass.name), output));
        Self { shader, with_view: OnceLock::new(), pass, output, sources: sources.clone() }
    }

    fn shader(&self, device: &Device, special: Specialization) -> &ComputeShader {
        if special.debug.is_none() {
            return &self.shader;
        }
        self.with_view.get_or_init(|| {
            let source = self.sources.text_with_view(self.pass.name);
            self.sources.shader_of(device, self.pass.name, &writing(device, &source, self.output))
        })
    }
}

impl Passes for MethodPass {
    fn prewarm(&self, device: &Device, desc: &ContextDesc, special: Specialization) {
        special.pipeline(device, desc, self.shader(device, special));
    }

    fn shaders(&self) -> Vec<&ComputeShader> {
        [Some(&self.shader), self.with_view.get()].into_iter().flatten().collect()
    }

    fn record<'a>(&'a self, job: &mut Job<'a>) {
        let shader = self.shader(job.device, job.special);
        let read = job.rectified.or(job.history.candidates.as_ref().map(|candidates| &candidates.whole));
        let own: Vec<_> = read.map(|view| (Binding::Read, view.into())).into_iter().collect();
        let blocks = job.desc.size_px.map(|s| s.div_ceil(self.pass.block_px));
        for batch in job.batches() {
            job.dispatch(shader, &batch, &own, blocks);
        }
    }
}

/// Shader text for outputs of format `output`: in WGSL the texel format of a storage texture is part of its type.
fn writing(device: &Device, source: &str, output: TextureFormat) -> String {
    let texel = super::output::texel(device, output).expect("the output format was checked");
    source.replace(
        "color_out: texture_storage_2d_array<rgba16float",
        &format!("color_out: texture_storage_2d_array<{texel}"),
    )
}
