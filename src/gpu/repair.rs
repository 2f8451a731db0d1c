//! Repair of sparse frames: chooses quads of pixels without usable history, before the frame is shaded. CPU twin:
//! `src/cpu/sparse_pass/plan.rs`.
//!
//! Three passes a view. The first looks up history at each quad's pixels, as the method's pass will, and counts the
//! quad's key; it skips pixels that are settled. The second, once a view, finds the smallest key that the budget pays
//! for. The third chooses the quads whose keys are at least that large.

use super::Variant;
use super::buffer::filled;
use super::compute::{ComputeShader, float_texture, storage_buffer, storage_texture, uint_texture, uniform};
use super::history::array_view;
use super::method_pass::{PAST_FRAME_BINDING, Placeholders, input_overrides};
use super::stage::Job;
use super::textures::Batch;
use crate::frame::ContextDesc;
use crate::kernel::repair::{KEYS, budget_quads};
use crate::method::{HistoryLayout, Overrides, smr_sparse_antialiases};
use crate::settings::Repair;
use crate::shader::SHADERS;
use wgpu::{
    BindingResource, Buffer, BufferUsages, CommandEncoder, ComputePass, Device, Extent3d, Texture, TextureDescriptor,
    TextureDimension, TextureFormat, TextureUsages, TextureView,
};

/// Format of keys and masks.
const FORMAT: TextureFormat = TextureFormat::R32Uint;
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
    absent: Placeholders,
    /// Index of the last planned frame; `None` once it is recorded.
    pub planned: Option<u64>,
}

/// Textures and buffers for the quads of a frame of one size.
#[derive(Debug)]
struct Quads {
    budget: u32,
    keys: TextureView,
    mask: Texture,
    mask_view: TextureView,
    /// One for each view, like the lists.
    states: Vec<Buffer>,
    lists: Vec<Buffer>,
}

impl Quads {
    fn new(device: &Device, desc: &ContextDesc, repair: Repair) -> Self {
        let size = size_quads(desc);
        let image = |usage| {
            device.create_texture(&TextureDescriptor {
                label: Some("afterimage repair"),
                size: Extent3d { width: size[0], height: size[1], depth_or_array_layers: desc.view_count },
                mip_level_count: 1,
                sample_count: 1,
                dimension: TextureDimension::D2,
                format: FORMAT,
                usage: TextureUsages::TEXTURE_BINDING | TextureUsages::STORAGE_BINDING | usage,
                view_formats: &[],
            })
        };
        let buffers = |bytes, usage| {
            let buffer = |_| {
                device.create_buffer(&wgpu::BufferDescriptor {
                    label: Some("afterimage repair"),
                    size: bytes,
                    usage: BufferUsages::STORAGE | usage,
                    mapped_at_creation: false,
                })
            };
            (0..desc.view_count).map(buffer).collect()
        };
        let mask = image(TextureUsages::COPY_SRC);
        Self {
            budget: budget_quads(repair.budget, size),
            keys: array_view(&image(TextureUsages::empty())),
            mask_view: array_view(&mask),
            mask,
            states: buffers(STATE_BYTES, BufferUsages::COPY_DST),
            lists: buffers(list_bytes(desc, repair), BufferUsages::INDIRECT | BufferUsages::COPY_SRC),
        }
    }
}

impl RepairPasses {
    /// The passes for contexts of `desc`.
    pub fn new(device: &Device, desc: &ContextDesc, repair: Repair) -> Self {
        let sources = ["repair_key_pass", "repair_threshold_pass", "repair_mask_pass"];
        Self::with_shaders(device, desc, repair, sources.map(|name| SHADERS.compose(name).source))
    }

    /// The passes of the WGSL texts `key`, `threshold` and `mask`.
    pub fn with_shaders(
        device: &Device,
        desc: &ContextDesc,
        repair: Repair,
        [key, threshold, mask]: [String; 3],
    ) -> Self {
        // Numbers in `inputs`, `kept_history`, `lattices`, `repair_state`, `repair_list` and the passes.
        let depth_to_trust = (2..5).map(|number| (number, float_texture()));
        let own = [
            (8, uint_texture()),
            (17, uniform()),
            (18, storage_texture(FORMAT)),
            (19, storage_buffer(false)),
            (PAST_FRAME_BINDING, uniform()),
        ];
        let key_bindings: Vec<_> = std::iter::once((0, uniform())).chain(depth_to_trust).chain(own).collect();
        let threshold_bindings = [(0, uniform()), (19, storage_buffer(false)), (20, storage_buffer(false))];
        let mask_bindings = [
            (0, uniform()),
            (8, uint_texture()),
            (18, storage_texture(FORMAT)),
            (19, storage_buffer(false)),
            (20, storage_buffer(false)),
        ];
        Self {
            key: ComputeShader::with_bindings(device, "repair_key_pass", key, &key_bindings),
            threshold: ComputeShader::with_bindings(device, "repair_threshold_pass", threshold, &threshold_bindings),
            mask: ComputeShader::with_bindings(device, "repair_mask_pass", mask, &mask_bindings),
            quads: Quads::new(device, desc, repair),
            absent: Placeholders::new(device, HistoryLayout::Kept { noisy: false, means: false }),
            planned: None,
        }
    }

