//! Render pipelines and bind group layouts.

use super::vertices::{AlphaKind, LAYOUTS};
use crate::scene::effects::{Effect, Effects};
use crate::shader::SHADERS;
use wgpu::{
    BindGroupLayout, BindGroupLayoutEntry, BindingType, BlendState, ColorTargetState, ColorWrites, CompareFunction,
    DepthBiasState, DepthStencilState, Device, RenderPipeline, ShaderModule, ShaderStages, TextureFormat,
    TextureSampleType, TextureViewDimension,
};

/// Format of linear color.
pub const COLOR_FORMAT: TextureFormat = TextureFormat::Rgba16Float;
/// Format of depth, reversed and without a far plane.
pub const DEPTH_FORMAT: TextureFormat = TextureFormat::Depth32Float;
/// Format of motion in pixels.
pub const MOTION_FORMAT: TextureFormat = TextureFormat::Rg32Float;

/// Samples per pixel of the color pass. Every device supports 4.
pub(super) const SAMPLES: u32 = 4;

/// Layouts of bind groups 0 to 2.
#[derive(Debug)]
pub(super) struct Layouts {
    pub frame: BindGroupLayout,
    pub material: BindGroupLayout,
    pub lighting_maps: BindGroupLayout,
    /// Group 1 of [`Pipelines::quads`].
    pub quads: BindGroupLayout,
    /// Group 1 of the lighting of a G-buffer.
    pub g_buffer: BindGroupLayout,
    /// Group 2 of [`DeferredPipelines::quads`](super::deferred_pipelines::DeferredPipelines::quads).
    pub opaque_depth: BindGroupLayout,
}

#[derive(Debug)]
pub(super) struct Pipelines {
    motion: [RenderPipeline; 2],
    pub motion_far: RenderPipeline,
    sun: [RenderPipeline; 2],
    /// Sets depth to the far plane in the quads of a list, for color passes with one sample per pixel.
    pub quads: RenderPipeline,
    /// With [`SAMPLES`] samples per pixel.
    pub color: ColorPipelines,
}

/// Pipelines of the color pass, with a number of samples per pixel.
#[derive(Debug)]
pub(super) struct ColorPipelines {
    surfaces: [RenderPipeline; 3],
    pub sky: RenderPipeline,
}

impl ColorPipelines {
    /// Color of a kind of surface.
    pub fn surfaces(&self, kind: AlphaKind) -> &RenderPipeline {
        &self.surfaces[kind as usize]
    }

    pub fn new(device: &Device, layouts: &Layouts, effects: Effects, has_sun: bool, samples: u32) -> Self {
        Self::of_kind(device, layouts, effects, has_sun, samples, false)
    }

    /// Pipelines that draw albedo instead of color, with one sample per pixel.
    pub fn albedo(device: &Device, layouts: &Layouts, effects: Effects) -> Self {
        Self::of_kind(device, layouts, effects, false, 1, true)
    }

    fn of_kind(
        device: &Device,
        layouts: &Layouts,
        effects: Effects,
        has_sun: bool,
        samples: u32,
        is_albedo: bool,
    ) -> Self {
        let [color, sky] = ["color_pass", "sky_pass"].map(|name| shader(device, name));
        let mut shading = point_constants(effects);
        shading.extend(lighting_constants(effects, has_sun));
        let albedo = [("ALBEDO", f64::from(u8::from(is_albedo)))];
        shading.extend(albedo);
        let mut tested = shading.clone();
        tested.push(("ALPHA_TEST", f64::from(u8::from(samples == 1))));
        let groups = [Some(&layouts.frame), Some(&layouts.material), Some(&layouts.lighting_maps)];
        let shade = |constants, depth, blend, coverage| {
            let recipe = Recipe {
                constants,
                depth,
                blend,
                coverage,
                samples,
                ..Recipe::new(&color, "shade_vertex", Some("shade"), COLOR_FORMAT)
            };
            recipe.make(device, &groups)
        };
        let blend = Some(BlendState::PREMULTIPLIED_ALPHA_BLENDING);
        let sky = Recipe {
            constants: &albedo,
            depth: false,
            vertices: false,
            samples,
            ..Recipe::new(&sky, "fullscreen", Some("sky"), COLOR_FORMAT)
        };
        Self {
            surfaces: [
                shade(&shading, true, None, false),
                shade(&tested, true, None, samples > 1),
                shade(&shading, false, blend, false),
            ],
            sky: sky.make(device, &groups),
        }
    }
}

