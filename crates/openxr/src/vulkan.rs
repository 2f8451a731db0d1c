//! The runtime's Vulkan device as a wgpu device (XR_KHR_vulkan_enable2), and its images as wgpu textures.
#![expect(unsafe_code, reason = "OpenXR hands out Vulkan's objects as raw handles")]

use crate::error::Error;
use ash::vk::{self, Handle};
use openxr as xr;
use std::ffi::CStr;
use wgpu_30::hal::api::Vulkan;
use wgpu_30::hal::{self, vulkan};
use wgpu_30::{
    Device, DeviceDescriptor, Extent3d, Features, InstanceFlags, Limits, MemoryBudgetThresholds, MemoryHints, Queue,
    Texture, TextureDescriptor, TextureDimension, TextureFormat, TextureUsages, TextureUses,
};

/// A wgpu device that the runtime created, and the handles by which sessions are bound to it.
pub(crate) struct Gpu {
    pub device: Device,
    pub queue: Queue,
    handles: xr::vulkan::SessionCreateInfo,
}

impl Gpu {
    /// A device without features beyond WebGPU's.
    pub fn new(instance: &xr::Instance, system: xr::SystemId, required_limits: Limits) -> Result<Self, Error> {
        // The specification requires this call before a device is created.
        instance.graphics_requirements::<xr::Vulkan>(system)?;
        // The newest version that wgpu-hal knows; a runtime's maximum is only the newest version that it was tested
        // with.
        let version = vk::API_VERSION_1_3;
        let failed = |error: &dyn std::fmt::Display| Error::Device(error.to_string());
        // SAFETY: the loader's library stays loaded as long as `entry`, of which wgpu-hal keeps a copy.
        let entry = unsafe { ash::Entry::load() }.map_err(|e| failed(&e))?;
        let flags = InstanceFlags::empty();
        let extensions = vulkan::Instance::desired_extensions(&entry, version, flags).map_err(|e| failed(&e))?;
        let names: Vec<_> = extensions.iter().map(|name| name.as_ptr()).collect();
        let app = vk::ApplicationInfo::default().api_version(version);
        let info = vk::InstanceCreateInfo::default().application_info(&app).enabled_extension_names(&names);
        // SAFETY: both are `vkGetInstanceProcAddr`, declared by two crates.
        let get_proc_addr: xr::sys::platform::VkGetInstanceProcAddr =
            unsafe { std::mem::transmute(entry.static_fn().get_instance_proc_addr) };
        // SAFETY: `info` and what it points to live until the call returns.
        let raw_instance = unsafe { instance.create_vulkan_instance(system, get_proc_addr, (&raw const info).cast()) }?
            .map_err(|code| failed(&vk::Result::from_raw(code)))?;
        // SAFETY: the instance was just created by the same loader.
        let ash_instance =
            unsafe { ash::Instance::load(entry.static_fn(), vk::Instance::from_raw(raw_instance as u64)) };
        // SAFETY: the instance is that of the runtime's device.
        let raw_physical = unsafe { instance.vulkan_graphics_device(system, raw_instance) }?;
        let physical = vk::PhysicalDevice::from_raw(raw_physical as u64);
        // SAFETY: the instance has the version and the extensions that are stated here, and no other code destroys it.
        let hal_instance = unsafe {
            vulkan::Instance::from_raw(
                entry.clone(),
                ash_instance.clone(),
                version,
                0,
                None,
                extensions,
                flags,
                MemoryBudgetThresholds::default(),
                false,
                None,
            )
        }
        .map_err(|e| failed(&e))?;
        let exposed = hal_instance
            .expose_adapter(physical)
            .ok_or_else(|| Error::Device("wgpu does not support the runtime's adapter".into()))?;
        // SAFETY: the physical device belongs to the instance.
        let families = unsafe { ash_instance.get_physical_device_queue_family_properties(physical) };
        let needed = vk::QueueFlags::GRAPHICS | vk::QueueFlags::COMPUTE;
        let family = families.iter().position(|family| family.queue_flags.contains(needed));
        let family = family.ok_or_else(|| Error::Device("no queue for graphics and compute".into()))? as u32;
        let features = Features::empty();
        let extensions: Vec<&'static CStr> = exposed.adapter.required_device_extensions(features);
        let mut device_features = exposed.adapter.physical_device_features(&extensions, features);
        let names: Vec<_> = extensions.iter().map(|name| name.as_ptr()).collect();
        let queues = [vk::DeviceQueueCreateInfo::default().queue_family_index(family).queue_priorities(&[1.0])];
        let info = vk::DeviceCreateInfo::default().queue_create_infos(&queues).enabled_extension_names(&names);
        let info = device_features.add_to_device_create(info);
        // SAFETY: `info` and what it points to live until the call returns.
        let raw_device =
            unsafe { instance.create_vulkan_device(system, get_proc_addr, raw_physical, (&raw const info).cast()) }?
                .map_err(|code| failed(&vk::Result::from_raw(code)))?;
        // SAFETY: the device was just created from the instance.
        let ash_device = unsafe { ash::Device::load(ash_instance.fp_v1_0(), vk::Device::from_raw(raw_device as u64)) };
        // SAFETY: the device has the extensions and features that are said here, and queue 0 of the family.
        let open = unsafe {
            exposed.adapter.device_from_raw(
                ash_device,
                None,
                &extensions,
                features,
                &required_limits,
                &MemoryHints::Performance,
                family,
                0,
            )
        }
        .map_err(|e| failed(&e))?;
        // SAFETY: the instance and the adapter are of the same backend.
        let adapter = unsafe { wgpu_30::Instance::from_hal::<Vulkan>(hal_instance).create_adapter_from_hal(exposed) };
        let desc = DeviceDescriptor { required_limits, ..Default::default() };
        // SAFETY: the device is of the adapter, and was opened with the limits of `desc`.
        let (device, queue) =
            unsafe { adapter.create_device_from_hal::<Vulkan>(open, &desc) }.map_err(|e| failed(&e))?;
        let handles = xr::vulkan::SessionCreateInfo {
            instance: raw_instance,
            physical_device: raw_physical,
            device: raw_device,
            queue_family_index: family,
            queue_index: 0,
        };
        Ok(Self { device, queue, handles })
    }

