//! Pass of a method: its bindings, and its pipelines, specialised to the inputs of a frame and to the settings.
//!
//! The first bindings are shared by all methods, in the order of `shaders/pass/inputs.wgsl`; the history's follow, in
//! the order of the method's shader. Absent inputs are switched off by `override` constants and bound to placeholders,
//! which a specialised shader does not read.

use super::Frame;
use super::buffer::filled;
use super::compute::{ComputeShader, float_texture, storage_buffer, storage_texture, uint_texture, uniform};
use super::frame::Target;
use super::history::{History, array_view};
use super::uniforms::FrameUniforms;
use crate::kernel::debug_view::DebugView;
use crate::method::{HistoryLayout, Overrides};
use crate::settings::{Method, Settings};
use crate::stats::COUNTERS_BYTES;
use wgpu::{
    BindGroup, BindingResource, BindingType, Buffer, BufferBinding, BufferUsages, ComputePass, Device, Texture,
    TextureFormat, TextureUsages, TextureView,
};

/// The pass, with placeholders for absent inputs: 1x1 textures and a buffer.
#[derive(Debug)]
pub(super) struct MethodPass {
    shader: ComputeShader,
    method: Method,
    history: HistoryLayout,
    no_float: TextureView,
    no_word: TextureView,
    no_out: [TextureView; 3],
    no_counters: Buffer,
}

impl MethodPass {
    /// The pass of the WGSL text `source`, for outputs of format `output`.
    pub fn new(device: &Device, settings: &Settings, output: TextureFormat, source: &str) -> Self {
        let history = settings.history_layout();
        let no_counters = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("afterimage absent counters"),
            size: COUNTERS_BYTES,
            usage: BufferUsages::STORAGE,
            mapped_at_creation: false,
        });
        Self {
            shader: ComputeShader::new(device, "afterimage", writing(source, output), &binding_types(output, history)),
            method: settings.method,
            history,
            no_float: stand_in(device, TextureFormat::R32Float, TextureUsages::TEXTURE_BINDING),
            no_word: stand_in(device, TextureFormat::Rg32Uint, TextureUsages::TEXTURE_BINDING),
            no_out: written(history).map(|format| stand_in(device, format, TextureUsages::STORAGE_BINDING)),
            no_counters,
        }
    }

    /// Method of the pass.
    pub fn method(&self) -> Method {
        self.method
    }

    /// Records the pass.
    #[allow(clippy::too_many_arguments, reason = "a struct for one call would only move the list")]
    pub fn record(
        &self,
        device: &Device,
        pass: &mut ComputePass<'_>,
        settings: &Settings,
        frame: &Frame<'_>,
        target: &Target<'_>,
        view: Option<DebugView>,
        uniforms: &FrameUniforms,
        history: &History,
    ) {
        let group = self.group(device, frame, target, uniforms, history);
        let blocks = uniforms.size.map(|s| s.div_ceil(self.method.entry().block_px));
        let overrides = overrides(settings, frame, target.counters.is_some(), view);
        self.shader.dispatch(device, pass, &overrides, &group, blocks, frame.views.len() as u32);
    }

    /// Bind group of one frame. Each frame has its own buffer of uniforms, so that one submission can contain several
    /// frames.
    fn group(
        &self,
        device: &Device,
        frame: &Frame<'_>,
        target: &Target<'_>,
        uniforms: &FrameUniforms,
        history: &History,
    ) -> BindGroup {
        let uniforms = filled(device, "afterimage uniforms", bytemuck::bytes_of(uniforms), BufferUsages::UNIFORM);
        let optional = |texture: Option<&Texture>| texture.map_or_else(|| self.no_float.clone(), array_view);
        let inputs = [
            array_view(frame.color),
            optional(frame.depth),
            optional(frame.motion),
            optional(frame.trust),
            array_view(target.output),
        ];
        let (lod, noise) = (optional(frame.lod), optional(frame.noise));
        let (past, next) = history.split();
        let (past, next) = (&past.views, &next.targets);
        let candidates = history.candidates().map_or(&self.no_float, |c| &c.view);
        let past_or = |i: usize, absent| past.get(i).unwrap_or(absent);
        let next_or = |i: usize| next.get(i).unwrap_or(&self.no_out[i]);
        let history_views = match self.history {
            HistoryLayout::Nothing => vec![],
            HistoryLayout::Reservoirs { .. } => vec![
                past_or(0, &self.no_word),
                past_or(1, &self.no_word),
                past_or(2, &self.no_float),
                next_or(0),
                next_or(1),
                next_or(2),
            ],
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
        };
        let counters = BindingResource::Buffer(BufferBinding {
            buffer: target.counters.unwrap_or(&self.no_counters),
            offset: 0,
            size: std::num::NonZeroU64::new(COUNTERS_BYTES),
        });
        let resources = std::iter::once(uniforms.as_entire_binding())
            .chain(inputs.iter().map(BindingResource::TextureView))
            .chain([counters, BindingResource::TextureView(&noise)])
            .chain(history_views.into_iter().map(BindingResource::TextureView));
        self.shader.group(device, resources)
    }
}

/// Override values of a pass: those of `shaders/pass/inputs.wgsl`, then the method's own.
fn overrides(settings: &Settings, frame: &Frame<'_>, count: bool, view: Option<DebugView>) -> Overrides {
    let flag = u32::from;
    let mut list = vec![
        ("HAS_DEPTH", flag(frame.depth.is_some())),
        ("HAS_MOTION", flag(frame.motion.is_some())),
        ("HAS_TRUST", flag(frame.trust.is_some())),
        ("HAS_EXPOSURE", flag(frame.exposure.factor().is_some())),
        ("DEPTH_TEST", flag(frame.depth.is_some() && settings.depth_test.is_some())),
        ("NOISY", flag(settings.noisy)),
        ("COUNT", flag(count)),
        ("VIEW", view.map_or(0, |v| v as u32)),
    ];
    list.extend((settings.method.entry().overrides)(settings, frame.lod.is_some()));
    list
}

/// Shader text for outputs of format `output`: in WGSL the texel format of a storage texture is part of its type.
fn writing(source: &str, output: TextureFormat) -> String {
    let texel = super::output::texel(output).expect("the output format was checked");
    source.replace(
        "color_out: texture_storage_2d_array<rgba16float",
        &format!("color_out: texture_storage_2d_array<{texel}"),
    )
}

/// Formats of the history textures that a pass writes.
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

fn binding_types(output: TextureFormat, history: HistoryLayout) -> Vec<BindingType> {
    let (float, words) = (float_texture(), uint_texture());
    let [first, second, third] = written(history).map(storage_texture);
    let mut types = vec![uniform(), float, float, float, float, storage_texture(output), storage_buffer(false), float];
    types.extend(match history {
        HistoryLayout::Nothing => vec![],
        HistoryLayout::Reservoirs { .. } => vec![words, words, float, first, second, third],
        HistoryLayout::Surfaces { .. } => vec![float, words, float, first, second, words, float, third],
    });
    types
}
