//! What is the least that an application with a window needs? Its renderer draws a foveated frame into a texture, `record` writes what
//! is shown into another, a blit takes that to the swapchain. The mouse is the gaze.
//!
//! `cargo run --features view --example viewer_in_your_app` (closes by itself after AFTERIMAGE_FRAMES frames, if that is set)

use afterimage::display::ViewGeometry;
use afterimage::frame::{Gaze, ViewFrame};
use afterimage::gpu::{Afterimage, Frame, GpuDesc};
use std::{error::Error, sync::Arc};
use wgpu::{CurrentSurfaceTexture, TextureFormat::Rgba16Float, TextureUsages, util::TextureBlitter};
use winit::application::ApplicationHandler;
use winit::event::WindowEvent;
use winit::event_loop::{ActiveEventLoop, EventLoop};
use winit::window::{Window, WindowId};

/// Stands in for your renderer: a pattern, shaded once a block of 8 or 16 pixels away from the gaze.
const RENDERER: &str = "
    @group(0) @binding(0) var<uniform> gaze: vec4<f32>;
    @vertex fn corner(@builtin(vertex_index) i: u32) -> @builtin(position) vec4<f32> {
        return vec4<f32>(f32(i & 1u) * 4.0 - 1.0, f32(i >> 1u) * 4.0 - 1.0, 0.0, 1.0);
    }
    @fragment fn color(@builtin(position) at: vec4<f32>) -> @location(0) vec4<f32> {
        let away = distance(at.xy, gaze.xy);
        let block = select(select(16.0, 8.0, away < gaze.w), 1.0, away < gaze.z);
        let p = (floor(at.xy / block) + 0.5) * block;
        let line = smoothstep(0.0, 0.3, sin(length(p) * 0.4) * sin(p.x * 0.13 + sin(p.y * 0.05) * 3.0));
        return vec4<f32>(mix(vec3<f32>(0.02, 0.05, 0.15), vec3<f32>(0.9, 0.7, 0.3), line), 1.0);
    }";

const HFOV_DEG: f32 = 70.0;

struct App {
    window: Arc<Window>,
    device: wgpu::Device,
    queue: wgpu::Queue,
    surface: wgpu::Surface<'static>,
    config: wgpu::SurfaceConfiguration,
    renderer: wgpu::RenderPipeline,
    gaze_buffer: wgpu::Buffer,
    blitter: TextureBlitter,
    post: Afterimage,
    color: wgpu::Texture,
    output: wgpu::Texture,
    gaze: Gaze,
    index: u64,
}

fn texture(device: &wgpu::Device, [width, height]: [u32; 2], usage: TextureUsages) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: Rgba16Float,
        usage: usage | TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    })
}

