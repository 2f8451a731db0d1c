//! The post-process on a GPU for frames that live in memory: upload, record, submit, read back. For experiments; an engine
//! keeps its frames on the device and calls [`Afterimage`] itself.

use crate::error::{CreateError, FrameError};
use crate::frame::{ContextDesc, Reset, ViewFrame};
use crate::gpu::{Afterimage, Frame, GpuDesc};
use crate::image::Image;
use crate::kernel::debug_view::DebugView;
use crate::report::clock::Stopwatch;
use crate::settings::{Method, Settings};
use crate::stats::{COUNTERS_BYTES, FrameStats};
use std::sync::Arc;
use wgpu::{Buffer, BufferUsages, CommandEncoder, Texture, TextureFormat, TextureUsages};

/// A device without a window.
#[derive(Debug)]
pub struct Headless {
    /// With default limits, and timestamp queries where the adapter has them.
    pub device: wgpu::Device,
    /// Its queue.
    pub queue: wgpu::Queue,
    /// Adapter, driver, version and kind of device.
    pub info: wgpu::AdapterInfo,
}

impl Headless {
    /// All adapters of this machine.
    pub fn adapters() -> Vec<wgpu::Adapter> {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
        pollster::block_on(instance.enumerate_adapters(wgpu::Backends::PRIMARY))
    }

    /// The first real GPU; with `software`, a software adapter if there is none. `None` if there is nothing of the kind or it
    /// gives no device with default limits.
    pub fn find(software: bool) -> Option<Arc<Self>> {
        let rank = |adapter: &wgpu::Adapter| match adapter.get_info().device_type {
            wgpu::DeviceType::DiscreteGpu => 0,
            wgpu::DeviceType::IntegratedGpu => 1,
            wgpu::DeviceType::VirtualGpu | wgpu::DeviceType::Other => 2,
            wgpu::DeviceType::Cpu => 3,
        };
        let mut adapters = Self::adapters();
        adapters.sort_by_key(rank);
        adapters.retain(|a| software || rank(a) < 3);
        adapters.into_iter().find_map(|adapter| {
            let request = adapter.request_device(&wgpu::DeviceDescriptor {
                label: Some("afterimage"),
                required_features: adapter.features() & wgpu::Features::TIMESTAMP_QUERY,
                ..wgpu::DeviceDescriptor::default()
            });
            let (device, queue) = pollster::block_on(request).ok()?;
            Some(Arc::new(Self { device, queue, info: adapter.get_info() }))
        })
    }

    /// Whether the device is a program on the CPU.
    pub fn is_software(&self) -> bool {
        self.info.device_type == wgpu::DeviceType::Cpu
    }

    /// Waits until the device has done all that was submitted.
    pub fn wait(&self) {
        // A lost device shows at the next map, with wgpu's own message.
        let _ = self.device.poll(wgpu::PollType::wait_indefinitely());
    }
}

/// What one view of a frame brings.
pub(super) struct LaneInput<'a> {
    pub facts: ViewFrame,
    pub color: &'a Image<[f32; 3]>,
    pub depth: Option<&'a Image<f32>>,
    pub motion: Option<&'a Image<[f32; 2]>>,
    pub index: u64,
    pub reset: Reset,
}

/// What came back.
pub(super) struct LaneOutput {
    pub image: Image<[f32; 3]>,
    pub wall_ms: f64,
    pub cpu_ms: Option<f64>,
    pub stats: FrameStats,
    pub traffic_bytes_per_pixel: u32,
    pub debug: Vec<Image<[f32; 3]>>,
}

/// One context and the textures of its frames.
#[derive(Debug)]
pub(super) struct GpuLane {
    gpu: Arc<Headless>,
    post: Afterimage,
    color: Texture,
    depth: Texture,
    motion: Texture,
    output: Texture,
    counters: Buffer,
    /// The output's rows, and after them the counters.
    readback: Buffer,
}

impl GpuLane {
    pub fn new(gpu: &Arc<Headless>, context: ContextDesc, settings: Settings) -> Result<Self, CreateError> {
        let desc = GpuDesc { context, output_format: TextureFormat::Rgba32Float, settings };
        let texture = |format, usage| texture(&gpu.device, context.size_px, format, usage);
        let read = TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST;
        let output = texture(TextureFormat::Rgba32Float, TextureUsages::STORAGE_BINDING | TextureUsages::COPY_SRC);
        let buffer = |label, size, usage| {
            let desc = wgpu::BufferDescriptor { label: Some(label), size, usage, mapped_at_creation: false };
            gpu.device.create_buffer(&desc)
        };
        let counting = BufferUsages::STORAGE | BufferUsages::COPY_DST | BufferUsages::COPY_SRC;
        Ok(Self {
            post: Afterimage::new(&gpu.device, &desc)?,
            color: texture(TextureFormat::Rgba32Float, read),
            depth: texture(TextureFormat::R32Float, read),
            motion: texture(TextureFormat::Rg32Float, read),
            output,
            counters: buffer("afterimage counters", COUNTERS_BYTES, counting),
            readback: buffer(
                "afterimage readback",
                picture_bytes(context.size_px) + COUNTERS_BYTES,
                BufferUsages::COPY_DST | BufferUsages::MAP_READ,
            ),
            gpu: gpu.clone(),
        })
    }

