//! Plan of a frame shaded by quads: which quads are shaded, and the shaded quads around each. CPU twin:
//! `src/cpu/sparse_pass/quads.rs`.
//!
//! Three passes a view and one for all. The first gives each quad its region, the even pattern, and a key by its need.
//! The second finds the smallest key that the budget pays for, and the third chooses the quads and lists them. The
//! fourth finds the shaded quads around each.

use super::binding::Binding;
use super::buffer::filled;
use super::compute::{ComputeShader, Sources, WORKGROUP_WIDTH};
use super::groups::Resource;
use super::plane::{Plane, PlaneDesc};
use super::stage::{Job, Specialization};
use crate::frame::ContextDesc;
use crate::kernel::quads::{BLOCK, KEYS, budget_quads};
use crate::method::Overrides;
use wgpu::{Buffer, BufferUsages, CommandEncoder, Device, TextureFormat, TextureUsages};

/// Bytes of a list before its quads.
const LIST_HEADER_BYTES: u64 = 32;
/// Words of `QuadState` in `shaders/pass/quad_state.wgsl` before its arguments of dispatches.
const ARGUMENTS: u64 = KEYS as u64 + 3;
const STATE_BYTES: u64 = 4 * (ARGUMENTS + 6);
/// Place in the state of the arguments of a dispatch with an invocation for each pixel of shaded quads.
pub(super) const PIXEL_GROUPS: u64 = 4 * ARGUMENTS;
/// The same with an invocation for each quad.
pub(super) const QUAD_GROUPS: u64 = PIXEL_GROUPS + 12;

/// The passes, and the quads that they chose.
#[derive(Debug)]
pub(super) struct QuadPasses {
    key: ComputeShader,
    threshold: ComputeShader,
    mask: ComputeShader,
    around: ComputeShader,
    pub quads: Quads,
    /// Index of the last planned frame; `None` once it is recorded.
    pub planned: Option<u64>,
}

/// Textures and buffers for the quads of a frame of one size.
#[derive(Debug)]
pub(super) struct Quads {
    budget: Buffer,
    keys: Plane,
    /// Bit 0: whether a quad is shaded; bits 1 and 2: its region.
    pub mask: Plane,
    blocks: Plane,
    /// Codes of the shaded quads around each.
    pub around: Plane,
    pub views: Vec<ViewQuads>,
}

/// Buffers for the quads of a view.
#[derive(Debug)]
pub(super) struct ViewQuads {
    /// `QuadSize` in `shaders/pass/quad_mask_pass.wgsl`.
    uniforms: Buffer,
    pub state: Buffer,
    pub list: Buffer,
}

impl Quads {
    fn new(device: &Device, desc: &ContextDesc) -> Self {
        let size = size_quads(desc);
        let uniforms =
            |words: [u32; 4]| filled(device, "afterimage uniforms", bytemuck::bytes_of(&words), BufferUsages::UNIFORM);
        let buffer = |size, usage| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("afterimage quads"),
                size,
                usage: BufferUsages::STORAGE | BufferUsages::INDIRECT | usage,
                mapped_at_creation: false,
            })
        };
        let view = |view| ViewQuads {
            uniforms: uniforms([size[0], size[1], view, 0]),
            state: buffer(STATE_BYTES, BufferUsages::COPY_DST),
            list: buffer(list_bytes(desc), BufferUsages::COPY_SRC),
        };
        let [keys, mask, blocks, around] = planes(desc);
        Self {
            budget: uniforms([budget_quads(desc.settings.foveation.budget, size), 0, 0, 0]),
            keys: keys.create(device),
            mask: mask.create(device),
            blocks: blocks.create(device),
            around: around.create(device),
            views: (0..desc.view_count).map(view).collect(),
        }
    }
}

impl QuadPasses {
    pub fn new(device: &Device, desc: &ContextDesc, sources: &Sources) -> Self {
        Self {
            key: sources.shader(device, "quad_key_pass"),
            threshold: sources.shader(device, "quad_threshold_pass"),
            mask: sources.shader(device, "quad_mask_pass"),
            around: sources.shader(device, "quad_around_pass"),
            quads: Quads::new(device, desc),
            planned: None,
        }
    }

