//! A device without a window, with uploads and readbacks. For experiments only: an engine keeps its frames on its own
//! device and calls [`Afterimage`](afterimage::gpu::Afterimage) directly.

use super::{empty_buffer, texture_desc, wait_mapped};
use afterimage::{FrameError, FrameStats, Image};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use wgpu::{Buffer, BufferUsages, Texture, TextureFormat, TextureUsages};

/// A device without a window.
#[derive(Debug)]
pub struct Headless {
    /// Device with default limits unless others were requested, and with timestamp queries where the adapter has them.
    pub device: wgpu::Device,
    /// Queue of the device.
    pub queue: wgpu::Queue,
    /// Adapter name, driver, driver version and device type.
    pub info: wgpu::AdapterInfo,
    is_lost: Arc<AtomicBool>,
    readbacks: AtomicU64,
}

impl Headless {
    /// An instance of wgpu without its debugging flags, in dev builds too: with them, naga searches the line of every
    /// expression from the start of the source. `WGPU_DEBUG=1` switches them on.
    pub fn instance() -> wgpu::Instance {
        let mut desc = wgpu::InstanceDescriptor::new_without_display_handle();
        desc.flags = wgpu::InstanceFlags::empty().with_env();
        wgpu::Instance::new(desc)
    }

    /// All adapters of this machine.
    pub fn adapters() -> Vec<wgpu::Adapter> {
        pollster::block_on(Self::instance().enumerate_adapters(wgpu::Backends::PRIMARY))
    }

    /// Sorts adapters from the best to the last, which are software. If the environment variable `AFTERIMAGE_ADAPTER`
    /// is set, removes those without this text in the name, in any case.
    pub fn sort(adapters: &mut Vec<wgpu::Adapter>) {
        if let Ok(wish) = std::env::var("AFTERIMAGE_ADAPTER") {
            adapters.retain(|adapter| is_wished(&adapter.get_info(), &wish));
        }
        adapters.sort_by_key(rank);
    }

    /// The first hardware GPU; with `software`, a software adapter if the machine has no GPU. `None` if no such adapter
    /// creates a device with default limits. The environment variable `AFTERIMAGE_ADAPTER` chooses by a part of the
    /// name.
    pub fn find(software: bool) -> Option<Arc<Self>> {
        Self::find_with(software, |_| wgpu::Limits::default())
    }

    /// As [`find`](Self::find), with the adapter's largest limits on textures and buffers: for scenes.
    pub fn find_roomy(software: bool) -> Option<Arc<Self>> {
        Self::find_with(software, |offered| wgpu::Limits {
            max_texture_dimension_2d: offered.max_texture_dimension_2d,
            max_buffer_size: offered.max_buffer_size,
            max_storage_buffer_binding_size: offered.max_storage_buffer_binding_size,
            ..wgpu::Limits::default()
        })
    }

    fn find_with(software: bool, limits: impl Fn(&wgpu::Limits) -> wgpu::Limits) -> Option<Arc<Self>> {
        let mut adapters = Self::adapters();
        Self::sort(&mut adapters);
        adapters.retain(|a| software || rank(a) < 3);
        adapters.iter().find_map(|adapter| Self::on(adapter, limits(&adapter.limits())).ok())
    }

    /// Creates a device of this adapter.
    ///
    /// # Errors
    /// If the adapter cannot create a device with these limits.
    pub fn on(adapter: &wgpu::Adapter, limits: wgpu::Limits) -> Result<Arc<Self>, wgpu::RequestDeviceError> {
        let request = adapter.request_device(&wgpu::DeviceDescriptor {
            label: Some("afterimage"),
            required_features: adapter.features() & wgpu::Features::TIMESTAMP_QUERY,
            required_limits: limits,
            ..wgpu::DeviceDescriptor::default()
        });
        let (device, queue) = pollster::block_on(request)?;
        let is_lost = Arc::new(AtomicBool::new(false));
        let lost_flag = is_lost.clone();
        device.set_device_lost_callback(move |_, _| lost_flag.store(true, Ordering::Relaxed));
        Ok(Arc::new(Self { device, queue, info: adapter.get_info(), is_lost, readbacks: AtomicU64::new(0) }))
    }

    /// Whether the device is a software renderer on the CPU.
    pub fn is_software(&self) -> bool {
        self.info.device_type == wgpu::DeviceType::Cpu
    }

    /// Whether the device is still usable. Call it after each readback: readbacks from a lost device are zeros.
    ///
    /// # Errors
    /// [`FrameError::DeviceLost`] once the device is lost.
    pub fn check(&self) -> Result<(), FrameError> {
        if self.is_lost.load(Ordering::Relaxed) { Err(FrameError::DeviceLost) } else { Ok(()) }
    }

    /// Number of textures and buffers that were read back from this device so far. A frame that stays on the device
    /// adds none.
    pub fn readbacks(&self) -> u64 {
        self.readbacks.load(Ordering::Relaxed)
    }

    /// Waits until all submitted work is complete.
    pub fn wait(&self) {
        // A lost device is reported by the next map.
        let _ = self.device.poll(wgpu::PollType::wait_indefinitely());
    }

    /// A 2D texture of `size` pixels with `layers` array layers and one mip level.
    pub fn texture(&self, size: [u32; 2], layers: u32, format: TextureFormat, usage: TextureUsages) -> Texture {
        let desc = texture_desc("afterimage frame", size, format, usage);
        let size = wgpu::Extent3d { depth_or_array_layers: layers, ..desc.size };
        self.device.create_texture(&wgpu::TextureDescriptor { size, ..desc })
    }

