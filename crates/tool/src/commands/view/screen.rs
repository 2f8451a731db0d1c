//! Draws the window in one pass: pictures, divider, gaze mark, panel.

use super::device;
use super::layout::Layout;
use super::shader::SHADERS;
use afterimage::ViewGeometry;
use afterimage::gpu::Timestamps;
use afterimage::wgpu;
use afterimage_lab::device::Headless;
use bytemuck::{Pod, Zeroable};
use glam::Vec3;
use image::RgbImage;
use wgpu::{
    BindGroup, BindGroupEntry, CommandEncoder, RenderPipeline, ShaderModule, Texture, TextureFormat, TextureUsages,
    TextureView,
};

/// `ScreenConstants` in `shaders/view/view_screen.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
struct ScreenConstants {
    /// Direction of the gaze, unit length.
    gaze_direction: [f32; 4],
    /// Top left corner of the picture, pixels of the window.
    corner: [f32; 2],
    /// Size of the picture, pixels of the picture.
    size: [f32; 2],
    /// Tangent of the ray's angle: change per pixel of the picture, and value at pixel (0, 0).
    ray_scale: [f32; 2],
    ray_offset: [f32; 2],
    /// Gaze, pixels of the picture.
    gaze_px: [f32; 2],
    /// Cosines of the outer and inner eccentricity of the ring; no ring if the first is greater.
    ring_cosines: [f32; 2],
    /// Size of the panel in its own pixels; 0: no panel.
    panel: [f32; 2],
    /// Window pixels per picture pixel.
    scale: f32,
    /// Position of the divider, pixels of the picture; beyond the width: no divider.
    divider: f32,
    /// Window pixels per panel pixel.
    panel_scale: f32,
    /// Upper bound on the ring's distance from the gaze, pixels of the window.
    ring_reach_px: f32,
    /// Exposure factor, linear.
    gain: f32,
    unused: [u32; 1],
}

/// Contents of the window.
pub struct Scene<'a> {
    pub layout: &'a Layout,
    pub geometry: &'a ViewGeometry,
    /// Left and right picture.
    pub pictures: [&'a Texture; 2],
    /// Exposure factor of each picture, linear.
    pub gain: [f32; 2],
    /// Position of the divider as a fraction of the picture's width; `None`: no split.
    pub divider: Option<f32>,
    /// Gaze in pixels of the picture; `None`: no gaze mark.
    pub gaze_px: Option<[f32; 2]>,
    /// Diameter of the fovea, degrees.
    pub fovea_deg: f32,
    pub has_panel: bool,
    /// Window pixels per panel pixel.
    pub panel_scale: u32,
}

/// Width of the ring around the fovea, pixels of the window.
const RING_PX: f32 = 1.5;

/// Largest box filter when the picture is minified, texels per side.
const MAX_TAPS: f32 = 4.0;

/// Draws scenes to render targets of one format.
pub struct Screen {
    module: ShaderModule,
    format: TextureFormat,
    /// Pipeline, and the number of taps that it was created for: depends on the sizes of window and picture.
    pipeline: Option<(u32, RenderPipeline)>,
    panel: Texture,
}

