//! The canvas.

use crate::Result;
use crate::gpu::Gpu;
use wasm_bindgen::JsError;
use wgpu::util::{BufferInitDescriptor, DeviceExt};
use wgpu::{
    Adapter, BufferUsages, CommandEncoder, RenderPipeline, Surface, SurfaceConfiguration, SurfaceTexture, Texture,
};

/// Draws two images, a divider and the gaze on a canvas of the images' size.
pub struct Show {
    surface: Surface<'static>,
    configuration: SurfaceConfiguration,
    pipeline: RenderPipeline,
    drawn: Option<SurfaceTexture>,
}

/// What is drawn over the images, in pixels.
pub struct Marks {
    pub gaze_px: [f32; 2],
    pub ring_px: f32,
    pub divider_px: f32,
    pub line_px: f32,
}

impl Show {
    pub fn new(gpu: &Gpu, adapter: &Adapter, surface: Surface<'static>, [width, height]: [u32; 2]) -> Result<Self> {
        let configuration = surface
            .get_default_config(adapter, width, height)
            .ok_or_else(|| JsError::new("the canvas cannot be drawn to"))?;
        surface.configure(&gpu.device, &configuration);
        let module = gpu.device.create_shader_module(wgpu::include_wgsl!("../shaders/show.wgsl"));
        let pipeline = gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("show"),
            layout: None,
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: None,
                compilation_options: Default::default(),
                buffers: &[],
            },
            primitive: Default::default(),
            depth_stencil: None,
            multisample: Default::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: None,
                compilation_options: Default::default(),
                targets: &[Some(configuration.format.into())],
            }),
            multiview_mask: None,
            cache: None,
        });
        Ok(Self { surface, configuration, pipeline, drawn: None })
    }

    pub fn resize(&mut self, gpu: &Gpu, [width, height]: [u32; 2]) {
        (self.configuration.width, self.configuration.height) = (width.max(1), height.max(1));
        self.surface.configure(&gpu.device, &self.configuration);
    }

    /// Records the picture: the first image left of the divider, the second right of it.
    pub fn record(
        &mut self,
        gpu: &Gpu,
        encoder: &mut CommandEncoder,
        images: [&Texture; 2],
        marks: Marks,
    ) -> Result<()> {
        let frame = match self.surface.get_current_texture() {
            wgpu::CurrentSurfaceTexture::Success(frame) | wgpu::CurrentSurfaceTexture::Suboptimal(frame) => frame,
            _ => return Err(JsError::new("the canvas cannot be drawn to")),
        };
        let [width, height] = [images[0].width(), images[0].height()].map(|s| s as f32);
        let [x, y] = marks.gaze_px;
        let words = [width, height, x, y, marks.divider_px, marks.ring_px, marks.line_px, 0.0];
        let uniforms = gpu.device.create_buffer_init(&BufferInitDescriptor {
            label: Some("show"),
            contents: bytemuck::bytes_of(&words),
            usage: BufferUsages::UNIFORM,
        });
        let [left, right] = images.map(|image| image.create_view(&Default::default()));
        let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("show"),
            layout: &self.pipeline.get_bind_group_layout(0),
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: uniforms.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::TextureView(&left) },
                wgpu::BindGroupEntry { binding: 2, resource: wgpu::BindingResource::TextureView(&right) },
            ],
        });
        let view = frame.texture.create_view(&Default::default());
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("show"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::BLACK), store: wgpu::StoreOp::Store },
            })],
            ..Default::default()
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.draw(0..3, 0..1);
        drop(pass);
        self.drawn = Some(frame);
        Ok(())
    }

    /// Presents what was recorded and submitted.
    pub fn present(&mut self, gpu: &Gpu) {
        if let Some(frame) = self.drawn.take() {
            gpu.queue.present(frame);
        }
    }
}
