//! A Vulkan device that only compiles, and what it says of a compute pipeline.
#![allow(unsafe_code, reason = "plain Vulkan, which has no safe interface for statistics of pipelines")]

use super::failure::Result;
use super::spirv::Shader;
use ash::{khr::pipeline_executable_properties as executables, vk};
use serde_json::{Map, Value, json};
use std::ffi::{CStr, c_char};
use std::path::PathBuf;

/// Folders in which Vulkan's loader looks for drivers.
const FOLDERS: [&str; 2] = ["/usr/share/vulkan/icd.d", "/etc/vulkan/icd.d"];

/// File that names the driver to Vulkan's loader, if it is installed.
pub fn icd() -> Option<PathBuf> {
    let entries = FOLDERS.iter().filter_map(|folder| std::fs::read_dir(folder).ok()).flatten().flatten();
    entries.map(|e| e.path()).find(|p| {
        let name = p.file_name().unwrap_or_default().to_string_lossy();
        name.starts_with("radeon_icd") && (name.contains(std::env::consts::ARCH) || name == "radeon_icd.json")
    })
}

pub struct Radv {
    /// Holds the loader's library.
    _entry: ash::Entry,
    device: ash::Device,
    executables: executables::Device,
    driver: String,
}

impl Radv {
    /// The device that the environment asks for, with robust buffers and images, as wgpu asks for.
    pub fn new() -> Result<Self> {
        // SAFETY: plain Vulkan; nothing is destroyed before the process ends.
        unsafe {
            let entry = ash::Entry::load()?;
            let app = vk::ApplicationInfo::default().api_version(vk::API_VERSION_1_3);
            let instance = entry.create_instance(&vk::InstanceCreateInfo::default().application_info(&app), None)?;
            let gpu = *instance.enumerate_physical_devices()?.first().ok_or("RADV has no device")?;
            let mut driver = vk::PhysicalDeviceDriverProperties::default();
            instance.get_physical_device_properties2(
                gpu,
                &mut vk::PhysicalDeviceProperties2::default().push_next(&mut driver),
            );
            let driver = format!("{} {}", text(&driver.driver_name), text(&driver.driver_info));
            let queues = [vk::DeviceQueueCreateInfo::default().queue_priorities(&[1.0])];
            let extensions = [executables::NAME.as_ptr(), ash::ext::robustness2::NAME.as_ptr()];
            let mut statistics =
                vk::PhysicalDevicePipelineExecutablePropertiesFeaturesKHR::default().pipeline_executable_info(true);
            let mut robust = vk::PhysicalDeviceRobustness2FeaturesEXT::default()
                .robust_buffer_access2(true)
                .robust_image_access2(true);
            let core = vk::PhysicalDeviceFeatures::default().robust_buffer_access(true);
            let info = vk::DeviceCreateInfo::default()
                .queue_create_infos(&queues)
                .enabled_extension_names(&extensions)
                .enabled_features(&core)
                .push_next(&mut statistics)
                .push_next(&mut robust);
            let device = instance.create_device(gpu, &info, None)?;
            let executables = executables::Device::new(&instance, &device);
            Ok(Self { _entry: entry, device, executables, driver })
        }
    }

    /// Name and version of the driver.
    pub fn driver(&self) -> &str {
        &self.driver
    }

    /// Compiles a shader; its statistics.
    pub fn compile(&self, shader: &Shader) -> Result<Map<String, Value>> {
        // SAFETY: as above; the pipeline outlives these calls.
        unsafe {
            let set_info = vk::DescriptorSetLayoutCreateInfo::default().bindings(&shader.bindings);
            let sets = [self.device.create_descriptor_set_layout(&set_info, None)?];
            let layout_info = vk::PipelineLayoutCreateInfo::default().set_layouts(&sets);
            let layout = self.device.create_pipeline_layout(&layout_info, None)?;
            let module_info = vk::ShaderModuleCreateInfo::default().code(&shader.words);
            let stage = vk::PipelineShaderStageCreateInfo::default()
                .stage(vk::ShaderStageFlags::COMPUTE)
                .module(self.device.create_shader_module(&module_info, None)?)
                .name(c"main");
            let flags = vk::PipelineCreateFlags::CAPTURE_STATISTICS_KHR;
            let info = vk::ComputePipelineCreateInfo::default().flags(flags).stage(stage).layout(layout);
            let pipelines = self.device.create_compute_pipelines(vk::PipelineCache::null(), &[info], None);
            let pipeline = pipelines.map_err(|(_, e)| e)?[0];
            let executable = vk::PipelineExecutableInfoKHR::default().pipeline(pipeline);
            let mut all = Map::new();
            for s in self.executables.get_pipeline_executable_statistics(&executable)? {
                let value = match s.format {
                    vk::PipelineExecutableStatisticFormatKHR::FLOAT64 => json!(s.value.f64),
                    _ => json!(s.value.u64),
                };
                all.insert(text(&s.name), value);
            }
            Ok(all)
        }
    }
}

fn text(chars: &[c_char]) -> String {
    // SAFETY: Vulkan ends its texts with a zero.
    unsafe { CStr::from_ptr(chars.as_ptr()) }.to_string_lossy().into()
}
