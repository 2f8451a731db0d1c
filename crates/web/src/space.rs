//! A scene that is rendered foveated for real: depth and motion of every pixel, colors of the chosen ones alone.

use crate::Result;
use crate::gpu::{Dispatch, Gpu};
use afterimage::gpu::Afterimage;
use afterimage::internal::ViewFrame;
use afterimage::{DepthConvention, Gaze, ViewGeometry};
use glam::{Mat4, Vec4};
use wgpu::util::{BufferInitDescriptor, DeviceExt};
use wgpu::{
    BindingResource, Buffer, BufferUsages, CommandEncoder, ComputePipeline, Texture, TextureFormat, TextureView,
};

const NEAR: f32 = 0.1;
/// Half of the width of the view at distance 1: a horizontal field of view of 70 degrees.
const TAN_X: f32 = 0.7;

/// Depth as the scene is drawn.
pub const DEPTH: DepthConvention = DepthConvention::Reversed { near: NEAR, far: f32::INFINITY };

/// Color, depth and motion of a frame.
pub struct Images {
    pub color: Texture,
    pub depth: Texture,
    pub motion: Texture,
}

impl Images {
    pub fn new(gpu: &Gpu, size: [u32; 2]) -> Self {
        let image = |format| gpu.image(size, format);
        Self {
            color: image(TextureFormat::Rgba32Float),
            depth: image(TextureFormat::R32Float),
            motion: image(TextureFormat::Rg32Float),
        }
    }
}

/// Uniforms of a frame; `Scene` in `crates/web/shaders/scene.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct Scene {
    eye: [f32; 4],
    eye_before: [f32; 4],
    size_px: [f32; 2],
    tan: [f32; 2],
}

/// The pipelines, and the camera of the last frame.
pub struct Space {
    surfaces: ComputePipeline,
    chosen: ComputePipeline,
    everything: ComputePipeline,
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
        let [surfaces, chosen, everything] =
            ["surfaces", "chosen", "everything"].map(|entry| gpu.pipeline(&module, entry));
        Self { surfaces, chosen, everything, size_px, before: None }
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
    pub fn view(&self, seconds: f32, gaze_px: [f32; 2]) -> Result<ViewFrame> {
        let matrices =
            [self.clip_from_view(), self.clip_from_world(seconds), self.clip_from_world(self.before(seconds))];
        let [view, now, before] = matrices.map(|m| m.to_cols_array_2d());
        Ok(ViewFrame::new(self.geometry()?, Gaze::At { px: gaze_px }).moved(view, now, before)?)
    }

    fn before(&self, seconds: f32) -> f32 {
        self.before.unwrap_or(seconds)
    }

    /// The frame at this time is the last one.
    pub fn advance(&mut self, seconds: f32) {
        self.before = Some(seconds);
    }

    /// Depth and motion of every pixel at a time.
    pub fn record_surfaces(&self, gpu: &Gpu, encoder: &mut CommandEncoder, images: &Images, seconds: f32) {
        let (scene, [_, depth, motion]) = (self.uniforms(gpu, seconds), views(images));
        let bound = [
            (0, scene.as_entire_binding()),
            (1, BindingResource::TextureView(&depth)),
            (2, BindingResource::TextureView(&motion)),
        ];
        gpu.dispatch(encoder, &self.surfaces, &bound, Dispatch::Pixels(self.size_px));
    }

    /// Colors of the pixels that `post` chose.
    pub fn record_chosen(
        &self,
        gpu: &Gpu,
        encoder: &mut CommandEncoder,
        images: &Images,
        post: &Afterimage,
        seconds: f32,
    ) {
        let (Some(list), Some(mask)) = (post.quad_list(0), post.quad_mask()) else { return };
        let (scene, [color, ..]) = (self.uniforms(gpu, seconds), views(images));
        let mask = mask.create_view(&Default::default());
        let bound = [
            (0, scene.as_entire_binding()),
            (3, BindingResource::TextureView(&color)),
            (4, list.as_entire_binding()),
            (5, BindingResource::TextureView(&mask)),
        ];
        gpu.dispatch(encoder, &self.chosen, &bound, Dispatch::Quads(list));
    }

    /// Colors of all pixels.
    pub fn record_everything(&self, gpu: &Gpu, encoder: &mut CommandEncoder, images: &Images, seconds: f32) {
        let (scene, [color, ..]) = (self.uniforms(gpu, seconds), views(images));
        let bound = [(0, scene.as_entire_binding()), (3, BindingResource::TextureView(&color))];
        gpu.dispatch(encoder, &self.everything, &bound, Dispatch::Pixels(self.size_px));
    }

    fn uniforms(&self, gpu: &Gpu, seconds: f32) -> Buffer {
        let scene = Scene {
            eye: eye(seconds).to_array(),
            eye_before: eye(self.before(seconds)).to_array(),
            size_px: self.size_px.map(|s| s as f32),
            tan: self.tan(),
        };
        gpu.device.create_buffer_init(&BufferInitDescriptor {
            label: Some("scene"),
            contents: bytemuck::bytes_of(&scene),
            usage: BufferUsages::UNIFORM,
        })
    }
}

/// Color, depth and motion.
fn views(images: &Images) -> [TextureView; 3] {
    [&images.color, &images.depth, &images.motion].map(|texture| texture.create_view(&Default::default()))
}
