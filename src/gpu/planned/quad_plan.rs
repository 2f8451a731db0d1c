//! Plan of a frame shaded by quads: which quads are shaded, and the shaded quads around each. CPU twin:
//! `src/cpu/planned/quad_plan.rs`.
//!
//! Four passes a view and one for all. The first gives each quad its region, the even pattern, and a key by its need.
//! The second finds the smallest key that the budget pays for, and the third chooses the quads and lists them. The
//! fourth finds the shaded quads around each quad, and the fifth, again for each view, those around the listed ones.

use super::prime::PrimePass;
use crate::context::ContextDesc;
use crate::gpu::binding::Binding;
use crate::gpu::compute::{ComputeShader, Sources};
use crate::gpu::groups::Resource;
use crate::gpu::quads::{QUAD_GROUPS, Quads, ViewQuads, budget, size_quads};
use crate::gpu::recorder::BUDGET;
use crate::gpu::stage::{Job, Specialization};
use crate::kernel::quads::RUN_QUADS;
use crate::method::Overrides;
use wgpu::{Buffer, CommandEncoder, Device};

/// Invocations of a workgroup of `shaders/planned/quad_mask_pass.wgsl` along x and y.
const MASK_WORKGROUP: [u32; 2] = [16, 4];

/// The passes, and the quads that they chose.
#[derive(Debug)]
pub(crate) struct QuadPasses {
    key: ComputeShader,
    given: ComputeShader,
    threshold: ComputeShader,
    mask: ComputeShader,
    around: ComputeShader,
    octants: ComputeShader,
    pub prime: PrimePass,
    pub quads: Quads,
    /// The last planned frame; `None` once it is recorded.
    pub planned: Option<Planned>,
}

/// What is known of a planned frame before it is shaded.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Planned {
    pub index: u64,
    /// Whether it has one pixel of each quad.
    pub is_quarter: bool,
}

impl QuadPasses {
    pub fn new(device: &Device, desc: &ContextDesc, sources: &Sources) -> Self {
        Self {
            key: sources.shader(device, "quad_key_pass"),
            given: sources.shader(device, "quad_given_pass"),
            threshold: sources.shader(device, "quad_threshold_pass"),
            mask: sources.shader(device, "quad_mask_pass"),
            around: sources.shader(device, "quad_around_pass"),
            octants: sources.shader(device, "quad_octants_pass"),
            prime: PrimePass::new(device, sources),
            quads: Quads::new(device, desc),
            planned: None,
        }
    }

    /// Follows a change of the context's size or of the settings.
    pub fn update(&mut self, device: &Device, desc: &ContextDesc) {
        self.quads = Quads::new(device, desc);
        self.planned = None;
    }

    pub fn prewarm(&self, device: &Device, desc: &ContextDesc, special: Specialization) {
        special.pipeline(device, desc, &self.key);
        special.pipeline(device, desc, &self.given);
        special.pipeline(device, desc, &self.around);
        special.pipeline(device, desc, &self.octants);
        self.threshold.pipeline(device, &[]);
        self.mask.pipeline(device, &[]);
    }

    /// Shader and override values of each compiled pipeline.
    pub fn pipelines(&self) -> impl Iterator<Item = (&'static str, Overrides)> + '_ {
        let shaders = [&self.key, &self.given, &self.threshold, &self.mask, &self.around, &self.octants];
        shaders.into_iter().flat_map(ComputeShader::pipelines)
    }

    /// Records the clearing of the counts and the copy of the budget in `upload`, before the dispatches of a frame.
    pub fn begin(&self, encoder: &mut CommandEncoder, upload: &Buffer) {
        self.quads.views.iter().for_each(|view| encoder.clear_buffer(&view.state, 0, None));
        let budget = &self.quads.budget;
        encoder.copy_buffer_to_buffer(upload, BUDGET, budget, 0, budget.size());
    }

    /// Adds the passes of a frame. `is_given`: whether the renderer chose its pixels itself.
    pub fn record(&self, job: &mut Job<'_>, is_given: bool) {
        job.recorder.budget(budget(job.desc));
        let Quads { budget, keys, mask, runs, around, views } = &self.quads;
        let size = size_quads(job.desc);
        let [width, height] = MASK_WORKGROUP;
        let of_mask = [size[0].div_ceil(RUN_QUADS).div_ceil(width), size[1].div_ceil(height), 1];
        for (view, ViewQuads { uniforms, state, list }) in (0..).zip(views) {
            let own = [(Binding::Write, (&keys.whole).into()), (Binding::State, state.into())];
            match is_given {
                true => job.dispatch(&self.given, &job.batch_of(view), &own, size),
                false => job.dispatch(&self.key, &job.batch_of(view), &own, size.map(|side| side.div_ceil(2))),
            }
            for (shader, uniforms, workgroups) in [(&self.threshold, budget, [1; 3]), (&self.mask, uniforms, of_mask)] {
                let own = [
                    (Binding::Uniforms, Resource::from(uniforms)),
                    (Binding::Read, (&keys.whole).into()),
                    (Binding::Write, (&mask.whole).into()),
                    (Binding::WriteSecond, (&runs.whole).into()),
                    (Binding::State, state.into()),
                    (Binding::List, list.into()),
                ];
                let of = |number: u32| own.iter().find(|(binding, _)| *binding as u32 == number);
                let resource = |number: u32| of(number).map(|(_, resource)| resource.clone());
                let pipeline = shader.pipeline(job.device, &[]);
                job.recorder.add(job.device, (shader, pipeline), None, resource, workgroups);
            }
        }
        let own = [(Binding::ReadSecond, Resource::from(&runs.whole)), (Binding::Write, (&around.whole).into())];
        for batch in job.batches() {
            job.dispatch(&self.around, &batch, &own, size);
        }
        for (view, ViewQuads { state, list, .. }) in (0..).zip(views) {
            let [runs, around] = own.clone();
            let own = [runs, around, (Binding::List, list.into())];
            job.dispatch_indirect(&self.octants, &job.batch_of(view), &own, (state, QUAD_GROUPS));
        }
    }
}
