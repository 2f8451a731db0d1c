//! An application without a window that renders to an image, frame by frame.

use afterimage::wgpu;
use bevy::app::{PluginGroupBuilder, Plugins, PluginsState};
use bevy::asset::{RenderAssetUsages, UnapprovedPathMode};
use bevy::camera::RenderTarget;
use bevy::log::LogPlugin;
use bevy::prelude::*;
use bevy::render::RenderApp;
use bevy::render::RenderPlugin;
use bevy::render::error_handler::{RenderErrorHandler, RenderErrorPolicy};
use bevy::render::pipelined_rendering::PipelinedRenderingPlugin;
use bevy::render::render_asset::RenderAssets;
use bevy::render::render_resource::{CachedPipelineState, PipelineCache, TextureFormat, TextureUsages};
use bevy::render::renderer::{RenderAdapterInfo, RenderDevice, RenderQueue};
use bevy::render::settings::{Backends, RenderCreation, WgpuSettings};
use bevy::render::texture::GpuImage;
use bevy::time::TimeUpdateStrategy;
use bevy::window::ExitCondition;
use bevy_afterimage::AfterimagePlugin;
use std::time::Duration;

pub use bevy_afterimage::afterimage;

/// Time between two frames.
pub const FRAME: Duration = Duration::from_nanos(16_666_667);

/// Validation errors that wgpu reported.
#[derive(Resource, Default, Debug)]
pub struct Problems(pub Vec<String>);

pub struct Headless {
    pub app: App,
    /// Image that cameras render to.
    pub target: Handle<Image>,
}

impl Headless {
    /// An application with Bevy's default plugins, `AfterimagePlugin`, and a scene.
    pub fn new<M>(size: UVec2, scene: impl Plugins<M>) -> Self {
        Self::with(size, |app| {
            app.add_plugins(AfterimagePlugin).add_plugins(scene);
        })
    }

    /// An application with Bevy's default plugins, and what `add` adds.
    pub fn with(size: UVec2, add: impl FnOnce(&mut App)) -> Self {
        let mut app = App::new();
        add_default_plugins(&mut app);
        add(&mut app);
        note_problems(&mut app);
        start(&mut app);
        let target = app.world_mut().resource_mut::<Assets<Image>>().add(target_image(size));
        let mut headless = Self { app, target };
        // Bevy loads its shaders on other threads: with them there from the first frame, runs are alike.
        for _ in 0..8 {
            headless.frames(1);
            std::thread::sleep(Duration::from_millis(25));
        }
        headless
    }

    /// What a camera needs to render to the image.
    pub fn render_target(&self) -> RenderTarget {
        self.target.clone().into()
    }

    /// The name of the adapter.
    pub fn adapter(&self) -> String {
        let info = self.app.sub_app(RenderApp).world().resource::<RenderAdapterInfo>();
        format!("{} ({})", info.name, info.driver_info)
    }

    /// Adds an asset.
    pub fn asset<A: Asset>(&mut self, asset: A) -> Handle<A> {
        self.app.world_mut().resource_mut::<Assets<A>>().add(asset)
    }

    /// Another image that cameras can render to.
    pub fn add_target(&mut self, size: UVec2) -> Handle<Image> {
        self.asset(target_image(size))
    }

    /// Renders frames.
    pub fn frames(&mut self, count: usize) {
        (0..count).for_each(|_| self.app.update());
    }

    /// Makes an image that cameras render to another size, as a window's.
    pub fn resize(&mut self, target: &Handle<Image>, size: UVec2) {
        let image = target_image(size);
        let world = self.app.world_mut();
        world.resource_mut::<Assets<Image>>().insert(target, image).expect("the target exists");
        // Cameras learn of a window's new size at once, of an image's one frame later; but when projections change,
        // too.
        let mut projections = world.query::<&mut Projection>();
        projections.iter_mut(world).for_each(|mut projection| projection.set_changed());
    }

    /// Waits for the device.
    pub fn wait(&self) {
        let device = self.app.sub_app(RenderApp).world().resource::<RenderDevice>().clone();
        let _ = device.poll(wgpu::PollType::wait_indefinitely());
    }

    /// Renders a frame and reads the image: red, green, blue, alpha, encoded as sRGB.
    pub fn shot(&mut self) -> Vec<u8> {
        self.app.update();
        self.read()
    }

    /// Reads the image.
    pub fn read(&self) -> Vec<u8> {
        self.read_target(&self.target)
    }

