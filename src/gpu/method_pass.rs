//! Pass of a method: its bindings, and its pipelines, specialised to the inputs of a frame and to the settings.
//!
//! The first bindings are shared by all methods, in the order of `shaders/pass/inputs.wgsl`; the history's follow, in
//! the order of the method's shader. Absent inputs are switched off by `override` constants and bound to placeholders,
//! which a specialised shader does not read.

use super::compute::{ComputeShader, float_texture, storage_buffer, storage_texture, uint_texture, uniform};
use super::history::array_view;
use super::output::DEBUG_FORMAT;
use super::stage::{Job, Passes};
use super::textures::{Batch, batches};
use super::{Textures, Variant};
use crate::frame::ContextDesc;
use crate::kernel::debug_view::DebugView;
use crate::method::{HistoryLayout, Overrides, PassShader};
use crate::settings::Settings;
use crate::shader::SHADERS;
use crate::stats::FrameStats;
use std::sync::OnceLock;
use wgpu::{
    BindGroup, BindingResource, BindingType, Buffer, BufferBinding, BufferUsages, ComputePass, Device, TextureFormat,
    TextureUsages, TextureView,
};

/// Binding number of the debug view in `shaders/pass/output_and_view.wgsl`.
const DEBUG_BINDING: u32 = 16;
/// Binding number of the lattices in `shaders/pass/lattices.wgsl`.
const LATTICES_BINDING: u32 = 17;
/// Binding number of the stored frame's number in `shaders/pass/past_frame.wgsl`.
pub(super) const PAST_FRAME_BINDING: u32 = 21;

/// The pass, with placeholders for absent inputs.
#[derive(Debug)]
pub(super) struct MethodPass {
    shader: ComputeShader,
    /// The pass that also writes a debug view; made at its first use.
    with_view: OnceLock<ComputeShader>,
    pass_shader: PassShader,
    history: HistoryLayout,
    output: TextureFormat,
    absent: Placeholders,
    no_counters: Buffer,
}

/// Placeholders for absent textures: 1x1.
#[derive(Debug)]
pub(super) struct Placeholders {
    pub float: TextureView,
    pub word: TextureView,
    /// Placeholders for the history textures of [`written`].
    pub out: [TextureView; 3],
}

impl Placeholders {
    pub fn new(device: &Device, history: HistoryLayout) -> Self {
        Self {
            float: stand_in(device, TextureFormat::R32Float, TextureUsages::TEXTURE_BINDING),
            word: stand_in(device, TextureFormat::Rg32Uint, TextureUsages::TEXTURE_BINDING),
            out: written(history).map(|format| stand_in(device, format, TextureUsages::STORAGE_BINDING)),
        }
    }
}

