//! The device that draws to a window: chosen, watched for messages and for its loss.

use crate::args::backend::NO_ADAPTER;
use crate::failure::Failure;
use afterimage_lab::device::Headless;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use winit::window::Window;

/// Messages of validation in this process: any is a mistake in this package.
static MESSAGES: AtomicU64 = AtomicU64::new(0);

/// Messages of validation so far.
pub fn messages() -> u64 {
    MESSAGES.load(Ordering::Relaxed)
}

/// A device and the surface of a window.
pub struct Device {
    pub gpu: Arc<Headless>,
    pub surface: wgpu::Surface<'static>,
    pub capabilities: wgpu::SurfaceCapabilities,
    instance: wgpu::Instance,
}

impl Device {
    /// The best device that can draw to `window`, software ones last.
    pub fn open(window: &Arc<Window>) -> Result<Self, Failure> {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
        let surface = create_surface(&instance, window)?;
        let mut adapters = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::PRIMARY));
        adapters.retain(|adapter| adapter.is_surface_supported(&surface));
        adapters.sort_by_key(|adapter| match adapter.get_info().device_type {
            wgpu::DeviceType::DiscreteGpu => 0,
            wgpu::DeviceType::IntegratedGpu => 1,
            wgpu::DeviceType::VirtualGpu | wgpu::DeviceType::Other => 2,
            wgpu::DeviceType::Cpu => 3,
        });
        let limits = |offered: wgpu::Limits| wgpu::Limits {
            max_texture_dimension_2d: offered.max_texture_dimension_2d,
            ..wgpu::Limits::default()
        };
        let found = adapters.iter().find_map(|a| Some((Headless::on(a, limits(a.limits())).ok()?, a)));
        let (gpu, adapter) =
            found.ok_or_else(|| Failure::Work(format!("a window cannot be drawn to: {NO_ADAPTER}")))?;
        let watched = Arc::downgrade(&gpu);
        gpu.device.on_uncaptured_error(Arc::new(move |error| {
            // What a device says that is lost is no mistake, and of a mistake come many.
            let is_lost = watched.upgrade().is_some_and(|gpu| gpu.check().is_err());
            if is_lost || MESSAGES.fetch_add(1, Ordering::Relaxed) > 0 {
                return;
            }
            eprintln!("afterimage: the device says: {}", error.to_string().replace('\n', " "));
        }));
        let capabilities = surface.get_capabilities(adapter);
        Ok(Self { gpu, surface, capabilities, instance })
    }

    /// Makes the surface anew, on the same device.
    pub fn renew_surface(&mut self, window: &Arc<Window>) -> Result<(), Failure> {
        self.surface = create_surface(&self.instance, window)?;
        Ok(())
    }

    /// Whether the device has gone.
    pub fn is_lost(&self) -> bool {
        // The loss is told by a callback, and callbacks are run by polls.
        let _ = self.gpu.device.poll(wgpu::PollType::Poll);
        self.gpu.check().is_err()
    }
}

fn create_surface(instance: &wgpu::Instance, window: &Arc<Window>) -> Result<wgpu::Surface<'static>, Failure> {
    instance.create_surface(window.clone()).map_err(|e| Failure::Work(format!("a window cannot be drawn to ({e})")))
}

/// Constants of a frame. Nothing that is mapped when it is made, which a lost device cannot do.
pub fn constants<T: bytemuck::NoUninit>(gpu: &Headless, label: &'static str, value: &T) -> wgpu::Buffer {
    let bytes = bytemuck::bytes_of(value);
    let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size: bytes.len() as u64,
        usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    gpu.queue.write_buffer(&buffer, 0, bytes);
    buffer
}