    /// Reads an image that cameras render to.
    pub fn read_target(&self, target: &Handle<Image>) -> Vec<u8> {
        let world = self.app.sub_app(RenderApp).world();
        let (device, queue) = (world.resource::<RenderDevice>().wgpu_device(), world.resource::<RenderQueue>());
        let image = world.resource::<RenderAssets<GpuImage>>().get(target).expect("a rendered image");
        let [w, h] = [image.texture.width(), image.texture.height()];
        let stride = (4 * w).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let buffer = device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: u64::from(stride * h),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let mut encoder = device.create_command_encoder(&Default::default());
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(stride), rows_per_image: None };
        encoder.copy_texture_to_buffer(
            image.texture.as_image_copy(),
            wgpu::TexelCopyBufferInfo { buffer: &buffer, layout },
            image.texture.size(),
        );
        queue.submit([encoder.finish()]);
        buffer.map_async(wgpu::MapMode::Read, .., |result| result.expect("mapped"));
        device.poll(wgpu::PollType::wait_indefinitely()).expect("the device");
        let bytes = buffer.get_mapped_range(..).expect("mapped");
        bytes.chunks(stride as usize).flat_map(|row| &row[..4 * w as usize]).copied().collect()
    }

    /// Validation errors so far, and shaders that cannot be compiled: what they draw is missing.
    pub fn problems(&self) -> Vec<String> {
        let cache = self.app.sub_app(RenderApp).world().resource::<PipelineCache>();
        let failed = cache.pipelines().filter_map(|pipeline| match &pipeline.state {
            CachedPipelineState::Err(error) => Some(error.to_string()),
            _ => None,
        });
        self.app.world().resource::<Problems>().0.iter().cloned().chain(failed).collect()
    }
}

/// Adds Bevy's default plugins, without a window, and without a thread of its own for the renderer: it would take
/// [`RenderApp`] with it.
pub fn add_default_plugins(app: &mut App) {
    app.add_plugins(default_plugins().disable::<PipelinedRenderingPlugin>());
}

/// Bevy's default plugins, without a window.
pub fn default_plugins() -> PluginGroupBuilder {
    let settings = WgpuSettings { backends: Some(Backends::VULKAN), ..default() };
    DefaultPlugins
        .set(RenderPlugin {
            render_creation: RenderCreation::Automatic(Box::new(settings)),
            // Otherwise the first frames lack what is not compiled yet.
            synchronous_pipeline_compilation: true,
            ..default()
        })
        // Models may lie anywhere.
        .set(AssetPlugin { unapproved_path_mode: UnapprovedPathMode::Allow, ..default() })
        .set(WindowPlugin { primary_window: None, exit_condition: ExitCondition::DontExit, ..default() })
        .disable::<LogPlugin>()
}

/// Notes validation errors, and has frames follow each other in the scene's time.
pub fn note_problems(app: &mut App) {
    app.insert_resource(TimeUpdateStrategy::ManualDuration(FRAME)).init_resource::<Problems>().insert_resource(
        RenderErrorHandler(|error, main, _| {
            main.resource_mut::<Problems>().0.push(error.description.clone());
            RenderErrorPolicy::Ignore
        }),
    );
}

/// Does what `App::run` does before the first frame.
pub fn start(app: &mut App) {
    while app.plugins_state() == PluginsState::Adding {
        bevy::tasks::tick_global_task_pools_on_main_thread();
    }
    app.finish();
    app.cleanup();
}

pub fn target_image(size: UVec2) -> Image {
    let mut image = Image::new_target_texture(size.x, size.y, TextureFormat::Rgba8UnormSrgb, None);
    image.texture_descriptor.usage |= TextureUsages::COPY_SRC;
    image.asset_usage = RenderAssetUsages::default();
    image
}

/// Peak signal-to-noise ratio of two images with alpha, in dB, of the encoded values.
pub fn psnr_db(a: &[u8], b: &[u8]) -> f64 {
    assert_eq!(a.len(), b.len(), "images of one size");
    let squares: u64 = a
        .chunks_exact(4)
        .zip(b.chunks_exact(4))
        .flat_map(|(a, b)| (0..3).map(move |i| u64::from(a[i].abs_diff(b[i])).pow(2)))
        .sum();
    10.0 * (255.0 * 255.0 * (a.len() / 4 * 3) as f64 / squares.max(1) as f64).log10()
}

/// Reads an image that [`write_png`] wrote, with alpha.
pub fn read_png(path: &std::path::Path) -> Result<(UVec2, Vec<u8>), Box<dyn std::error::Error>> {
    let mut reader = png::Decoder::new(std::io::BufReader::new(std::fs::File::open(path)?)).read_info()?;
    let mut rgb = vec![0; reader.output_buffer_size().ok_or("a size")?];
    reader.next_frame(&mut rgb)?;
    let size = UVec2::new(reader.info().width, reader.info().height);
    Ok((size, rgb.chunks_exact(3).flat_map(|pixel| [pixel[0], pixel[1], pixel[2], 255]).collect()))
}

/// Writes an image as PNG.
pub fn write_png(path: &std::path::Path, size: UVec2, rgba: &[u8]) -> Result<(), Box<dyn std::error::Error>> {
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder)?;
    }
    let mut encoder = png::Encoder::new(std::io::BufWriter::new(std::fs::File::create(path)?), size.x, size.y);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    let rgb: Vec<u8> = rgba.chunks_exact(4).flat_map(|pixel| &pixel[..3]).copied().collect();
    encoder.write_header()?.write_image_data(&rgb)?;
    Ok(())
}
