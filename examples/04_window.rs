//! The smallest application with a window: a renderer draws a tenth of the pixels, most of them around the mouse, which
//! is the gaze, and a blit copies the picture to the swapchain.
//!
//! The post-process adds to an application the fields `post`, `targets` and `gaze` of `App`, and the lines marked (1)
//! to (4).
//!
//! `cargo run --release --example 04_window` (closes by itself after AFTERIMAGE_FRAMES frames, if that is set)

mod headless;

use afterimage::wgpu::{self, Color, CurrentSurfaceTexture, TextureFormat, util::TextureBlitter};
use afterimage::{Afterimage, Camera, Desc, Gaze, MotionConvention, Shading, Targets};
use glam::{Mat4, Vec3, camera::rh::proj::directx::perspective_infinite_reverse};
use headless::Headless;
use headless::renderer::{Renderer, View};
use std::{error::Error, sync::Arc};
use winit::application::ApplicationHandler;
use winit::event::WindowEvent;
use winit::event_loop::{ActiveEventLoop, EventLoop};
use winit::window::{Window, WindowId};

/// Format of colors and of the picture. Compute shaders can rarely write a swapchain's format: write this one, and draw
/// it to the screen.
const FORMAT: TextureFormat = TextureFormat::Rgba16Float;

/// The application: a window, its device, a renderer, and the post-process.
struct App {
    window: Arc<Window>,
    gpu: Headless,
    surface: wgpu::Surface<'static>,
    config: wgpu::SurfaceConfiguration,
    blitter: TextureBlitter,
    renderer: Renderer,
    targets: Targets,
    post: Afterimage,
    gaze: Gaze,
    index: u64,
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
        let gpu = Headless { device, queue };
        let size = [window.inner_size().width.max(1), window.inner_size().height.max(1)];
        let config = surface.get_default_config(&adapter, size[0], size[1]).ok_or("no format for this window")?;
        surface.configure(&gpu.device, &config);
        // (1) A tenth of the pixels; the renderer's vectors are of objects alone.
        let motion = Some(MotionConvention { without_camera: true, ..MotionConvention::BEVY });
        let shading = Shading::Gaze { fovea_deg: 5.0, share: 0.08 };
        let post = Afterimage::new(&gpu.device, &Desc { motion, shading, ..Desc::new(size, FORMAT) })?;
        Ok(Self {
            blitter: TextureBlitter::new(&gpu.device, config.format),
            renderer: Renderer::new(&gpu, FORMAT, FORMAT),
            targets: Targets::new(&gpu.device, post.desc(), FORMAT),
            post,
            gaze: Gaze::Lost,
            index: 0,
            window,
            gpu,
            surface,
            config,
        })
    }

    fn resize(&mut self, size: [u32; 2]) -> Result<(), Box<dyn Error>> {
        // A minimised window is 0x0: keep the context and its history.
        if !size.contains(&0) && size != [self.config.width, self.config.height] {
            [self.config.width, self.config.height] = size;
            self.surface.configure(&self.gpu.device, &self.config);
            // (2) Discards history.
            self.post.resize(size)?;
            self.targets = Targets::new(&self.gpu.device, self.post.desc(), FORMAT);
        }
        Ok(())
    }

    fn frame(&mut self) -> Result<(), Box<dyn Error>> {
        let screen = match self.surface.get_current_texture() {
            CurrentSurfaceTexture::Success(screen) | CurrentSurfaceTexture::Suboptimal(screen) => screen,
            CurrentSurfaceTexture::Outdated => {
                self.surface.configure(&self.gpu.device, &self.config);
                return Ok(());
            }
            CurrentSurfaceTexture::Lost | CurrentSurfaceTexture::Validation => return Err("the surface is lost".into()),
            CurrentSurfaceTexture::Timeout | CurrentSurfaceTexture::Occluded => return Ok(()),
        };
        let (gpu, targets) = (&self.gpu, &self.targets);
        let aspect = self.config.width as f32 / self.config.height as f32;
        let clip_from_view = perspective_infinite_reverse(0.75, aspect, 0.1).to_cols_array_2d();
        let seconds = [self.index, self.index.saturating_sub(1)].map(|index| index as f32 / 60.0);
        let world_from_view = Mat4::from_translation(Vec3::new(0.5 * seconds[0].sin(), 1.5, 0.0));
        // (3) The post-process: all of the frame is drawn with the jittered projection, colors where depth is left.
        let jittered = Mat4::from_cols_array_2d(&self.post.jittered(clip_from_view));
        let view = View { clip_from_world: jittered * world_from_view.inverse(), seconds };
        let camera = Camera { gaze: self.gaze, ..Camera::new(clip_from_view, world_from_view.to_cols_array_2d()) };
        let mut encoder = gpu.encoder();
        self.renderer.prepass(gpu, targets.prepass(&mut encoder, 0, &camera), view);
        let plan = self.post.plan(&mut encoder, &targets.frame(camera))?;
        targets.close(&mut encoder, &mut self.post, &plan)?;
        self.renderer.colors(gpu, targets.color_pass(&mut encoder, 0, Color::BLACK), view);
        self.post.show(&mut encoder, plan, &targets.color, &targets.output)?;
        // Your tone mapping would come here.
        let [picture, shown] = [&targets.output, &screen.texture].map(|t| t.create_view(&Default::default()));
        self.blitter.copy(&gpu.device, &mut encoder, &picture, &shown);
        gpu.submit(encoder);
        gpu.queue.present(screen);
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