impl Screen {
    pub fn new(gpu: &Headless, format: TextureFormat) -> Self {
        let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("view screen"),
            source: wgpu::ShaderSource::Wgsl(SHADERS.compose("view_screen").source.into()),
        });
        Self { module, format, pipeline: None, panel: panel_texture(gpu, [1, 1]) }
    }

    /// Uploads the panel.
    pub fn set_panel(&mut self, gpu: &Headless, panel: &RgbImage) {
        let (width, height) = panel.dimensions();
        if [self.panel.width(), self.panel.height()] != [width, height] {
            self.panel = panel_texture(gpu, [width, height]);
        }
        let rgba: Vec<u8> = panel.pixels().flat_map(|p| [p[0], p[1], p[2], 255]).collect();
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * width), rows_per_image: None };
        gpu.queue.write_texture(self.panel.as_image_copy(), &rgba, layout, self.panel.size());
    }

    /// Draws a scene to `target` of `size`.
    pub fn record(
        &mut self,
        gpu: &Headless,
        encoder: &mut CommandEncoder,
        (target, size): (&TextureView, [u32; 2]),
        scene: &Scene<'_>,
        timestamps: Option<Timestamps<'_>>,
    ) {
        let pipeline = self.pipeline_for(gpu, scene.layout.scale);
        let groups = [0, 1].map(|side| self.group(gpu, &pipeline, scene, side));
        let divider_x = scene.divider.map_or(size[0], |share| scene.layout.divider_x(share).min(size[0]));
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("view screen"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: target,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::BLACK), store: wgpu::StoreOp::Store },
            })],
            timestamp_writes: timestamps.map(|t| wgpu::RenderPassTimestampWrites {
                query_set: t.queries,
                beginning_of_pass_write_index: Some(t.begin),
                end_of_pass_write_index: Some(t.end),
            }),
            ..Default::default()
        });
        pass.set_pipeline(&pipeline);
        for (group, [from, to]) in groups.iter().zip([[0, divider_x], [divider_x, size[0]]]) {
            if from < to {
                pass.set_bind_group(0, group, &[]);
                pass.set_scissor_rect(from, 0, to - from, size[1]);
                pass.draw(0..3, 0..1);
            }
        }
    }

    fn pipeline_for(&mut self, gpu: &Headless, scale: f32) -> RenderPipeline {
        let taps = if scale > 1.0 { 0 } else { (1.0 / scale).ceil().min(MAX_TAPS) as u32 };
        if let Some((_, pipeline)) = self.pipeline.as_ref().filter(|(made_for, _)| *made_for == taps) {
            return pipeline.clone();
        }
        // Float targets stay linear.
        let encodes = !self.format.is_srgb() && self.format != TextureFormat::Rgba32Float;
        let constants = [("TAPS", f64::from(taps)), ("SHADER_ENCODES", f64::from(u8::from(encodes)))];
        let options = wgpu::PipelineCompilationOptions { constants: &constants, ..Default::default() };
        let pipeline = gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("view screen"),
            layout: None,
            vertex: wgpu::VertexState {
                module: &self.module,
                entry_point: Some("corner"),
                compilation_options: Default::default(),
                buffers: &[],
            },
            primitive: Default::default(),
            depth_stencil: None,
            multisample: Default::default(),
            fragment: Some(wgpu::FragmentState {
                module: &self.module,
                entry_point: Some("main"),
                compilation_options: options,
                targets: &[Some(self.format.into())],
            }),
            multiview_mask: None,
            cache: None,
        });
        self.pipeline.insert((taps, pipeline)).1.clone()
    }

    /// Bind group of a side.
    fn group(&self, gpu: &Headless, pipeline: &RenderPipeline, scene: &Scene<'_>, side: usize) -> BindGroup {
        let constants = device::constants(gpu, "view screen", &self.constants(scene, side));
        let [picture, panel] = [scene.pictures[side], &self.panel].map(|t| t.create_view(&Default::default()));
        let resources = [
            constants.as_entire_binding(),
            wgpu::BindingResource::TextureView(&picture),
            wgpu::BindingResource::TextureView(&panel),
        ];
        let entries: Vec<_> =
            (0..).zip(resources).map(|(binding, resource)| BindGroupEntry { binding, resource }).collect();
        gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("view screen"),
            layout: &pipeline.get_bind_group_layout(0),
            entries: &entries,
        })
    }

    fn constants(&self, scene: &Scene<'_>, side: usize) -> ScreenConstants {
        let geometry = scene.geometry;
        let size = geometry.size_px().map(|s| s as f32);
        let (ray_scale, ray_offset) = geometry.scale_offset();
        let gaze_px = scene.gaze_px.unwrap_or([-1e6; 2]);
        let direction = Vec3::from(geometry.ray(gaze_px)).normalize();
        let radius = (0.5 * scene.fovea_deg).to_radians();
        // Constant angular width: `RING_PX` at the center of the view.
        let half_width = 0.5 * RING_PX * ray_scale[0] / scene.layout.scale;
        let ring = [radius + half_width, (radius - half_width).max(0.0)].map(f32::cos);
        ScreenConstants {
            gaze_direction: direction.extend(0.0).to_array(),
            corner: scene.layout.corner,
            size,
            ray_scale,
            ray_offset,
            gaze_px,
            ring_cosines: if scene.gaze_px.is_some() { ring } else { [2.0, -2.0] },
            panel: if scene.has_panel { [self.panel.width() as f32, self.panel.height() as f32] } else { [0.0; 2] },
            scale: scene.layout.scale,
            divider: scene.divider.map_or(2.0 * size[0] + 16.0, |share| share * size[0]),
            panel_scale: scene.panel_scale.max(1) as f32,
            ring_reach_px: ring_reach_px(geometry, gaze_px, scene),
            gain: scene.gain[side],
            unused: [0; 1],
        }
    }
}

/// Upper bound on the ring's radius, pixels of the window: its radius away from the center of the view, where a degree
/// spans most pixels.
fn ring_reach_px(geometry: &ViewGeometry, gaze_px: [f32; 2], scene: &Scene<'_>) -> f32 {
    let ray = geometry.ray(gaze_px);
    let (eccentricity, radius) =
        ((Vec3::from(ray).length_squared() - 1.0).sqrt().atan(), (0.5 * scene.fovea_deg).to_radians());
    let outer = (eccentricity + radius).min(1.5);
    let (scale, _) = geometry.scale_offset();
    (outer.tan() - eccentricity.min(1.5).tan()) / scale[0].min(scale[1]) * scene.layout.scale + 8.0
}

fn panel_texture(gpu: &Headless, size: [u32; 2]) -> Texture {
    gpu.texture(size, 1, TextureFormat::Rgba8UnormSrgb, TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST)
}
