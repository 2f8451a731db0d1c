//! What the pass is bound to, in the order of `shaders/pass/wrs_pass.wgsl`; stand-ins for what a frame does not bring.

use super::Frame;
use super::history::{History, array_view};
use super::types::FrameConstants;
use crate::stats::COUNTERS_BYTES;
use wgpu::{
    BindGroup, BindGroupDescriptor, BindGroupEntry, BindGroupLayout, BindGroupLayoutDescriptor, BindGroupLayoutEntry,
    BindingResource, BindingType, Buffer, BufferBinding, BufferBindingType, BufferUsages, BufferViewMut, Device,
    ShaderStages, StorageTextureAccess, Texture, TextureFormat, TextureSampleType, TextureUsages, TextureView,
    TextureViewDimension,
};

/// Layout of the bindings, and stand-ins: 1x1 textures and a buffer that no specialised shader touches.
#[derive(Debug)]
pub(super) struct Bindings {
    pub layout: BindGroupLayout,
    no_float: TextureView,
    no_key_out: TextureView,
    no_counters: Buffer,
}

impl Bindings {
    pub fn new(device: &Device, output: TextureFormat) -> Self {
        let layout = device.create_bind_group_layout(&BindGroupLayoutDescriptor {
            label: Some("afterimage wrs"),
            entries: &layout_entries(output),
        });
        let no_counters = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("afterimage absent counters"),
            size: COUNTERS_BYTES,
            usage: BufferUsages::STORAGE,
            mapped_at_creation: false,
        });
        Self {
            layout,
            no_float: stand_in(device, TextureUsages::TEXTURE_BINDING),
            no_key_out: stand_in(device, TextureUsages::STORAGE_BINDING),
            no_counters,
        }
    }

    /// The bindings of one frame. Constants get a buffer of their own, so that several frames in one submission see theirs.
    pub fn group(
        &self,
        device: &Device,
        frame: &Frame<'_>,
        constants: &FrameConstants,
        history: &History,
    ) -> BindGroup {
        let constants = uniform(device, bytemuck::bytes_of(constants));
        let optional = |texture: Option<&Texture>| texture.map_or_else(|| self.no_float.clone(), array_view);
        let inputs = [
            array_view(frame.color),
            optional(frame.depth),
            optional(frame.motion),
            optional(frame.trust),
            array_view(frame.output),
        ];
        let [color, depth, motion, trust, output] = &inputs;
        let (past, next) = history.split();
        let textures = [
            color,
            depth,
            motion,
            trust,
            &past.views[0],
            &past.views[1],
            past.views.get(2).unwrap_or(&self.no_float),
            &next.views[0],
            &next.views[1],
            next.views.get(2).unwrap_or(&self.no_key_out),
            output,
        ];
        let counters = BindingResource::Buffer(BufferBinding {
            buffer: frame.counters.unwrap_or(&self.no_counters),
            offset: 0,
            size: std::num::NonZeroU64::new(COUNTERS_BYTES),
        });
        let resources = std::iter::once(constants.as_entire_binding())
            .chain(textures.into_iter().map(BindingResource::TextureView))
            .chain([counters]);
        let entries: Vec<_> =
            (0..).zip(resources).map(|(binding, resource)| BindGroupEntry { binding, resource }).collect();
        device.create_bind_group(&BindGroupDescriptor {
            label: Some("afterimage wrs"),
            layout: &self.layout,
            entries: &entries,
        })
    }
}

/// A buffer of its own for the constants of one frame. Not by wgpu's `create_buffer_init`, which panics on a lost device (H77).
fn uniform(device: &Device, bytes: &[u8]) -> Buffer {
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("afterimage constants"),
        size: bytes.len() as u64,
        usage: BufferUsages::UNIFORM,
        mapped_at_creation: true,
    });
    if buffer.slice(..).get_mapped_range_mut().fill(bytes) {
        buffer.unmap();
    }
    buffer
}

/// What mapping gives: a view with wgpu 29; with wgpu 30 a result, an error on a lost device.
trait Mapped {
    /// Whether there is something to write to.
    fn fill(self, bytes: &[u8]) -> bool;
}

impl Mapped for BufferViewMut {
    fn fill(mut self, bytes: &[u8]) -> bool {
        self.copy_from_slice(bytes);
        true
    }
}

impl<E> Mapped for Result<BufferViewMut, E> {
    fn fill(self, bytes: &[u8]) -> bool {
        self.is_ok_and(|view| view.fill(bytes))
    }
}

fn stand_in(device: &Device, usage: TextureUsages) -> TextureView {
    array_view(&device.create_texture(&wgpu::TextureDescriptor {
        label: Some("afterimage absent input"),
        size: wgpu::Extent3d::default(),
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: TextureFormat::R32Float,
        usage,
        view_formats: &[],
    }))
}

fn layout_entries(output: TextureFormat) -> Vec<BindGroupLayoutEntry> {
    let float = TextureSampleType::Float { filterable: false };
    let sampled = |sample_type| BindingType::Texture {
        sample_type,
        view_dimension: TextureViewDimension::D2Array,
        multisampled: false,
    };
    let storage = |format| BindingType::StorageTexture {
        access: StorageTextureAccess::WriteOnly,
        format,
        view_dimension: TextureViewDimension::D2Array,
    };
    let buffer = |ty| BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None };
    let types = [
        buffer(BufferBindingType::Uniform),
        sampled(float),
        sampled(float),
        sampled(float),
        sampled(float),
        sampled(TextureSampleType::Uint),
        sampled(TextureSampleType::Uint),
        sampled(float),
        storage(TextureFormat::Rg32Uint),
        storage(TextureFormat::R32Uint),
        storage(TextureFormat::R32Float),
        storage(output),
        buffer(BufferBindingType::Storage { read_only: false }),
    ];
    (0..)
        .zip(types)
        .map(|(binding, ty)| BindGroupLayoutEntry { binding, visibility: ShaderStages::COMPUTE, ty, count: None })
        .collect()
}
