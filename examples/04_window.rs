//! The smallest application with a window: a renderer draws a foveated frame, `record` writes the output texture, and a
//! blit copies that to the swapchain. The mouse is the gaze.
//!
//! The post-process adds to an application the fields `post`, `output` and `gaze` of `App` and the lines marked (1) to
//! (4).
//!
//! `cargo run --example 04_window` (closes by itself after AFTERIMAGE_FRAMES frames, if that is set)

use afterimage::levels::{Afterimage, Desc, Frame, Simulator, SimulatorFrame, ViewFrame};
use afterimage::wgpu::{self, CurrentSurfaceTexture, TextureFormat, TextureUsages, util::TextureBlitter};
use afterimage::{Gaze, ViewGeometry};
use std::{error::Error, sync::Arc};
use winit::application::ApplicationHandler;
use winit::event::WindowEvent;
use winit::event_loop::{ActiveEventLoop, EventLoop};
use winit::window::{Window, WindowId};

/// Output format. Compute shaders can rarely write a swapchain's format: write this one, and draw it to the screen.
const FORMAT: TextureFormat = TextureFormat::Rgba16Float;

/// The application: a window, its device, and the post-process.
struct App {
    window: Arc<Window>,
    device: wgpu::Device,
    queue: wgpu::Queue,
    surface: wgpu::Surface<'static>,
    config: wgpu::SurfaceConfiguration,
    blitter: TextureBlitter,
    renderer: Renderer,
    post: Afterimage,
    output: wgpu::Texture,
    gaze: Gaze,
    index: u64,
}

/// Placeholder for your renderer: a pattern, foveated by the simulator.
struct Renderer {
    pattern: wgpu::Texture,
    foveation: Simulator,
    color: wgpu::Texture,
}

fn texture(device: &wgpu::Device, [width, height]: [u32; 2], format: TextureFormat) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: TextureUsages::TEXTURE_BINDING | TextureUsages::STORAGE_BINDING | TextureUsages::COPY_DST,
        view_formats: &[],
    })
}

impl Renderer {
    fn new(device: &wgpu::Device, queue: &wgpu::Queue, size: [u32; 2]) -> Result<Self, Box<dyn Error>> {
        let pattern = texture(device, size, TextureFormat::Rgba32Float);
        let pixels: Vec<[f32; 4]> = (0..size[0] * size[1])
            .map(|i| [i % size[0], i / size[0]].map(|v| v as f32))
            .map(|[x, y]| 0.5 + 0.5 * (x.hypot(y) * 0.4).sin() * (x * 0.13 + (y * 0.05).sin() * 3.0).sin())
            .map(|line| [0.9 * line, 0.7 * line, 0.3, 1.0])
            .collect();
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(16 * size[0]), rows_per_image: None };
        queue.write_texture(pattern.as_image_copy(), bytemuck::cast_slice(&pixels), layout, pattern.size());
        let foveation = Simulator::new(device, &Desc::new(size, FORMAT))?;
        Ok(Self { pattern, foveation, color: texture(device, size, FORMAT) })
    }
}

impl App {
    fn new(events: &ActiveEventLoop) -> Result<Self, Box<dyn Error>> {
        let window = Arc::new(events.create_window(Window::default_attributes().with_title("your application"))?);
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
        let surface = instance.create_surface(window.clone())?;
        let options = wgpu::RequestAdapterOptions { compatible_surface: Some(&surface), ..Default::default() };
        let adapter = pollster::block_on(instance.request_adapter(&options))?;
        // No features, and no more than WebGPU's limits.
        let (device, queue) = pollster::block_on(adapter.request_device(&Default::default()))?;
        let size = [window.inner_size().width.max(1), window.inner_size().height.max(1)];
        let config = surface.get_default_config(&adapter, size[0], size[1]).ok_or("no format for this window")?;
        surface.configure(&device, &config);
        Ok(Self {
            // (1)
            post: Afterimage::new(&device, &Desc::new(size, FORMAT))?,
            output: texture(&device, size, FORMAT),
            blitter: TextureBlitter::new(&device, config.format),
            renderer: Renderer::new(&device, &queue, size)?,
            gaze: Gaze::Lost,
            index: 0,
            window,
            device,
            queue,
            surface,
            config,
        })
    }

