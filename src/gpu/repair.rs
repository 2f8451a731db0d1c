//! Repair of sparse frames: chooses quads of pixels without usable history, before the frame is shaded. CPU twin:
//! `src/cpu/sparse_pass/plan.rs`.
//!
//! Three passes a view. The first looks up history at each quad's pixels, as the method's pass will, and counts the
//! quad's key; it skips pixels that are settled. The second, once a view, finds the smallest key that the budget pays
//! for. The third chooses the quads whose keys are at least that large.

use super::binding::Binding;
use super::buffer::filled;
use super::compute::{ComputeShader, Sources, WORKGROUP_WIDTH};
use super::groups::Resource;
use super::plane::{Plane, PlaneDesc};
use super::stage::{Job, Specialization};
use crate::frame::ContextDesc;
use crate::kernel::repair::{KEYS, budget_quads};
use crate::method::Overrides;
use crate::settings::Repair;
use wgpu::{Buffer, BufferUsages, CommandEncoder, Device, TextureFormat, TextureUsages};

/// Bytes of a list before its quads.
const LIST_HEADER_BYTES: u64 = 32;
/// Bytes of a view's counts by key, threshold and number of listed quads.
const STATE_BYTES: u64 = 4 * (KEYS as u64 + 2);

/// The passes, and the quads that they chose.
#[derive(Debug)]
pub(super) struct RepairPasses {
    key: ComputeShader,
    threshold: ComputeShader,
    mask: ComputeShader,
    quads: Quads,
    /// Index of the last planned frame; `None` once it is recorded.
    pub planned: Option<u64>,
}

/// Textures and buffers for the quads of a frame of one size.
#[derive(Debug)]
struct Quads {
    budget: Buffer,
    keys: Plane,
    mask: Plane,
    views: Vec<ViewQuads>,
}

/// Buffers for the quads of a view.
#[derive(Debug)]
struct ViewQuads {
    /// `RepairQuads` in `shaders/pass/repair_mask_pass.wgsl`.
    uniforms: Buffer,
    state: Buffer,
    list: Buffer,
}

impl Quads {
    fn new(device: &Device, desc: &ContextDesc, repair: Repair) -> Self {
        let size = size_quads(desc);
        let uniforms =
            |words: [u32; 4]| filled(device, "afterimage uniforms", bytemuck::bytes_of(&words), BufferUsages::UNIFORM);
        let buffer = |size, usage| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("afterimage repair"),
                size,
                usage: BufferUsages::STORAGE | usage,
                mapped_at_creation: false,
            })
        };
        let view = |view| ViewQuads {
            uniforms: uniforms([size[0], size[1], view, 0]),
            state: buffer(STATE_BYTES, BufferUsages::COPY_DST),
            list: buffer(list_bytes(desc, repair), BufferUsages::INDIRECT | BufferUsages::COPY_SRC),
        };
        let plane = plane(desc);
        Self {
            budget: uniforms([budget_quads(repair.budget, size), 0, 0, 0]),
            keys: plane.create(device),
            mask: PlaneDesc { usage: TextureUsages::COPY_SRC, ..plane }.create(device),
            views: (0..desc.view_count).map(view).collect(),
        }
    }
}

impl RepairPasses {
    pub fn new(device: &Device, desc: &ContextDesc, repair: Repair, sources: &Sources) -> Self {
        Self {
            key: sources.shader(device, "repair_key_pass"),
            threshold: sources.shader(device, "repair_threshold_pass"),
            mask: sources.shader(device, "repair_mask_pass"),
            quads: Quads::new(device, desc, repair),
            planned: None,
        }
    }

    /// Follows a change of the context's size or of the budget.
    pub fn update(&mut self, device: &Device, desc: &ContextDesc, repair: Repair) {
        self.quads = Quads::new(device, desc, repair);
        self.planned = None;
    }

    /// Compiles the pipelines of a variant.
    pub fn prewarm(&self, device: &Device, desc: &ContextDesc, special: Specialization) {
        special.pipeline(device, desc, &self.key);
        self.threshold.pipeline(device, &[]);
        self.mask.pipeline(device, &[]);
    }

    /// Shader and override values of each compiled pipeline.
    pub fn pipelines(&self) -> impl Iterator<Item = (&'static str, Overrides)> + '_ {
        [&self.key, &self.threshold, &self.mask].into_iter().flat_map(ComputeShader::pipelines)
    }

    pub fn mask(&self) -> &Plane {
        &self.quads.mask
    }

    /// List of the chosen quads of a view.
    pub fn list(&self, view: usize) -> Option<&Buffer> {
        self.quads.views.get(view).map(|view| &view.list)
    }

    /// Clears the counts of the last frame.
    pub fn clear(&self, encoder: &mut CommandEncoder) {
        self.quads.views.iter().for_each(|view| encoder.clear_buffer(&view.state, 0, None));
    }

    /// Adds the dispatches of a frame.
    pub fn record(&self, job: &mut Job<'_>) {
        let Quads { budget, keys, mask, views } = &self.quads;
        let size = size_quads(job.desc);
        let rows = [size[0].div_ceil(WORKGROUP_WIDTH), size[1], 1];
        for (view, ViewQuads { uniforms, state, list }) in (0..).zip(views) {
            let own = [(Binding::Write, (&keys.whole).into()), (Binding::State, state.into())];
            job.dispatch(&self.key, &job.batch_of(view), &own, size);
            for (shader, uniforms, workgroups) in [(&self.threshold, budget, [1; 3]), (&self.mask, uniforms, rows)] {
                let resource = |number: u32| {
                    let of = |binding: Binding| number == binding as u32;
                    let resource: Resource = match () {
                        () if of(Binding::Read) => (&keys.whole).into(),
                        () if of(Binding::Write) => (&mask.whole).into(),
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
    }
}

/// Number of quads of a view along x and y.
fn size_quads(desc: &ContextDesc) -> [u32; 2] {
    desc.size_px.map(|side| side.div_ceil(2))
}

/// Bytes of a view's list.
pub(super) fn list_bytes(desc: &ContextDesc, repair: Repair) -> u64 {
    // A binding holds the header and a whole vec4 of the array.
    LIST_HEADER_BYTES + 4 * u64::from(budget_quads(repair.budget, size_quads(desc)).max(4))
}

/// Bytes of the textures and buffers of a plan.
pub(super) fn memory_bytes(desc: &ContextDesc, repair: Repair) -> u64 {
    2 * plane(desc).bytes() + u64::from(desc.view_count) * (STATE_BYTES + list_bytes(desc, repair))
}

/// Keys of the quads, or the mask.
fn plane(desc: &ContextDesc) -> PlaneDesc {
    PlaneDesc::new("afterimage repair", TextureFormat::R32Uint, size_quads(desc), desc.view_count)
}