/// Constants of `raster_point`: what textures say of a point.
pub(super) fn point_constants(effects: Effects) -> Vec<(&'static str, f64)> {
    let list = [
        ("BASE_COLOR_TEXTURE", Effect::BaseColor),
        ("SURFACE_TEXTURE", Effect::SurfaceTexture),
        ("NORMAL_MAP", Effect::NormalMap),
        ("EMISSIVE_TEXTURE", Effect::EmissiveTexture),
        ("TEXTURE_COORDINATES", Effect::TextureCoordinates),
    ];
    constants(effects, &list)
}

/// Constants of `raster_lighting`: how a point is lit.
pub(super) fn lighting_constants(effects: Effects, has_sun: bool) -> impl Iterator<Item = (&'static str, f64)> {
    effects.lobe_constants().chain([("HAS_SUN", f64::from(u8::from(has_sun)))])
}

pub(super) fn shader(device: &Device, name: &str) -> ShaderModule {
    device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(name),
        source: wgpu::ShaderSource::Wgsl(SHADERS.compose(name).source.into()),
    })
}

impl Pipelines {
    /// Depth and motion of a kind of surface.
    pub fn motion(&self, kind: AlphaKind) -> &RenderPipeline {
        &self.motion[usize::from(kind != AlphaKind::Opaque)]
    }

    /// Shadow map of a kind of surface.
    pub fn sun(&self, kind: AlphaKind) -> &RenderPipeline {
        &self.sun[usize::from(kind != AlphaKind::Opaque)]
    }

    pub fn new(device: &Device, layouts: &Layouts, effects: Effects, has_sun: bool) -> Self {
        let [surface, sun, quads] = ["surface_pass", "sun_pass", "quads_pass"].map(|name| shader(device, name));
        let coordinates = ("TEXTURE_COORDINATES", Effect::TextureCoordinates);
        let base = constants(effects, &[("BASE_COLOR_TEXTURE", Effect::BaseColor), coordinates]);
        let two = [Some(&layouts.frame), Some(&layouts.material)];
        let make = |recipe: Recipe<'_>| recipe.make(device, &two);
        let motion = |fragment, depth| {
            make(Recipe { constants: &base, depth, ..Recipe::new(&surface, "motion_vertex", fragment, MOTION_FORMAT) })
        };
        let shadow = |fragment| {
            make(Recipe {
                constants: &base,
                format: None,
                // Depth bias away from the sun, larger on surfaces at a grazing angle to the sun.
                bias: DepthBiasState { constant: -2, slope_scale: -2.0, clamp: 0.0 },
                ..Recipe::new(&sun, "shadow_vertex", fragment, COLOR_FORMAT)
            })
        };
        Self {
            motion: [motion(Some("motion_opaque"), true), motion(Some("motion"), true)],
            motion_far: make(Recipe {
                depth: false,
                vertices: false,
                ..Recipe::new(&surface, "fullscreen", Some("motion_far"), MOTION_FORMAT)
            }),
            sun: [shadow(None), shadow(Some("alpha_test"))],
            quads: Recipe {
                vertices: false,
                compare: CompareFunction::Always,
                writes: ColorWrites::empty(),
                ..Recipe::new(&quads, "quad", Some("nothing"), COLOR_FORMAT)
            }
            .make(device, &[Some(&layouts.frame), Some(&layouts.quads)]),
            color: ColorPipelines::new(device, layouts, effects, has_sun, SAMPLES),
        }
    }
}

fn constants(effects: Effects, list: &[(&'static str, Effect)]) -> Vec<(&'static str, f64)> {
    list.iter().map(|&(name, effect)| (name, f64::from(u8::from(effects.has(effect))))).collect()
}

/// Parameters that differ between pipelines.
#[derive(Clone, Copy)]
pub(super) struct Recipe<'a> {
    pub module: &'a ShaderModule,
    pub vertex: &'a str,
    pub fragment: Option<&'a str>,
    pub constants: &'a [(&'static str, f64)],
    /// `None` for depth only.
    pub format: Option<TextureFormat>,
    /// Targets after the first one, and what is written to them.
    pub others: &'a [(TextureFormat, ColorWrites)],
    /// Whether depth is written.
    pub depth: bool,
    pub compare: CompareFunction,
    pub bias: DepthBiasState,
    pub blend: Option<BlendState>,
    pub writes: ColorWrites,
    /// Alpha to coverage.
    pub coverage: bool,
    pub samples: u32,
    /// Whether vertex buffers are read.
    pub vertices: bool,
}

impl<'a> Recipe<'a> {
    pub fn new(module: &'a ShaderModule, vertex: &'a str, fragment: Option<&'a str>, format: TextureFormat) -> Self {
        Self {
            module,
            vertex,
            fragment,
            constants: &[],
            format: Some(format),
            others: &[],
            depth: true,
            compare: CompareFunction::GreaterEqual,
            bias: DepthBiasState::default(),
            blend: None,
            writes: ColorWrites::ALL,
            coverage: false,
            samples: 1,
            vertices: true,
        }
    }

