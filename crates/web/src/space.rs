//! A scene that is rendered foveated for real: each lattice is a small view in an atlas, and nothing else is shaded.

use crate::Result;
use crate::gpu::Gpu;
use afterimage::{DepthConvention, Gaze, Lattice, Lattices, ViewFrame, ViewGeometry};
use glam::{Mat4, Vec4};
use wgpu::util::{BufferInitDescriptor, DeviceExt};
use wgpu::{BufferUsages, CommandEncoder, RenderPipeline, Texture, TextureFormat, TextureUsages};

const NEAR: f32 = 0.1;
/// Half of the width of the view at distance 1: a horizontal field of view of 70 degrees.
const TAN_X: f32 = 0.7;

/// Depth as the scene is drawn.
pub const DEPTH: DepthConvention = DepthConvention::Reversed { near: NEAR, far: f32::INFINITY };

/// Color, depth and motion of the samples.
pub struct Atlas {
    pub color: Texture,
    pub depth: Texture,
    pub motion: Texture,
}

impl Atlas {
    pub fn new(gpu: &Gpu, size: [u32; 2]) -> Self {
        let usage = TextureUsages::RENDER_ATTACHMENT | TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_SRC;
        Self {
            color: gpu.texture(size, TextureFormat::Rgba32Float, usage),
            depth: gpu.texture(size, TextureFormat::Depth32Float, usage),
            motion: gpu.texture(size, TextureFormat::Rg32Float, usage),
        }
    }

    /// Whether lattices of this size fit.
    pub fn holds(&self, [width, height]: [u32; 2]) -> bool {
        width <= self.color.width() && height <= self.color.height()
    }
}

/// Uniforms of a lattice; `Scene` in `crates/web/shaders/scene.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct Scene {
    eye: [f32; 4],
    eye_before: [f32; 4],
    size_px: [f32; 2],
    tan: [f32; 2],
    first_px: [f32; 2],
    atlas_texel: [f32; 2],
    step: f32,
    unused: [f32; 3],
}

/// The pipeline, and the camera of the last frame.
pub struct Space {
    pipeline: RenderPipeline,
    size_px: [u32; 2],
    before: Option<f32>,
}

/// Position of the camera, and its turn around the vertical axis in radians.
fn eye(seconds: f32) -> Vec4 {
    let t = seconds;
    Vec4::new(
        0.6 * (0.31 * t).sin(),
        1.55 + 0.08 * (0.7 * t).sin(),
        6.0 + 3.0 * (0.23 * t).cos(),
        0.22 * (0.4 * t).sin(),
    )
}