impl MethodPass {
    /// The pass of the WGSL text `source`, for outputs of format `output`.
    pub fn new(device: &Device, settings: &Settings, output: TextureFormat, source: &str) -> Self {
        let history = settings.history_layout();
        let no_counters = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("afterimage absent counters"),
            size: FrameStats::COUNTERS_BYTES,
            usage: BufferUsages::STORAGE,
            mapped_at_creation: false,
        });
        Self {
            shader: ComputeShader::with_bindings(
                device,
                settings.pass_shader().name,
                writing(device, source, output),
                &bindings(settings.pass_shader(), output, history),
            ),
            with_view: OnceLock::new(),
            pass_shader: settings.pass_shader(),
            history,
            output,
            absent: Placeholders::new(device, history),
            no_counters,
        }
    }

    fn shader(&self, device: &Device, variant: Variant) -> &ComputeShader {
        if variant.debug.is_none() {
            return &self.shader;
        }
        self.with_view.get_or_init(|| {
            let source = SHADERS.compose_replacing(self.pass_shader.name, ("output", "output_and_view")).source;
            let mut bindings = bindings(self.pass_shader, self.output, self.history);
            bindings.push((DEBUG_BINDING, storage_texture(DEBUG_FORMAT)));
            let source = writing(device, &source, self.output);
            ComputeShader::with_bindings(device, self.pass_shader.name, source, &bindings)
        })
    }

    /// Bind group of a batch of views.
    fn group(&self, device: &Device, shader: &ComputeShader, job: &Job<'_>, batch: &Batch) -> BindGroup {
        let Job { frame, target, history, .. } = job;
        let uniforms = job.uniforms.buffer(device, batch.views.start, 0);
        let optional =
            |textures: Option<Textures<'_>>| textures.map_or_else(|| self.absent.float.clone(), |t| t.bind(batch));
        let inputs = [
            frame.color.bind(batch),
            optional(frame.depth),
            optional(frame.motion),
            optional(frame.trust),
            target.output.bind(batch),
        ];
        let [lod, noise, repaired] = [frame.lod, frame.noise, frame.repaired].map(optional);
        let debug = target.debug.map(|d| d.output.bind(batch));
        let (past, next) = history.split();
        let (past, next) = (&past.views, &next.targets);
        let candidates = history.candidates.as_ref().map_or(&self.absent.float, |c| &c.view);
        let past_or = |i: usize, absent| past.get(i).unwrap_or(absent);
        let next_or = |i: usize| next.get(i).unwrap_or(&self.absent.out[i]);
        let history_views = match self.history {
            HistoryLayout::Nothing => vec![],
            HistoryLayout::Reservoirs { .. } => vec![
                &lod,
                past_or(0, &self.absent.word),
                past_or(1, &self.absent.word),
                past_or(2, &self.absent.word),
                next_or(0),
                next_or(1),
                next_or(2),
            ],
            HistoryLayout::Kept { .. } => vec![
                past_or(0, &self.absent.word),
                next_or(0),
                job.lights.as_ref().unwrap_or(&self.absent.word),
                past_or(1, &self.absent.word),
                next.get(1).unwrap_or(&self.absent.out[2]),
                &repaired,
                job.repair_mask.unwrap_or(&self.absent.word),
            ],
            HistoryLayout::Surfaces { .. } => vec![
                &lod,
                past_or(0, &self.absent.word),
                past_or(1, &self.absent.float),
                next_or(0),
                next_or(1),
                past_or(2, &self.absent.word),
                candidates,
                next_or(2),
            ],
        };
        let lattices = job.lattices.as_ref().filter(|_| self.pass_shader.reads_samples);
        let past_frame = (self.history != HistoryLayout::Nothing).then(|| &history.split().0.frame);
        let counters = BindingResource::Buffer(BufferBinding {
            buffer: target.counters.unwrap_or(&self.no_counters),
            offset: 0,
            size: std::num::NonZeroU64::new(FrameStats::COUNTERS_BYTES),
        });
        let resources = std::iter::once(uniforms.as_entire_binding())
            .chain(inputs.iter().map(BindingResource::TextureView))
            .chain([counters, BindingResource::TextureView(&noise)])
            .chain(history_views.into_iter().map(BindingResource::TextureView))
            .chain(lattices.map(Buffer::as_entire_binding))
            .chain(past_frame.map(Buffer::as_entire_binding))
            .chain(debug.as_ref().map(BindingResource::TextureView));
        shader.group(device, resources)
    }
}

impl Passes for MethodPass {
    fn prewarm(&self, device: &Device, desc: &ContextDesc, variant: Variant) {
        self.shader(device, variant).pipeline(device, &overrides(desc, variant, None));
    }

    fn pipelines(&self) -> Vec<(&'static str, Overrides)> {
        [Some(&self.shader), self.with_view.get()].into_iter().flatten().flat_map(ComputeShader::pipelines).collect()
    }