    fn resize(&mut self, size: [u32; 2]) -> Result<(), Box<dyn Error>> {
        // A minimised window is 0x0: keep the context and its history.
        if !size.contains(&0) && size != [self.config.width, self.config.height] {
            [self.config.width, self.config.height] = size;
            self.surface.configure(&self.device, &self.config);
            self.renderer = Renderer::new(&self.device, &self.queue, size)?;
            self.output = texture(&self.device, size, FORMAT);
            // (2) Discards history.
            self.post.resize(size)?;
        }
        Ok(())
    }

    fn frame(&mut self) -> Result<(), Box<dyn Error>> {
        let target = match self.surface.get_current_texture() {
            CurrentSurfaceTexture::Success(target) | CurrentSurfaceTexture::Suboptimal(target) => target,
            CurrentSurfaceTexture::Outdated => {
                self.surface.configure(&self.device, &self.config);
                return Ok(());
            }
            CurrentSurfaceTexture::Lost | CurrentSurfaceTexture::Validation => return Err("the surface is lost".into()),
            CurrentSurfaceTexture::Timeout | CurrentSurfaceTexture::Occluded => return Ok(()),
        };
        let mut encoder = self.device.create_command_encoder(&Default::default());
        let geometry = ViewGeometry::flat([self.config.width, self.config.height], 70.0)?;
        let views = [ViewFrame::new(geometry, self.gaze)];
        // Your renderer would draw the foveated frame here.
        let Renderer { pattern, foveation, color } = &mut self.renderer;
        foveation.record(&mut encoder, &SimulatorFrame::new(pattern, color, &views))?;
        // (3) The post-process.
        let frame = Frame::new(&*color, &views, self.index);
        self.post.record(&mut encoder, &frame, &self.output)?;
        // Your tone mapping would come here.
        let [output, screen] = [&self.output, &target.texture].map(|t| t.create_view(&Default::default()));
        self.blitter.copy(&self.device, &mut encoder, &output, &screen);
        self.queue.submit([encoder.finish()]);
        self.queue.present(target);
        self.index += 1;
        Ok(())
    }
}

/// Handler of the window's events.
#[derive(Default)]
struct Shell {
    app: Option<App>,
    frames: Option<u64>,
    outcome: Option<Box<dyn Error>>,
}

impl Shell {
    fn handle(&mut self, events: &ActiveEventLoop, event: &WindowEvent) -> Result<(), Box<dyn Error>> {
        let Some(app) = &mut self.app else { return Ok(()) };
        match event {
            WindowEvent::CloseRequested => events.exit(),
            WindowEvent::Resized(size) => app.resize([size.width, size.height])?,
            // (4) Pixel centres are whole numbers.
            WindowEvent::CursorMoved { position, .. } => {
                app.gaze = Gaze::At { px: [position.x as f32 - 0.5, position.y as f32 - 0.5] };
            }
            WindowEvent::RedrawRequested if self.frames.is_some_and(|frames| app.index >= frames) => events.exit(),
            WindowEvent::RedrawRequested => {
                app.frame()?;
                app.window.request_redraw();
            }
            _ => {}
        }
        Ok(())
    }

    fn check<T>(&mut self, events: &ActiveEventLoop, result: Result<T, Box<dyn Error>>) -> Option<T> {
        result.map_err(|error| (self.outcome = Some(error), events.exit())).ok()
    }
}

impl ApplicationHandler for Shell {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        self.app = self.check(events, App::new(events));
    }

    fn window_event(&mut self, events: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        let handled = self.handle(events, &event);
        self.check(events, handled);
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let frames = std::env::var("AFTERIMAGE_FRAMES").ok().and_then(|n| n.parse().ok());
    let mut shell = Shell { frames, ..Shell::default() };
    EventLoop::new()?.run_app(&mut shell)?;
    shell.outcome.map_or(Ok(()), Err)
}