    /// A buffer for [`Target::counters`](afterimage::gpu::Target::counters).
    pub fn counters(&self) -> Buffer {
        let usage = BufferUsages::STORAGE | BufferUsages::COPY_DST | BufferUsages::COPY_SRC;
        self.buffer(FrameStats::COUNTERS_BYTES, usage)
    }

    /// Writes a layer of a texture whose texels have the memory layout of the image's pixels.
    pub fn write<T: bytemuck::NoUninit>(&self, texture: &Texture, layer: u32, image: &Image<T>) {
        self.write_bytes(texture, layer, bytemuck::cast_slice(image.pixels()));
    }

    /// Writes a layer of a texture from the bytes of its texels, in row order without padding.
    pub fn write_bytes(&self, texture: &Texture, layer: u32, bytes: &[u8]) {
        let mut to = texture.as_image_copy();
        to.origin.z = layer;
        let layout = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(bytes.len() as u32 / texture.height()),
            rows_per_image: None,
        };
        let size = wgpu::Extent3d { depth_or_array_layers: 1, ..texture.size() };
        self.queue.write_texture(to, bytes, layout, size);
    }

    /// Writes a layer of an `Rgba32Float` texture.
    pub fn write_rgb(&self, texture: &Texture, layer: u32, image: &Image<[f32; 3]>) {
        self.write(texture, layer, &image.map(|[r, g, b]| [r, g, b, 1.0]));
    }

    /// Waits for submitted work and reads a layer of an `Rgba32Float` texture.
    pub fn read_rgb(&self, texture: &Texture, layer: u32) -> Image<[f32; 3]> {
        self.read::<[f32; 4]>(texture, layer).map(|[r, g, b, _]| [r, g, b])
    }

    /// Waits for submitted work and reads a layer of a texture whose texels have the memory layout of `T`.
    pub fn read<T: bytemuck::Pod>(&self, texture: &Texture, layer: u32) -> Image<T> {
        let [width, height] = [texture.width(), texture.height()];
        let padded = (width * size_of::<T>() as u32).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(padded), rows_per_image: None };
        let bytes = self.read_back(u64::from(padded) * u64::from(height), |encoder, buffer| {
            let mut from = texture.as_image_copy();
            from.origin.z = layer;
            let size = wgpu::Extent3d { depth_or_array_layers: 1, ..texture.size() };
            encoder.copy_texture_to_buffer(from, wgpu::TexelCopyBufferInfo { buffer, layout }, size);
        });
        let mut image = Image::filled([width, height], T::zeroed());
        let rows = image.pixels_mut().chunks_mut(width as usize);
        for (to, from) in rows.zip(bytes.chunks_exact(padded as usize)) {
            let to: &mut [u8] = bytemuck::cast_slice_mut(to);
            to.copy_from_slice(&from[..to.len()]);
        }
        image
    }

    /// Waits for submitted work and reads the counters.
    pub fn read_counters(&self, counters: &Buffer) -> FrameStats {
        let bytes = self.read_back(FrameStats::COUNTERS_BYTES, |encoder, buffer| {
            encoder.copy_buffer_to_buffer(counters, 0, buffer, 0, FrameStats::COUNTERS_BYTES);
        });
        FrameStats::from_counters(&bytes).expect("the readback has COUNTERS_BYTES bytes")
    }

    /// Waits for submitted work and reads a buffer with usage `COPY_SRC`.
    pub fn read_buffer(&self, from: &Buffer) -> Vec<u8> {
        self.read_back(from.size(), |encoder, to| encoder.copy_buffer_to_buffer(from, 0, to, 0, from.size()))
    }

    pub(crate) fn buffer(&self, size: u64, usage: BufferUsages) -> Buffer {
        empty_buffer(&self.device, "afterimage", size, usage)
    }

    fn read_back(&self, size: u64, copy: impl FnOnce(&mut wgpu::CommandEncoder, &Buffer)) -> Vec<u8> {
        self.readbacks.fetch_add(1, Ordering::Relaxed);
        // On a lost device the buffer is invalid, and mapping it would be an uncaptured error, which panics.
        let scope = self.device.push_error_scope(wgpu::ErrorFilter::Validation);
        let buffer = self.buffer(size, BufferUsages::COPY_DST | BufferUsages::MAP_READ);
        let mut encoder = self.device.create_command_encoder(&Default::default());
        copy(&mut encoder, &buffer);
        self.queue.submit([encoder.finish()]);
        let bytes = wait_mapped(&self.device, &buffer);
        let error = pollster::block_on(scope.pop());
        bytes.map(|bytes| bytes.to_vec()).unwrap_or_else(|| {
            let is_lost = self.is_lost.load(Ordering::Relaxed);
            assert!(is_lost, "{error:?}: a bug in this package");
            vec![0; size as usize]
        })
    }
}

/// Place among adapters: the lower, the better.
fn rank(adapter: &wgpu::Adapter) -> u32 {
    match adapter.get_info().device_type {
        wgpu::DeviceType::DiscreteGpu => 0,
        wgpu::DeviceType::IntegratedGpu => 1,
        wgpu::DeviceType::VirtualGpu | wgpu::DeviceType::Other => 2,
        wgpu::DeviceType::Cpu => 3,
    }
}

/// Whether the text stands in the name of the adapter or of its driver.
fn is_wished(info: &wgpu::AdapterInfo, wish: &str) -> bool {
    [&info.name, &info.driver].iter().any(|name| name.to_lowercase().contains(&wish.to_lowercase()))
}
