//! The device that draws to a window: chosen, watched for messages and for its loss.

use crate::failure::Failure;
use crate::run::NO_ADAPTER;
use afterimage::pipeline::Headless;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
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
    lost: Arc<AtomicBool>,
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
        gpu.device.on_uncaptured_error(Arc::new(|error| {
            // One mistake is followed by many that come of it.
            if MESSAGES.fetch_add(1, Ordering::Relaxed) > 0 {
                return;
            }
            eprintln!("afterimage: the device says: {}", error.to_string().replace('\n', " "));
        }));
        let lost = Arc::new(AtomicBool::new(false));
        let told = lost.clone();
        gpu.device.set_device_lost_callback(move |_, _| told.store(true, Ordering::Release));
        let capabilities = surface.get_capabilities(adapter);
        Ok(Self { gpu, surface, capabilities, instance, lost })
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
        self.lost.load(Ordering::Acquire)
    }
}

fn create_surface(instance: &wgpu::Instance, window: &Arc<Window>) -> Result<wgpu::Surface<'static>, Failure> {
    instance.create_surface(window.clone()).map_err(|e| Failure::Work(format!("a window cannot be drawn to ({e})")))
}