    /// Follows a change of the context's size or of the settings.
    pub fn update(&mut self, device: &Device, desc: &ContextDesc) {
        self.quads = Quads::new(device, desc);
        self.planned = None;
    }

    /// Compiles the pipelines of a variant.
    pub fn prewarm(&self, device: &Device, desc: &ContextDesc, special: Specialization) {
        special.pipeline(device, desc, &self.key);
        special.pipeline(device, desc, &self.around);
        self.threshold.pipeline(device, &[]);
        self.mask.pipeline(device, &[]);
    }

    /// Shader and override values of each compiled pipeline.
    pub fn pipelines(&self) -> impl Iterator<Item = (&'static str, Overrides)> + '_ {
        [&self.key, &self.threshold, &self.mask, &self.around].into_iter().flat_map(ComputeShader::pipelines)
    }

    /// Records the clearing of the counts, before the dispatches of a frame.
    pub fn clear(&self, encoder: &mut CommandEncoder) {
        self.quads.views.iter().for_each(|view| encoder.clear_buffer(&view.state, 0, None));
    }

    /// Adds the dispatches of a frame.
    pub fn record(&self, job: &mut Job<'_>) {
        let Quads { budget, keys, mask, blocks, around, views } = &self.quads;
        let size = size_quads(job.desc);
        let in_blocks = size.map(|side| side.div_ceil(BLOCK));
        let rows = [in_blocks[0].div_ceil(WORKGROUP_WIDTH), in_blocks[1], 1];
        for (view, ViewQuads { uniforms, state, list }) in (0..).zip(views) {
            let own = [(Binding::Write, (&keys.whole).into()), (Binding::State, state.into())];
            job.dispatch(&self.key, &job.batch_of(view), &own, size.map(|side| side.div_ceil(2)));
            for (shader, uniforms, workgroups) in [(&self.threshold, budget, [1; 3]), (&self.mask, uniforms, rows)] {
                let resource = |number: u32| {
                    let of = |binding: Binding| number == binding as u32;
                    let resource: Resource = match () {
                        () if of(Binding::Read) => (&keys.whole).into(),
                        () if of(Binding::Write) => (&mask.whole).into(),
                        () if of(Binding::WriteSecond) => (&blocks.whole).into(),
                        () if of(Binding::State) => state.into(),
                        () if of(Binding::List) => list.into(),
                        () => uniforms.into(),
                    };
                    Some(resource)
                };
                let pipeline = shader.pipeline(job.device, &[]);
                job.recorder.add(job.device, (shader, pipeline), None, resource, workgroups);
            }
        }
        let own = [(Binding::Read, &mask.whole), (Binding::ReadSecond, &blocks.whole), (Binding::Write, &around.whole)];
        let own = own.map(|(binding, view)| (binding, view.into()));
        for batch in job.batches() {
            job.dispatch(&self.around, &batch, &own, size);
        }
    }
}

/// Number of quads of a view along x and y.
pub(super) fn size_quads(desc: &ContextDesc) -> [u32; 2] {
    desc.size_px.map(|side| side.div_ceil(2))
}

/// Bytes of a view's list.
pub(super) fn list_bytes(desc: &ContextDesc) -> u64 {
    let [columns, rows] = size_quads(desc).map(u64::from);
    // A binding holds the header and a whole vec4 of the array.
    LIST_HEADER_BYTES + 4 * (columns * rows).max(4)
}

/// Bytes of the textures and buffers of a plan.
pub(super) fn memory_bytes(desc: &ContextDesc) -> u64 {
    let planes: u64 = planes(desc).iter().map(PlaneDesc::bytes).sum();
    planes + u64::from(desc.view_count) * (STATE_BYTES + list_bytes(desc))
}

/// Keys, mask, blocks, and the shaded quads around each.
fn planes(desc: &ContextDesc) -> [PlaneDesc; 4] {
    use TextureFormat::{R32Uint, Rg32Uint};
    let size = size_quads(desc);
    let plane = |format, size| PlaneDesc::new("afterimage quads", format, size, desc.view_count);
    [
        plane(R32Uint, size),
        PlaneDesc { usage: TextureUsages::COPY_SRC, ..plane(R32Uint, size) },
        plane(R32Uint, size.map(|side| side.div_ceil(BLOCK))),
        plane(Rg32Uint, size),
    ]
}