    pub fn make(&self, device: &Device, groups: &[Option<&BindGroupLayout>]) -> RenderPipeline {
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some(self.vertex),
            bind_group_layouts: groups,
            ..Default::default()
        });
        let options = || wgpu::PipelineCompilationOptions { constants: self.constants, ..Default::default() };
        let target = |blend, (format, write_mask)| Some(ColorTargetState { format, blend, write_mask });
        let first = self.format.map(|format| target(self.blend, (format, self.writes)));
        let targets: Vec<_> = first.into_iter().chain(self.others.iter().map(|&other| target(None, other))).collect();
        let buffers = LAYOUTS.map(Into::into);
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: self.fragment.or(Some(self.vertex)),
            layout: Some(&layout),
            vertex: wgpu::VertexState {
                module: self.module,
                entry_point: Some(self.vertex),
                compilation_options: if self.fragment.is_some() { options() } else { Default::default() },
                buffers: if self.vertices { &buffers } else { &[] },
            },
            // Counter-clockwise is the front. Back faces are drawn, too.
            primitive: wgpu::PrimitiveState::default(),
            depth_stencil: Some(DepthStencilState {
                format: DEPTH_FORMAT,
                depth_write_enabled: Some(self.depth),
                depth_compare: Some(self.compare),
                stencil: Default::default(),
                bias: self.bias,
            }),
            multisample: wgpu::MultisampleState {
                count: self.samples,
                mask: !0,
                alpha_to_coverage_enabled: self.coverage,
            },
            fragment: self.fragment.map(|entry| wgpu::FragmentState {
                module: self.module,
                entry_point: Some(entry),
                compilation_options: options(),
                targets: &targets,
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}

/// Textures of a material, in the order of their bindings.
pub(super) const SLOTS: usize = 11;
/// The first textures of a material, which have a sampler each.
pub(super) const SAMPLERS: usize = 4;

impl Layouts {
    pub fn new(device: &Device) -> Self {
        let entry = |binding, visibility, ty| BindGroupLayoutEntry { binding, visibility, ty, count: None };
        let buffer = |ty| BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None };
        let uniform = buffer(wgpu::BufferBindingType::Uniform);
        let storage = buffer(wgpu::BufferBindingType::Storage { read_only: true });
        let texture = |sample_type| BindingType::Texture {
            sample_type,
            view_dimension: TextureViewDimension::D2,
            multisampled: false,
        };
        let filtered = texture(TextureSampleType::Float { filterable: true });
        let sampler = BindingType::Sampler(wgpu::SamplerBindingType::Filtering);
        let make = |label, entries: &[BindGroupLayoutEntry]| {
            device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some(label), entries })
        };
        let all = ShaderStages::VERTEX_FRAGMENT | ShaderStages::COMPUTE;
        let (fragment, compute) = (ShaderStages::FRAGMENT, ShaderStages::COMPUTE);
        let lit = fragment | compute;
        let exact = texture(TextureSampleType::Float { filterable: false });
        let color = BindingType::StorageTexture {
            access: wgpu::StorageTextureAccess::WriteOnly,
            format: COLOR_FORMAT,
            view_dimension: TextureViewDimension::D2,
        };
        let kept = [exact, exact, texture(TextureSampleType::Uint), exact, color];
        let kept: Vec<_> = (0..).zip(kept).map(|(binding, ty)| entry(binding, compute, ty)).collect();
        let textures = (0..SLOTS).flat_map(|i| [Some(filtered), (i < SAMPLERS).then_some(sampler)]).flatten();
        let material = (0..).zip(std::iter::once(storage).chain(textures));
        let material: Vec<_> = material.map(|(binding, ty)| entry(binding, fragment, ty)).collect();
        Self {
            frame: make("frame", &[entry(0, all, uniform), entry(1, all, storage)]),
            material: make("material", &material),
            quads: make("quads", &[entry(0, ShaderStages::VERTEX | compute, storage)]),
            g_buffer: make("g-buffer", &kept),
            opaque_depth: make("opaque depth", &[entry(0, fragment, exact)]),
            lighting_maps: make(
                "lighting_maps",
                &[
                    entry(0, lit, texture(TextureSampleType::Depth)),
                    entry(1, lit, BindingType::Sampler(wgpu::SamplerBindingType::Comparison)),
                    entry(2, lit, filtered),
                    entry(3, lit, sampler),
                    entry(4, lit, texture(TextureSampleType::Uint)),
                ],
            ),
        }
    }
}
