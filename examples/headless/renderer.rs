//! A small renderer for the examples, as it would be without the post-process: a prepass of depth and motion vectors, a
//! pass of colors with a sky, and a pass of transparent things. It has a floor, a box that moves, and a pane of glass.
#![allow(dead_code, reason = "no example uses all of it")]

use super::Headless;
use afterimage::Targets;
use afterimage::wgpu::util::{BufferInitDescriptor, DeviceExt};
use afterimage::wgpu::{self, BufferUsages, CompareFunction, RenderPass, RenderPipeline, TextureFormat};
use glam::Mat4;

/// All passes must draw exactly the same depth, hence `@invariant`. Motion vectors are of objects alone, current minus
/// previous position in texture coordinates: those of the box, and 0 for what stands still.
const SHADER: &str = "
struct View { clip_from_world: mat4x4f, seconds: f32, seconds_before: f32 }
@group(0) @binding(0) var<uniform> view: View;

struct Varying {
    @invariant @builtin(position) position: vec4f,
    @location(0) place: vec3f,
    @location(1) now: vec4f,
    @location(2) before: vec4f,
    @location(3) @interpolate(flat) object: u32,
}

const FLOOR = 0u;
const BOX = 1u;
const SKY = 2u;

fn world_at(object: u32, i: u32, seconds: f32) -> vec3f {
    let corner = vec3f(vec3u(0x287au, 0x02afu, 0x31e3u) >> vec3u(i) & vec3u(1u));
    if object == BOX { return corner + vec3f(2.0 * sin(seconds) - 0.5, 0.2, -7.0); }
    if object == FLOOR { return vec3f(f32(i & 1u) * 120.0 - 60.0, 0.0, 9.0 - 70.0 * f32(i >> 1u)); }
    return vec3f(f32(i & 1u) * 2.0 - 1.0, 0.4 + 1.6 * f32(i >> 1u), -4.0);
}

@vertex fn vertex(@builtin(vertex_index) i: u32, @builtin(instance_index) object: u32) -> Varying {
    // The sky lies at infinity, where the reversed depth is 0.
    if object == SKY {
        let sky = vec4f(f32(i & 1u) * 4.0 - 1.0, f32(i >> 1u) * 4.0 - 1.0, 0.0, 1.0);
        return Varying(sky, vec3f(0.0), sky, sky, object);
    }
    let world = world_at(object, i, view.seconds);
    let now = view.clip_from_world * vec4f(world, 1.0);
    let before = view.clip_from_world * vec4f(world_at(object, i, view.seconds_before), 1.0);
    // The texture moves with the object.
    return Varying(now, world_at(object, i, 0.0), now, before, object);
}

@fragment fn motion(in: Varying) -> @location(0) vec2f {
    return (in.now.xy / in.now.w - in.before.xy / in.before.w) * vec2f(0.5, -0.5);
}

@fragment fn color(in: Varying) -> @location(0) vec4f {
    if in.object == SKY { return vec4f(0.4, 0.6, 0.9, 1.0); }
    let plane = select(in.place.xz * 12.0, (in.place.xy + in.place.z) * 30.0, in.object == BOX);
    let wave = sin(plane) * (1.0 - smoothstep(vec2f(1.2), vec2f(3.0), fwidth(plane)));
    return vec4f(vec3f(0.5, 0.45, 0.4) + 0.3 * wave.x * wave.y, 1.0);
}

@fragment fn glass(in: Varying) -> @location(0) vec4f {
    return vec4f(0.05, 0.1, 0.07, 0.25);
}";

/// What a pass is drawn with: a projection times a pose, depth reversed; and the time now and in the last frame.
#[derive(Clone, Copy)]
pub struct View {
    pub clip_from_world: Mat4,
    pub seconds: [f32; 2],
}

/// An object of the shader, and its number of corners in a triangle strip.
type Object = (u32, u32);
const FLOOR: Object = (0, 4);
const BOX: Object = (1, 14);
const SKY: Object = (2, 3);
const GLASS: Object = (3, 4);

pub struct Renderer {
    prepass: RenderPipeline,
    colors: RenderPipeline,
    glass: RenderPipeline,
}

impl Renderer {
    /// A renderer of colors of the format `color`, with a pass of transparent things that draws into `output`.
    pub fn new(gpu: &Headless, color: TextureFormat, output: TextureFormat) -> Self {
        let blended = Some(wgpu::BlendState::ALPHA_BLENDING);
        Self {
            prepass: pipeline(gpu, "motion", Targets::MOTION.into(), true),
            colors: pipeline(gpu, "color", color.into(), false),
            glass: pipeline(gpu, "glass", wgpu::ColorTargetState { blend: blended, ..output.into() }, false),
        }
    }

    /// Draws depth and motion vectors of every pixel.
    pub fn prepass(&self, gpu: &Headless, mut pass: RenderPass<'_>, view: View) {
        draw(gpu, &mut pass, &self.prepass, &[FLOOR, BOX], view);
    }

    /// Draws the colors of what is as near as the depth buffer says, and the sky where nothing is.
    pub fn colors(&self, gpu: &Headless, mut pass: RenderPass<'_>, view: View) {
        draw(gpu, &mut pass, &self.colors, &[FLOOR, BOX, SKY], view);
    }

    /// Draws transparent things over a picture.
    pub fn glass(&self, gpu: &Headless, mut pass: RenderPass<'_>, view: View) {
        draw(gpu, &mut pass, &self.glass, &[GLASS], view);
    }
}

fn pipeline(gpu: &Headless, fragment: &str, target: wgpu::ColorTargetState, writes_depth: bool) -> RenderPipeline {
    let source = wgpu::ShaderSource::Wgsl(SHADER.into());
    let module = &gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source });
    gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: None,
        vertex: wgpu::VertexState { module, entry_point: None, compilation_options: Default::default(), buffers: &[] },
        primitive: wgpu::PrimitiveState { topology: wgpu::PrimitiveTopology::TriangleStrip, ..Default::default() },
        // What is as near as the prepass says is drawn.
        depth_stencil: Some(wgpu::DepthStencilState {
            format: Targets::DEPTH,
            depth_write_enabled: Some(writes_depth),
            depth_compare: Some(CompareFunction::GreaterEqual),
            stencil: Default::default(),
            bias: Default::default(),
        }),
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some(fragment),
            compilation_options: Default::default(),
            targets: &[Some(target)],
        }),
        multiview_mask: None,
        cache: None,
    })
}

/// Draws `objects`.
fn draw(gpu: &Headless, pass: &mut RenderPass<'_>, pipeline: &RenderPipeline, objects: &[Object], view: View) {
    let mut uniforms = view.clip_from_world.to_cols_array().to_vec();
    uniforms.extend([view.seconds[0], view.seconds[1], 0.0, 0.0]);
    let (contents, usage) = (bytemuck::cast_slice(&uniforms), BufferUsages::UNIFORM);
    let uniforms = gpu.device.create_buffer_init(&BufferInitDescriptor { label: None, contents, usage });
    let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &pipeline.get_bind_group_layout(0),
        entries: &[wgpu::BindGroupEntry { binding: 0, resource: uniforms.as_entire_binding() }],
    });
    pass.set_pipeline(pipeline);
    pass.set_bind_group(0, &group, &[]);
    for &(object, corners) in objects {
        pass.draw(0..corners, object..object + 1);
    }
}