    /// Follows a change of the context's size or of the budget.
    pub fn update(&mut self, device: &Device, desc: &ContextDesc, repair: Repair) {
        self.quads = Quads::new(device, desc, repair);
        self.planned = None;
    }

    /// Compiles the pipelines of a variant.
    pub fn prewarm(&self, device: &Device, desc: &ContextDesc, variant: Variant) {
        self.key.pipeline(device, &overrides(desc, variant));
        self.threshold.pipeline(device, &[]);
        self.mask.pipeline(device, &[]);
    }

    /// Shader and override values of each compiled pipeline.
    pub fn pipelines(&self) -> impl Iterator<Item = (&'static str, Overrides)> + '_ {
        [&self.key, &self.threshold, &self.mask].into_iter().flat_map(ComputeShader::pipelines)
    }

    pub fn mask(&self) -> &Texture {
        &self.quads.mask
    }

    pub fn mask_view(&self) -> &TextureView {
        &self.quads.mask_view
    }

    /// List of the chosen quads of a view.
    pub fn list(&self, view: usize) -> Option<&Buffer> {
        self.quads.lists.get(view)
    }

    /// Clears the counts of the last frame.
    pub fn clear(&self, encoder: &mut CommandEncoder) {
        self.quads.states.iter().for_each(|state| encoder.clear_buffer(state, 0, None));
    }

    /// Records the passes of a frame.
    pub fn record(&self, device: &Device, pass: &mut ComputePass<'_>, job: &Job<'_>) {
        let Some(lattices) = &job.lattices else { return };
        let size = size_quads(job.desc);
        let budget = [self.quads.budget, 0, 0, 0];
        let budget = filled(device, "afterimage uniforms", bytemuck::bytes_of(&budget), BufferUsages::UNIFORM);
        for view in 0..job.frame.views.len() {
            let (state, list) = (&self.quads.states[view], &self.quads.lists[view]);
            let group = self.key_group(device, job, lattices, view);
            self.key.dispatch(device, pass, &overrides(job.desc, job.variant), &group, size, 1);

            let group = self
                .threshold
                .group(device, [budget.as_entire_binding(), state.as_entire_binding(), list.as_entire_binding()]);
            self.threshold.dispatch(device, pass, &[], &group, [1, 1], 1);

            let quads = [size[0], size[1], view as u32, 0];
            let quads = filled(device, "afterimage uniforms", bytemuck::bytes_of(&quads), BufferUsages::UNIFORM);
            let resources = [
                quads.as_entire_binding(),
                BindingResource::TextureView(&self.quads.keys),
                BindingResource::TextureView(&self.quads.mask_view),
                state.as_entire_binding(),
                list.as_entire_binding(),
            ];
            let group = self.mask.group(device, resources);
            self.mask.dispatch(device, pass, &[], &group, size, 1);
        }
    }

    fn key_group(&self, device: &Device, job: &Job<'_>, lattices: &Buffer, view: usize) -> wgpu::BindGroup {
        let first = view as u32;
        let batch = Batch { views: first..first + 1, regions: job.variant.regions };
        let inputs = [job.frame.depth, job.frame.motion, job.frame.trust]
            .map(|textures| textures.map_or_else(|| self.absent.float.clone(), |textures| textures.bind(&batch)));
        let uniforms = job.uniforms.buffer(device, first, 0);
        let past = job.history.split().0;
        let resources = std::iter::once(uniforms.as_entire_binding())
            .chain(inputs.iter().map(BindingResource::TextureView))
            .chain([
                BindingResource::TextureView(&past.views[0]),
                lattices.as_entire_binding(),
                BindingResource::TextureView(&self.quads.keys),
                self.quads.states[view].as_entire_binding(),
                past.frame.as_entire_binding(),
            ]);
        self.key.group(device, resources)
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
    let [columns, rows] = size_quads(desc).map(u64::from);
    let images = 2 * u64::from(FORMAT.block_copy_size(None).unwrap_or(0)) * columns * rows;
    u64::from(desc.view_count) * (images + STATE_BYTES + list_bytes(desc, repair))
}

/// Override values of the pass over the keys.
fn overrides(desc: &ContextDesc, variant: Variant) -> Overrides {
    let mut list = input_overrides(desc, variant);
    list.push(("ANTIALIAS", u32::from(smr_sparse_antialiases(&desc.settings))));
    list
}
