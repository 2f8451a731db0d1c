//! What a pass is bound to: first what all passes share, in the order of `shaders/pass/inputs.wgsl`, then the history, in the order of the
//! method's pass; stand-ins for what a frame does not bring.

use super::Frame;
use super::filled;
use super::history::{History, array_view};
use super::types::FrameConstants;
use crate::settings::HistoryLayout;
use crate::stats::COUNTERS_BYTES;
use wgpu::{
    BindGroup, BindGroupDescriptor, BindGroupEntry, BindGroupLayout, BindGroupLayoutDescriptor, BindGroupLayoutEntry,
    BindingResource, BindingType, Buffer, BufferBinding, BufferBindingType, BufferUsages, Device, ShaderStages,
    StorageTextureAccess, Texture, TextureFormat, TextureSampleType, TextureUsages, TextureView, TextureViewDimension,
};

/// Layout of the bindings, and stand-ins: 1x1 textures and a buffer that no specialised shader touches.
#[derive(Debug)]
pub(super) struct Bindings {
    pub layout: BindGroupLayout,
    history: HistoryLayout,
    no_float: TextureView,
    no_word: TextureView,
    no_out: [TextureView; 3],
    no_counters: Buffer,
}

impl Bindings {
    pub fn new(device: &Device, output: TextureFormat, history: HistoryLayout) -> Self {
        let layout = device.create_bind_group_layout(&BindGroupLayoutDescriptor {
            label: Some("afterimage"),
            entries: &layout_entries(output, history),
        });
        let no_counters = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("afterimage absent counters"),
            size: COUNTERS_BYTES,
            usage: BufferUsages::STORAGE,
            mapped_at_creation: false,
        });
        Self {
            layout,
            history,
            no_float: stand_in(device, TextureFormat::R32Float, TextureUsages::TEXTURE_BINDING),
            no_word: stand_in(device, TextureFormat::Rg32Uint, TextureUsages::TEXTURE_BINDING),
            no_out: written(history).map(|format| stand_in(device, format, TextureUsages::STORAGE_BINDING)),
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
        let constants = filled(device, "afterimage constants", bytemuck::bytes_of(constants), BufferUsages::UNIFORM);
        let optional = |texture: Option<&Texture>| texture.map_or_else(|| self.no_float.clone(), array_view);
        let inputs = [
            array_view(frame.color),
            optional(frame.depth),
            optional(frame.motion),
            optional(frame.trust),
            array_view(frame.output),
        ];
        let (lod, noise) = (optional(frame.lod), optional(frame.noise));
        let (past, next) = history.split();
        let (past, next) = (&past.views, &next.targets);
        let candidates = history.candidates().map_or(&self.no_float, |c| &c.view);
        let past_or = |i: usize, absent| past.get(i).unwrap_or(absent);
        let next_or = |i: usize| next.get(i).unwrap_or(&self.no_out[i]);
        let remembered = match self.history {
            HistoryLayout::Surfaces { .. } => vec![
                &lod,
                past_or(0, &self.no_word),
                past_or(1, &self.no_float),
                next_or(0),
                next_or(1),
                past_or(2, &self.no_word),
                candidates,
                next_or(2),
            ],
            _ => vec![
                past_or(0, &self.no_word),
                past_or(1, &self.no_word),
                past_or(2, &self.no_float),
                next_or(0),
                next_or(1),
                next_or(2),
            ],
        };
        let counters = BindingResource::Buffer(BufferBinding {
            buffer: frame.counters.unwrap_or(&self.no_counters),
            offset: 0,
            size: std::num::NonZeroU64::new(COUNTERS_BYTES),
        });
        let resources = std::iter::once(constants.as_entire_binding())
            .chain(inputs.iter().map(BindingResource::TextureView))
            .chain([counters, BindingResource::TextureView(&noise)])
            .chain(remembered.into_iter().map(BindingResource::TextureView));
        let entries: Vec<_> =
            (0..).zip(resources).map(|(binding, resource)| BindGroupEntry { binding, resource }).collect();
        device.create_bind_group(&BindGroupDescriptor {
            label: Some("afterimage"),
            layout: &self.layout,
            entries: &entries,
        })
    }
}

/// Formats of what a pass writes for the next frame.
fn written(history: HistoryLayout) -> [TextureFormat; 3] {
    match history {
        HistoryLayout::Surfaces { .. } => [TextureFormat::Rg32Uint, TextureFormat::Rgba16Float, TextureFormat::R32Uint],
        _ => [TextureFormat::Rg32Uint, TextureFormat::R32Uint, TextureFormat::R32Float],
    }
}

fn stand_in(device: &Device, format: TextureFormat, usage: TextureUsages) -> TextureView {
    array_view(&device.create_texture(&wgpu::TextureDescriptor {
        label: Some("afterimage absent input"),
        size: wgpu::Extent3d::default(),
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    }))
}

fn layout_entries(output: TextureFormat, history: HistoryLayout) -> Vec<BindGroupLayoutEntry> {
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
    let words = sampled(TextureSampleType::Uint);
    let [first, second, third] = written(history).map(storage);
    let mut types = vec![
        buffer(BufferBindingType::Uniform),
        sampled(float),
        sampled(float),
        sampled(float),
        sampled(float),
        storage(output),
        buffer(BufferBindingType::Storage { read_only: false }),
        sampled(float),
    ];
    types.extend(match history {
        HistoryLayout::Surfaces { .. } => {
            vec![sampled(float), words, sampled(float), first, second, words, sampled(float), third]
        }
        _ => vec![words, words, sampled(float), first, second, third],
    });
    (0..)
        .zip(types)
        .map(|(binding, ty)| BindGroupLayoutEntry { binding, visibility: ShaderStages::COMPUTE, ty, count: None })
        .collect()
}