    /// Bytes kept between frames: none for a method without history, whatever was made for one.
    pub fn memory_bytes(&self) -> usize {
        if self.post.desc().settings.method == Method::None { 0 } else { self.post.memory_bytes() as usize }
    }

    pub fn process(&mut self, input: &LaneInput<'_>, debug: &[DebugView]) -> Result<LaneOutput, FrameError> {
        let color: Vec<[f32; 4]> = input.color.pixels().iter().map(|c| [c[0], c[1], c[2], 1.0]).collect();
        self.upload(&self.color, bytemuck::cast_slice(&color));
        if let Some(depth) = input.depth {
            self.upload(&self.depth, bytemuck::cast_slice(depth.pixels()));
        }
        if let Some(motion) = input.motion {
            self.upload(&self.motion, bytemuck::cast_slice(motion.pixels()));
        }
        let frame = Frame {
            depth: input.depth.map(|_| &self.depth),
            motion: input.motion.map(|_| &self.motion),
            reset: input.reset,
            counters: Some(&self.counters),
            ..Frame::new(&self.color, &self.output, std::slice::from_ref(&input.facts), input.index)
        };
        let mut pictures = vec![];
        for &view in debug {
            let mut encoder = self.encoder();
            self.post.record_view(&self.gpu.device, &mut encoder, &frame, view)?;
            self.gpu.queue.submit([encoder.finish()]);
            pictures.push(self.read().0);
        }
        // The uploads are done before the watch starts.
        self.gpu.queue.submit([]);
        self.gpu.wait();
        let watch = Stopwatch::start();
        let mut encoder = self.encoder();
        self.post.record(&self.gpu.device, &mut encoder, &frame)?;
        self.gpu.queue.submit([encoder.finish()]);
        self.gpu.wait();
        let (wall_ms, cpu_ms) = (watch.wall_ms(), watch.cpu_ms());
        let (image, stats) = self.read();
        let given = [input.depth.is_some(), input.motion.is_some(), false];
        let traffic_bytes_per_pixel = self.post.desc().settings.traffic_bytes_per_pixel(given);
        Ok(LaneOutput { image, wall_ms, cpu_ms, stats, traffic_bytes_per_pixel, debug: pictures })
    }

    fn encoder(&self) -> CommandEncoder {
        self.gpu.device.create_command_encoder(&Default::default())
    }

    fn upload(&self, texture: &Texture, bytes: &[u8]) {
        let layout = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(bytes.len() as u32 / texture.height()),
            rows_per_image: None,
        };
        self.gpu.queue.write_texture(texture.as_image_copy(), bytes, layout, texture.size());
    }

    /// The output, and what was counted last.
    fn read(&self) -> (Image<[f32; 3]>, FrameStats) {
        let size = [self.output.width(), self.output.height()];
        let padded = padded_row(size);
        let mut encoder = self.encoder();
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(padded), rows_per_image: None };
        encoder.copy_texture_to_buffer(
            self.output.as_image_copy(),
            wgpu::TexelCopyBufferInfo { buffer: &self.readback, layout },
            self.output.size(),
        );
        encoder.copy_buffer_to_buffer(&self.counters, 0, &self.readback, picture_bytes(size), COUNTERS_BYTES);
        self.gpu.queue.submit([encoder.finish()]);
        self.readback.map_async(wgpu::MapMode::Read, .., |_| ());
        self.gpu.wait();
        let mut image = Image::filled(size, [0.0; 3]);
        let stats = {
            let mapped = self.readback.slice(..).get_mapped_range();
            let mapped = mapped.expect("the readback was mapped and waited for");
            let (picture, counters) = mapped.split_at(picture_bytes(size) as usize);
            let rows = image.pixels_mut().chunks_mut(size[0] as usize);
            for (to, from) in rows.zip(picture.chunks_exact(padded as usize)) {
                let from: &[[f32; 4]] = bytemuck::cast_slice(&from[..size[0] as usize * 16]);
                for (to, from) in to.iter_mut().zip(from) {
                    *to = [from[0], from[1], from[2]];
                }
            }
            FrameStats::from_counters(counters).expect("the counters follow the picture")
        };
        self.readback.unmap();
        (image, stats)
    }
}

fn picture_bytes(size: [u32; 2]) -> u64 {
    u64::from(padded_row(size)) * u64::from(size[1])
}

fn padded_row(size: [u32; 2]) -> u32 {
    (size[0] * 16).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT)
}

fn texture(device: &wgpu::Device, size: [u32; 2], format: TextureFormat, usage: TextureUsages) -> Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some("afterimage frame"),
        size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    })
}