impl Space {
    pub fn new(gpu: &Gpu, size_px: [u32; 2]) -> Self {
        let module = gpu.device.create_shader_module(wgpu::include_wgsl!("../shaders/scene.wgsl"));
        let pipeline = gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("scene"),
            layout: None,
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: None,
                compilation_options: Default::default(),
                buffers: &[],
            },
            primitive: Default::default(),
            depth_stencil: Some(wgpu::DepthStencilState {
                format: TextureFormat::Depth32Float,
                depth_write_enabled: Some(true),
                depth_compare: Some(wgpu::CompareFunction::Always),
                stencil: Default::default(),
                bias: Default::default(),
            }),
            multisample: Default::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: None,
                compilation_options: Default::default(),
                targets: &[Some(TextureFormat::Rgba32Float.into()), Some(TextureFormat::Rg32Float.into())],
            }),
            multiview_mask: None,
            cache: None,
        });
        Self { pipeline, size_px, before: None }
    }

    fn tan(&self) -> [f32; 2] {
        [TAN_X, TAN_X * self.size_px[1] as f32 / self.size_px[0] as f32]
    }

    /// Reversed depth with an infinite far plane, as in the shader.
    fn clip_from_view(&self) -> Mat4 {
        let [x, y] = self.tan();
        Mat4::from_cols(Vec4::X / x, Vec4::Y / y, Vec4::new(0.0, 0.0, 0.0, -1.0), Vec4::new(0.0, 0.0, NEAR, 0.0))
    }

    fn clip_from_world(&self, seconds: f32) -> Mat4 {
        let eye = eye(seconds);
        self.clip_from_view() * Mat4::from_rotation_y(-eye.w) * Mat4::from_translation(-eye.truncate())
    }

    /// Rays through the pixels.
    pub fn geometry(&self) -> Result<ViewGeometry> {
        Ok(ViewGeometry::from_projection(self.size_px, self.clip_from_view().to_cols_array_2d())?)
    }

    /// Description of the frame at a time, and the camera's motion since the last one.
    pub fn view(&self, seconds: f32, gaze_px: [f32; 2], lattices: Lattices) -> Result<ViewFrame> {
        let matrices =
            [self.clip_from_view(), self.clip_from_world(seconds), self.clip_from_world(self.before(seconds))];
        let [view, now, before] = matrices.map(|m| m.to_cols_array_2d());
        let moved = ViewFrame::new(self.geometry()?, Gaze::At { px: gaze_px }).moved(view, now, before)?;
        Ok(ViewFrame { lattices: Some(lattices.with_geometry_at_samples()), ..moved })
    }

    fn before(&self, seconds: f32) -> f32 {
        self.before.unwrap_or(seconds)
    }

    /// The frame at this time is the last one.
    pub fn advance(&mut self, seconds: f32) {
        self.before = Some(seconds);
    }

    /// Draws the samples of `lattices` at a time.
    pub fn record(&self, gpu: &Gpu, encoder: &mut CommandEncoder, atlas: &Atlas, lattices: &Lattices, seconds: f32) {
        let [color, depth, motion] =
            [&atlas.color, &atlas.depth, &atlas.motion].map(|texture| texture.create_view(&Default::default()));
        let target = |view| {
            let ops = wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::BLACK), store: wgpu::StoreOp::Store };
            Some(wgpu::RenderPassColorAttachment { view, depth_slice: None, resolve_target: None, ops })
        };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("scene"),
            color_attachments: &[target(&color), target(&motion)],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &depth,
                depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Store }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        pass.set_pipeline(&self.pipeline);
        for lattice in lattices.as_slice() {
            let scene = self.uniforms(lattice, seconds);
            let uniforms = gpu.device.create_buffer_init(&BufferInitDescriptor {
                label: Some("scene"),
                contents: bytemuck::bytes_of(&scene),
                usage: BufferUsages::UNIFORM,
            });
            let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("scene"),
                layout: &self.pipeline.get_bind_group_layout(0),
                entries: &[wgpu::BindGroupEntry { binding: 0, resource: uniforms.as_entire_binding() }],
            });
            let ([x, y], [width, height]) = (lattice.atlas_texel.unwrap_or_default(), lattice.points);
            pass.set_viewport(x as f32, y as f32, width as f32, height as f32, 0.0, 1.0);
            pass.set_scissor_rect(x, y, width, height);
            pass.set_bind_group(0, &group, &[]);
            pass.draw(0..3, 0..1);
        }
    }

    fn uniforms(&self, lattice: &Lattice, seconds: f32) -> Scene {
        Scene {
            eye: eye(seconds).to_array(),
            eye_before: eye(self.before(seconds)).to_array(),
            size_px: self.size_px.map(|s| s as f32),
            tan: self.tan(),
            first_px: lattice.first_px.map(|p| p as f32),
            atlas_texel: lattice.atlas_texel.unwrap_or_default().map(|p| p as f32),
            step: lattice.step as f32,
            unused: [0.0; 3],
        }
    }
}

/// Every pixel as one lattice, in an atlas of the frame's size.
pub fn whole(size_px: [u32; 2]) -> Result<Lattices> {
    Ok(Lattices::new(&[Lattice::covering(1, [0, 0], size_px, [0, 0])])?.in_atlas().0)
}
