//! The device that draws to a window: its selection, validation errors, and loss.

use crate::failure::Failure;
use afterimage::wgpu;
use afterimage_lab::device::{Headless, NO_ADAPTER};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use winit::window::Window;

/// Number of validation errors in this process. Each one is a bug in this package.
static VALIDATION_ERRORS: AtomicU64 = AtomicU64::new(0);

/// Number of validation errors so far.
pub fn validation_errors() -> u64 {
    VALIDATION_ERRORS.load(Ordering::Relaxed)
}

/// A device and the surface of a window.
pub struct Device {
    pub gpu: Arc<Headless>,
    pub surface: wgpu::Surface<'static>,
    pub capabilities: wgpu::SurfaceCapabilities,
    instance: wgpu::Instance,
}

impl Device {
    /// Opens the best device that can draw to `window`; software devices come last.
    pub fn open(window: &Arc<Window>) -> Result<Self, Failure> {
        let instance = Headless::instance();
        let surface = create_surface(&instance, window)?;
        let mut adapters = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::PRIMARY));
        adapters.retain(|adapter| adapter.is_surface_supported(&surface));
        Headless::sort(&mut adapters);
        let limits = |offered: wgpu::Limits| wgpu::Limits {
            max_texture_dimension_2d: offered.max_texture_dimension_2d,
            // For scenes.
            max_buffer_size: offered.max_buffer_size,
            max_storage_buffer_binding_size: offered.max_storage_buffer_binding_size,
            ..wgpu::Limits::default()
        };
        let found = adapters.iter().find_map(|a| Some((Headless::on(a, limits(a.limits())).ok()?, a)));
        let (gpu, adapter) =
            found.ok_or_else(|| Failure::Work(format!("no device can draw to the window: {NO_ADAPTER}")))?;
        let watched = Arc::downgrade(&gpu);
        gpu.device.on_uncaptured_error(Arc::new(move |error| {
            // Errors of a lost device are no bugs. Print only the first error, since others often follow from it.
            let is_lost = watched.upgrade().is_some_and(|gpu| gpu.check().is_err());
            if is_lost || VALIDATION_ERRORS.fetch_add(1, Ordering::Relaxed) > 0 {
                return;
            }
            eprintln!("afterimage: the device says: {}", error.to_string().replace('\n', " "));
        }));
        let capabilities = surface.get_capabilities(adapter);
        Ok(Self { gpu, surface, capabilities, instance })
    }

    /// Creates the surface again, on the same device.
    pub fn renew_surface(&mut self, window: &Arc<Window>) -> Result<(), Failure> {
        self.surface = create_surface(&self.instance, window)?;
        Ok(())
    }

    /// Whether the device is lost.
    pub fn is_lost(&self) -> bool {
        // A callback reports the loss, and polling runs callbacks.
        let _ = self.gpu.device.poll(wgpu::PollType::Poll);
        self.gpu.check().is_err()
    }
}

fn create_surface(instance: &wgpu::Instance, window: &Arc<Window>) -> Result<wgpu::Surface<'static>, Failure> {
    instance
        .create_surface(window.clone())
        .map_err(|e| Failure::Work(format!("the window's surface cannot be created ({e})")))
}

/// Maps a buffer for reading, once its work is done. The flag becomes `true` when it is mapped.
pub fn map(buffer: &wgpu::Buffer) -> Arc<AtomicBool> {
    let done = Arc::new(AtomicBool::new(false));
    let is_mapped = done.clone();
    buffer.map_async(wgpu::MapMode::Read, .., move |r| is_mapped.store(r.is_ok(), Ordering::Release));
    done
}

/// Uniform buffer with the constants of a frame. Not mapped at creation, which would fail on a lost device.
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
