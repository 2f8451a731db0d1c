//! A device without a window, with uploads and downloads of textures, for the examples.
#![allow(dead_code, reason = "no example uses all of it")]

pub mod renderer;

use afterimage::wgpu::util::DownloadBuffer;
use afterimage::wgpu::{self, Buffer, BufferUsages, CommandEncoder, Texture, TextureFormat, TextureUsages};

/// A device and its queue.
pub struct Headless {
    pub device: wgpu::Device,
    pub queue: wgpu::Queue,
}

impl Headless {
    /// A device on the default adapter. Software Vulkan is in the package mesa-vulkan-drivers.
    pub fn new() -> Result<Self, Box<dyn std::error::Error>> {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
        let adapter = pollster::block_on(instance.request_adapter(&wgpu::RequestAdapterOptions::default()))?;
        println!("on {}", adapter.get_info().name);
        let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor::default()))?;
        Ok(Self { device, queue })
    }

    /// A texture of `layers` layers.
    pub fn texture(&self, size: [u32; 2], layers: u32, format: TextureFormat, usage: TextureUsages) -> Texture {
        self.device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: layers },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage,
            view_formats: &[],
        })
    }

    pub fn buffer(&self, size: u64, usage: BufferUsages) -> Buffer {
        self.device.create_buffer(&wgpu::BufferDescriptor { label: None, size, usage, mapped_at_creation: false })
    }

    pub fn encoder(&self) -> CommandEncoder {
        self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default())
    }

    pub fn submit(&self, encoder: CommandEncoder) {
        self.queue.submit([encoder.finish()]);
    }

    /// Fills a layer of an `Rgba32Float` texture with `color(x, y)` at each pixel.
    pub fn write(&self, texture: &Texture, layer: u32, color: impl Fn(u32, u32) -> [f32; 3]) {
        let (width, height) = (texture.width(), texture.height());
        let pixels: Vec<[f32; 4]> = (0..width * height)
            .map(|i| {
                let [r, g, b] = color(i % width, i / width);
                [r, g, b, 1.0]
            })
            .collect();
        let mut to = texture.as_image_copy();
        to.origin.z = layer;
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(width * 16), rows_per_image: None };
        let size = wgpu::Extent3d { depth_or_array_layers: 1, ..texture.size() };
        self.queue.write_texture(to, bytemuck::cast_slice(&pixels), layout, size);
    }

    /// All pixels of a layer of an `Rgba32Float` texture whose width is a multiple of 16, row after row.
    pub fn read(&self, texture: &Texture, layer: u32) -> Vec<[f32; 4]> {
        let (width, height) = (texture.width(), texture.height());
        let buffer = self.buffer(u64::from(width * height * 16), BufferUsages::COPY_DST | BufferUsages::COPY_SRC);
        let mut from = texture.as_image_copy();
        from.origin.z = layer;
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(width * 16), rows_per_image: None };
        let mut encoder = self.encoder();
        let size = wgpu::Extent3d { depth_or_array_layers: 1, ..texture.size() };
        encoder.copy_texture_to_buffer(from, wgpu::TexelCopyBufferInfo { buffer: &buffer, layout }, size);
        self.submit(encoder);
        bytemuck::pod_collect_to_vec(&self.read_buffer(&buffer))
    }

    /// The bytes of a buffer with the usage `COPY_SRC`.
    pub fn read_buffer(&self, from: &Buffer) -> Vec<u8> {
        let (sender, receiver) = std::sync::mpsc::channel();
        DownloadBuffer::read_buffer(&self.device, &self.queue, &from.slice(..), move |bytes| {
            let _ = sender.send(bytes.expect("the buffer maps").to_vec());
        });
        self.device.poll(wgpu::PollType::wait_indefinitely()).expect("the device finishes");
        receiver.recv().expect("the buffer was mapped")
    }
}