    fn record<'a>(&'a self, device: &Device, pass: &mut ComputePass<'_>, job: &mut Job<'a>) {
        let variant = Variant::of(&job.frame, job.target);
        let shader = self.shader(device, variant);
        let blocks = job.uniforms.size.map(|s| s.div_ceil(self.pass_shader.block_px));
        let overrides = overrides(job.desc, variant, job.view);
        for batch in batches(job.frame.views.len(), variant.regions) {
            let group = self.group(device, shader, job, &batch);
            shader.dispatch(device, pass, &overrides, &group, blocks, batch.views.len() as u32);
        }
    }
}

/// Override values of a pass: those of `shaders/pass/{inputs,output}.wgsl`, then the method's own.
fn overrides(desc: &ContextDesc, variant: Variant, view: Option<DebugView>) -> Overrides {
    let flag = u32::from;
    let settings = &desc.settings;
    let mut list = input_overrides(desc, variant);
    list.extend([
        ("NOISY", flag(settings.noisy)),
        ("COUNT", flag(variant.counters)),
        ("VIEW", view.map_or(0, |v| v as u32)),
        ("KEEP_ALPHA", flag(desc.keep_alpha)),
    ]);
    list.extend(variant.debug.map(|v| ("DEBUG_VIEW", v as u32)));
    list.extend(settings.overrides(variant.lod));
    if matches!(settings.history_layout(), HistoryLayout::Kept { .. }) {
        list.push(("REPAIR", flag(variant.repaired)));
    }
    list
}

/// Which inputs the passes of a frame read.
pub(super) fn input_overrides(desc: &ContextDesc, variant: Variant) -> Overrides {
    let flag = u32::from;
    // The vectors of filled geometry contain the camera's motion.
    let is_filled = variant.geometry_at_samples;
    vec![
        ("HAS_DEPTH", flag(variant.depth)),
        ("HAS_MOTION", flag(variant.motion || is_filled && desc.motion.lacks_camera())),
        ("CAMERA_MOTION", if is_filled { 0 } else { desc.motion.camera_code() }),
        ("HAS_TRUST", flag(variant.trust)),
        ("DEPTH_TEST", flag(variant.depth && desc.settings.depth_test.is_some())),
        ("REGIONS", flag(variant.regions)),
    ]
}

/// Shader text for outputs of format `output`: in WGSL the texel format of a storage texture is part of its type.
fn writing(device: &Device, source: &str, output: TextureFormat) -> String {
    let texel = super::output::texel(device, output).expect("the output format was checked");
    source.replace(
        "color_out: texture_storage_2d_array<rgba16float",
        &format!("color_out: texture_storage_2d_array<{texel}"),
    )
}

/// Formats of the history textures that a pass writes.
pub(super) fn written(history: HistoryLayout) -> [TextureFormat; 3] {
    match history {
        HistoryLayout::Surfaces { .. } | HistoryLayout::Kept { .. } => {
            [TextureFormat::Rg32Uint, TextureFormat::Rgba16Float, TextureFormat::R32Uint]
        }
        _ => [TextureFormat::Rg32Uint, TextureFormat::R32Uint, TextureFormat::R32Uint],
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

/// Numbers and types of a pass's bindings.
fn bindings(pass: PassShader, output: TextureFormat, history: HistoryLayout) -> Vec<(u32, BindingType)> {
    let (float, words) = (float_texture(), uint_texture());
    let [first, second, third] = written(history).map(storage_texture);
    let mut types = vec![uniform(), float, float, float, float, storage_texture(output), storage_buffer(false), float];
    types.extend(match history {
        HistoryLayout::Nothing => vec![],
        HistoryLayout::Reservoirs { .. } => vec![float, words, words, words, first, second, third],
        HistoryLayout::Kept { .. } => vec![words, first, words, words, third, float, words],
        HistoryLayout::Surfaces { .. } => vec![float, words, float, first, second, words, float, third],
    });
    let lattices = pass.reads_samples.then(|| (LATTICES_BINDING, uniform()));
    let past_frame = (history != HistoryLayout::Nothing).then(|| (PAST_FRAME_BINDING, uniform()));
    (0..).zip(types).chain(lattices).chain(past_frame).collect()
}