impl App {
    fn new(events: &ActiveEventLoop) -> Result<Self, Box<dyn Error>> {
        let window = Arc::new(events.create_window(Window::default_attributes().with_title("your application"))?);
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
        let surface = instance.create_surface(window.clone())?;
        let options = wgpu::RequestAdapterOptions { compatible_surface: Some(&surface), ..Default::default() };
        let adapter = pollster::block_on(instance.request_adapter(&options))?;
        // No features, and limits of WebGPU.
        let (device, queue) = pollster::block_on(adapter.request_device(&Default::default()))?;
        let size = [window.inner_size().width.max(1), window.inner_size().height.max(1)];
        let config = surface.get_default_config(&adapter, size[0], size[1]).ok_or("no format for this window")?;
        surface.configure(&device, &config);
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: None,
            source: wgpu::ShaderSource::Wgsl(RENDERER.into()),
        });
        let (entries, targets) = ([Some("corner"), Some("color")], [Some(Rgba16Float.into())]);
        let renderer = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: None,
            layout: None,
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: entries[0],
                compilation_options: Default::default(),
                buffers: &[],
            },
            primitive: Default::default(),
            depth_stencil: None,
            multisample: Default::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: entries[1],
                compilation_options: Default::default(),
                targets: &targets,
            }),
            multiview_mask: None,
            cache: None,
        });
        let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
        let gaze_buffer =
            device.create_buffer(&wgpu::BufferDescriptor { label: None, size: 16, usage, mapped_at_creation: false });
        Ok(Self {
            // The post-process, once.
            post: Afterimage::new(&device, &GpuDesc::new(size, Rgba16Float))?,
            blitter: TextureBlitter::new(&device, config.format),
            color: texture(&device, size, TextureUsages::RENDER_ATTACHMENT),
            output: texture(&device, size, TextureUsages::STORAGE_BINDING),
            gaze: Gaze::Lost,
            index: 0,
            window,
            device,
            queue,
            surface,
            config,
            renderer,
            gaze_buffer,
        })
    }

    fn resize(&mut self, size: [u32; 2]) -> Result<(), Box<dyn Error>> {
        if size.contains(&0) || size == [self.config.width, self.config.height] {
            return Ok(());
        }
        [self.config.width, self.config.height] = size;
        self.surface.configure(&self.device, &self.config);
        self.color = texture(&self.device, size, TextureUsages::RENDER_ATTACHMENT);
        self.output = texture(&self.device, size, TextureUsages::STORAGE_BINDING);
        // Its history starts afresh.
        Ok(self.post.resize(&self.device, size)?)
    }

    fn frame(&mut self) -> Result<(), Box<dyn Error>> {
        let target = match self.surface.get_current_texture() {
            CurrentSurfaceTexture::Success(target) | CurrentSurfaceTexture::Suboptimal(target) => target,
            CurrentSurfaceTexture::Outdated => return Ok(self.surface.configure(&self.device, &self.config)),
            CurrentSurfaceTexture::Lost | CurrentSurfaceTexture::Validation => return Err("the surface is lost".into()),
            _ => return Ok(()),
        };
        let mut encoder = self.device.create_command_encoder(&Default::default());
        // Here your renderer would draw the foveated frame.
        self.draw(&mut encoder);
        let geometry = ViewGeometry::flat([self.config.width, self.config.height], HFOV_DEG)?;
        let views = [ViewFrame { geometry, gaze: self.gaze, previous_from_current: None }];
        let frame = Frame::new(&self.color, &self.output, &views, self.index);
        self.post.record(&self.device, &mut encoder, &frame)?;
        // And here would be your tone mapping.
        let [output, screen] = [&self.output, &target.texture].map(|t| t.create_view(&Default::default()));
        self.blitter.copy(&self.device, &mut encoder, &output, &screen);
        self.queue.submit([encoder.finish()]);
        self.queue.present(target);
        self.index += 1;
        Ok(())
    }

    fn draw(&self, encoder: &mut wgpu::CommandEncoder) {
        let focal = 0.5 * self.config.width as f32 / (0.5 * HFOV_DEG).to_radians().tan();
        // Radii of 2.5 and 7.5 degrees, as `Settings::foveation` has them.
        let [fovea, mid] = [2.5_f32, 7.5].map(|deg| focal * deg.to_radians().tan());
        let px = if let Gaze::At { px } = self.gaze {
            px
        } else {
            [0.5 * self.config.width as f32, 0.5 * self.config.height as f32]
        };
        self.queue.write_buffer(&self.gaze_buffer, 0, bytemuck::bytes_of(&[px[0], px[1], fovea, mid]));
        let group = self.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &self.renderer.get_bind_group_layout(0),
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: self.gaze_buffer.as_entire_binding() }],
        });
        let view = self.color.create_view(&Default::default());
        let ops = wgpu::Operations::default();
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &view,
                depth_slice: None,
                resolve_target: None,
                ops,
            })],
            ..Default::default()
        });
        pass.set_pipeline(&self.renderer);
        pass.set_bind_group(0, &group, &[]);
        pass.draw(0..3, 0..1);
    }
}

#[derive(Default)]
struct Shell {
    app: Option<App>,
    last_frame: Option<u64>,
    error: Option<Box<dyn Error>>,
}

impl Shell {
    fn handle(&mut self, events: &ActiveEventLoop, event: &WindowEvent) -> Result<(), Box<dyn Error>> {
        let Some(app) = &mut self.app else { return Ok(()) };
        match event {
            WindowEvent::CloseRequested => events.exit(),
            WindowEvent::Resized(size) => app.resize([size.width, size.height])?,
            WindowEvent::CursorMoved { position: p, .. } => {
                app.gaze = Gaze::At { px: [p.x as f32 - 0.5, p.y as f32 - 0.5] }
            }
            WindowEvent::RedrawRequested => {
                app.frame()?;
                app.window.request_redraw();
                if self.last_frame.is_some_and(|last| app.index >= last) {
                    events.exit();
                }
            }
            _ => {}
        }
        Ok(())
    }
}

impl ApplicationHandler for Shell {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        match App::new(events) {
            Ok(app) => self.app = Some(app),
            Err(error) => {
                self.error = Some(error);
                events.exit();
            }
        }
    }

    fn window_event(&mut self, events: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        if let Err(error) = self.handle(events, &event) {
            self.error = Some(error);
            events.exit();
        }
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let last_frame = std::env::var("AFTERIMAGE_FRAMES").ok().and_then(|n| n.parse().ok());
    let mut shell = Shell { last_frame, ..Shell::default() };
    EventLoop::new()?.run_app(&mut shell)?;
    shell.error.map_or(Ok(()), Err)
}
