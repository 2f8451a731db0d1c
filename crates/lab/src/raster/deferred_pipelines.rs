//! Pipelines of deferred frames.

use super::pipelines::{COLOR_FORMAT, Layouts, MOTION_FORMAT, Recipe, lighting_constants, point_constants, shader};
use super::targets::KEPT_FORMATS;
use super::vertices::AlphaKind;
use crate::scene::effects::Effects;
use std::cell::OnceCell;
use wgpu::{
    BindGroupLayout, ColorWrites, CompareFunction, ComputePipeline, Device, PipelineCompilationOptions, RenderPipeline,
    ShaderModule, TextureView,
};

/// What deferred frames of a scene need.
#[derive(Debug)]
pub(super) struct Deferred {
    pub pipelines: DeferredPipelines,
    /// What lighting needs of the materials ([`texels`](super::materials::texels)).
    pub materials: TextureView,
}

/// Pipelines of deferred frames: surfaces into the G-buffer, and lighting that reads it.
#[derive(Debug)]
pub(super) struct DeferredPipelines {
    surfaces: [RenderPipeline; 2],
    /// Motion of the sky.
    pub far: RenderPipeline,
    /// Lights all pixels of a window.
    pub light_all: ComputePipeline,
    /// Lights the quads of a list; group 3 is the list.
    pub light_quads: ComputePipeline,
    lighting: ShaderModule,
    /// `None` before the first frame that asks for albedo.
    albedo: OnceCell<ComputePipeline>,
    /// Gives the quads of a list the depth of the opaque surfaces, for blended ones.
    pub quads: RenderPipeline,
}

impl DeferredPipelines {
    pub fn new(device: &Device, layouts: &Layouts, effects: Effects, has_sun: bool) -> Self {
        let [kept, surface, quads] = ["g_buffer_pass", "surface_pass", "quads_pass"].map(|name| shader(device, name));
        let two = [Some(&layouts.frame), Some(&layouts.material)];
        let constants = point_constants(effects);
        let [others, none] =
            [ColorWrites::ALL, ColorWrites::empty()].map(|writes| KEPT_FORMATS.map(|format| (format, writes)));
        let keep = |fragment| {
            let recipe = Recipe::new(&kept, "keep_vertex", Some(fragment), MOTION_FORMAT);
            Recipe { constants: &constants, others: &others, ..recipe }.make(device, &two)
        };
        let far = Recipe::new(&surface, "fullscreen", Some("motion_far"), MOTION_FORMAT);
        let closed = Recipe {
            vertices: false,
            compare: CompareFunction::Always,
            writes: ColorWrites::empty(),
            ..Recipe::new(&quads, "quad", Some("opaque_depth"), COLOR_FORMAT)
        };
        let lighting = shader(device, "lighting_pass");
        let light = |entry| compute(device, layouts, (&lighting, entry), effects, has_sun);
        Self {
            surfaces: [keep("keep_opaque"), keep("keep")],
            far: Recipe { others: &none, depth: false, vertices: false, ..far }.make(device, &two),
            light_all: light("light_all"),
            light_quads: light("light_quads"),
            lighting,
            albedo: OnceCell::new(),
            quads: closed.make(device, &[Some(&layouts.frame), Some(&layouts.quads), Some(&layouts.opaque_depth)]),
        }
    }

    /// Surfaces of an opaque or alpha-tested kind.
    pub fn surfaces(&self, kind: AlphaKind) -> &RenderPipeline {
        &self.surfaces[usize::from(kind != AlphaKind::Opaque)]
    }

    /// Albedo of all pixels.
    pub fn albedo(&self, device: &Device, layouts: &Layouts, effects: Effects) -> &ComputePipeline {
        self.albedo.get_or_init(|| compute(device, layouts, (&self.lighting, "albedo_all"), effects, false))
    }
}

/// A pipeline of `lighting_pass`.
fn compute(
    device: &Device,
    layouts: &Layouts,
    (module, entry): (&ShaderModule, &str),
    effects: Effects,
    has_sun: bool,
) -> ComputePipeline {
    let groups: [Option<&BindGroupLayout>; 4] =
        [&layouts.frame, &layouts.g_buffer, &layouts.lighting_maps, &layouts.quads].map(Some);
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(entry),
        bind_group_layouts: if entry == "light_quads" { &groups } else { &groups[..3] },
        ..Default::default()
    });
    let constants: Vec<_> = lighting_constants(effects, has_sun).collect();
    device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some(entry),
        layout: Some(&layout),
        module,
        entry_point: Some(entry),
        compilation_options: PipelineCompilationOptions { constants: &constants, ..Default::default() },
        cache: None,
    })
}
