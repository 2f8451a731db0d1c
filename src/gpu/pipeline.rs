//! Pipelines: one shader, specialised by `override` constants to what a frame brings and what the settings ask for.

use super::Frame;
use super::bindings::Bindings;
use super::desc::GpuDesc;
use crate::error::CreateError;
use crate::foveation::Filter;
use crate::kernel::debug_view::DebugView;
use crate::kernel::wrs::GateCode;
use crate::settings::{Method, Settings};
use std::collections::HashMap;
use wgpu::{
    ComputePipeline, ComputePipelineDescriptor, Device, PipelineCompilationOptions, PipelineLayout,
    PipelineLayoutDescriptor, ShaderModule, ShaderModuleDescriptor, ShaderSource,
};

/// What a pipeline is specialised to. Absent inputs are switched off, not read as zeros.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct Variant {
    method: Method,
    copy_only: bool,
    has_depth: bool,
    has_motion: bool,
    has_trust: bool,
    has_exposure: bool,
    depth_test: bool,
    keys: bool,
    bias: u32,
    gate: u32,
    has_lod: bool,
    filter: Filter,
    relight: bool,
    noisy: bool,
    count: bool,
    view: Option<DebugView>,
}

impl Variant {
    pub fn new(settings: &Settings, frame: &Frame<'_>) -> Self {
        let has_depth = frame.depth.is_some();
        let params = settings.wrs_params();
        Self {
            method: settings.method,
            copy_only: false,
            has_depth,
            has_motion: frame.motion.is_some(),
            has_trust: frame.trust.is_some(),
            has_exposure: frame.exposure.factor().is_some(),
            depth_test: has_depth && settings.depth_test.is_some(),
            keys: settings.uses_keys(),
            bias: params.bias as u32,
            gate: if settings.gate.is_some() { params.gate as u32 } else { GateCode::Off as u32 },
            has_lod: frame.lod.is_some(),
            // Noise is more than what point samples alias.
            filter: match settings.foveation.filter {
                Filter::Block if settings.noisy => Filter::Mip,
                filter => filter,
            },
            relight: settings.smr.relight,
            noisy: settings.noisy,
            count: frame.counters.is_some(),
            view: None,
        }
    }

    /// The pass that moves the same bytes as the method with depth and motion, and computes nothing.
    pub fn copy(settings: &Settings, frame: &Frame<'_>) -> Self {
        Self { copy_only: true, count: false, ..Self::new(settings, frame) }
    }

    /// The pass that shows what would be decided, and stores nothing.
    pub fn view(settings: &Settings, frame: &Frame<'_>, view: DebugView) -> Self {
        Self { view: Some(view), ..Self::new(settings, frame) }
    }

    /// Whether an invocation takes a block of 2x2 pixels.
    pub fn takes_blocks(self) -> bool {
        self.method == Method::Smr
    }

    /// Whether it only shows what would be decided.
    pub fn is_view(self) -> bool {
        self.view.is_some()
    }

    /// Values of the shader's overrides.
    fn constants(self) -> Vec<(&'static str, f64)> {
        let flag = |on: bool| f64::from(u8::from(on));
        let mut list = vec![
            ("HAS_DEPTH", flag(self.has_depth)),
            ("HAS_MOTION", flag(self.has_motion)),
            ("HAS_TRUST", flag(self.has_trust)),
            ("HAS_EXPOSURE", flag(self.has_exposure)),
            ("DEPTH_TEST", flag(self.depth_test)),
            ("NOISY", flag(self.noisy)),
            ("COUNT", flag(self.count)),
            ("VIEW", self.view.map_or(0.0, |v| f64::from(v as u32))),
        ];
        match self.method {
            Method::None | Method::Wrs => list.extend([
                ("PASS_THROUGH", flag(self.method == Method::None)),
                ("COPY_ONLY", flag(self.copy_only)),
                ("SAMPLER", flag(self.keys)),
                ("BIAS", f64::from(self.bias)),
                ("GATE", f64::from(self.gate)),
            ]),
            Method::Taa => {}
            Method::Smr => list.extend([
                ("HAS_LOD", flag(self.has_lod)),
                ("FILTER", f64::from(self.filter as u32)),
                ("RELIGHT_ON", flag(self.relight)),
            ]),
        }
        list
    }
}

/// Name of the pass of a method.
pub fn pass_name(method: Method) -> &'static str {
    match method {
        Method::None | Method::Wrs => "wrs_pass",
        Method::Taa => "taa_pass",
        Method::Smr => "smr_pass",
    }
}

/// The shader, and the pipelines made of it so far.
#[derive(Debug)]
pub(super) struct Pipelines {
    layout: PipelineLayout,
    module: ShaderModule,
    made: HashMap<Variant, ComputePipeline>,
}

impl Pipelines {
    pub fn new(device: &Device, desc: &GpuDesc, bindings: &Bindings, source: &str) -> Result<Self, CreateError> {
        // The texel format of a storage texture is part of the text in WGSL.
        let source = source.replace(
            "color_out: texture_storage_2d_array<rgba16float",
            &format!("color_out: texture_storage_2d_array<{}", desc.output_texel()?),
        );
        let module = device.create_shader_module(ShaderModuleDescriptor {
            label: Some("afterimage"),
            source: ShaderSource::Wgsl(source.into()),
        });
        let layout = device.create_pipeline_layout(&PipelineLayoutDescriptor {
            label: Some("afterimage"),
            bind_group_layouts: &[Some(&bindings.layout)],
            ..PipelineLayoutDescriptor::default()
        });
        Ok(Self { layout, module, made: HashMap::new() })
    }

    /// The pipeline of a variant, made at its first use.
    pub fn get(&mut self, device: &Device, variant: Variant) -> &ComputePipeline {
        self.made.entry(variant).or_insert_with(|| {
            device.create_compute_pipeline(&ComputePipelineDescriptor {
                label: Some("afterimage"),
                layout: Some(&self.layout),
                module: &self.module,
                entry_point: Some("main"),
                compilation_options: PipelineCompilationOptions {
                    constants: &variant.constants(),
                    // Only counting has memory of the workgroup's; zeroing it means waiting for each other.
                    zero_initialize_workgroup_memory: variant.count,
                },
                cache: None,
            })
        })
    }
}