    /// A session on this device. `Gpu` must outlive it.
    pub fn session(
        &self,
        instance: &xr::Instance,
        system: xr::SystemId,
    ) -> Result<(xr::Session<xr::Vulkan>, xr::FrameWaiter, xr::FrameStream<xr::Vulkan>), xr::sys::Result> {
        // SAFETY: the handles are those of `device`, which the headset drops after its session.
        unsafe { instance.create_session::<xr::Vulkan>(system, &self.handles) }
    }

    /// Images of a swapchain as textures with a layer for each eye. The runtime destroys them with the swapchain.
    pub fn textures(
        &self,
        swapchain: &xr::Swapchain<xr::Vulkan>,
        size: [u32; 2],
        format: Format,
    ) -> Result<Vec<Texture>, xr::sys::Result> {
        let images = swapchain.enumerate_images()?;
        Ok(images.into_iter().map(|image| self.texture(vk::Image::from_raw(image), size, format)).collect())
    }

    fn texture(&self, image: vk::Image, [width, height]: [u32; 2], format: Format) -> Texture {
        let drawn = if format.is_depth() { TextureUses::DEPTH_STENCIL_WRITE } else { TextureUses::COLOR_TARGET };
        let format = format.texture;
        let size = Extent3d { width, height, depth_or_array_layers: 2 };
        let hal_desc = hal::TextureDescriptor {
            label: Some("swapchain"),
            size,
            mip_level_count: 1,
            sample_count: 1,
            dimension: TextureDimension::D2,
            format,
            usage: drawn,
            memory_flags: hal::MemoryFlags::empty(),
            view_formats: vec![],
        };
        let desc = TextureDescriptor {
            label: Some("swapchain"),
            size,
            mip_level_count: 1,
            sample_count: 1,
            dimension: TextureDimension::D2,
            format,
            usage: TextureUsages::RENDER_ATTACHMENT,
            view_formats: &[],
        };
        // SAFETY: the device is a Vulkan device, and the image one of it with this size, format and usage. Its owner is
        // the runtime: the callback in place of a destructor does nothing.
        let texture = unsafe {
            let device = self.device.as_hal::<Vulkan>().expect("created as a Vulkan device");
            device.texture_from_raw(image, &hal_desc, Some(Box::new(|| {})), vulkan::TextureMemory::External)
        };
        // SAFETY: the texture is of this device. OpenXR hands out images as COLOR_ATTACHMENT_OPTIMAL and
        // DEPTH_STENCIL_ATTACHMENT_OPTIMAL and wants them back so, which is what a draw leaves.
        unsafe { self.device.create_texture_from_hal::<Vulkan>(texture, &desc, drawn) }
    }
}

/// Format of a swapchain.
#[derive(Clone, Copy)]
pub(crate) struct Format {
    /// As the runtime numbers it.
    pub raw: u32,
    pub texture: TextureFormat,
}

impl Format {
    const fn new(raw: vk::Format, texture: TextureFormat) -> Self {
        Self { raw: raw.as_raw() as u32, texture }
    }

    pub fn is_depth(self) -> bool {
        self.texture.is_depth_stencil_format()
    }
}

/// Depth of [`Targets`](crate::Targets).
pub(crate) const DEPTH: Format = Format::new(vk::Format::D32_SFLOAT, TextureFormat::Depth32Float);

/// The first format of swapchains that encodes sRGB.
pub(crate) fn srgb_format(available: &[u32]) -> Option<Format> {
    let known = [
        Format::new(vk::Format::R8G8B8A8_SRGB, TextureFormat::Rgba8UnormSrgb),
        Format::new(vk::Format::B8G8R8A8_SRGB, TextureFormat::Bgra8UnormSrgb),
    ];
    available.iter().find_map(|available| known.into_iter().find(|format| format.raw == *available))
}
