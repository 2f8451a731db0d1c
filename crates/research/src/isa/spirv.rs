//! WGSL to SPIR-V, as wgpu 30 does it (`spv::Options` in the file `adapter.rs` of wgpu-hal's Vulkan backend) on a
//! driver with robust buffers and images, which RADV is: only indices into values are guarded, and loops are bounded.

use ash::vk;
use naga::back::{pipeline_constants::process_overrides, spv};
use naga::proc::{BoundsCheckPolicies, BoundsCheckPolicy as Policy};
use naga::{AddressSpace, ImageClass, ShaderStage, TypeInner, valid};

pub struct Shader {
    pub words: Vec<u32>,
    pub bindings: Vec<vk::DescriptorSetLayoutBinding<'static>>,
}

pub fn shader(wgsl: &str, overrides: &[(&str, u32)]) -> Result<Shader, String> {
    let module = naga::front::wgsl::parse_str(wgsl).map_err(|e| e.emit_to_string(wgsl))?;
    let info = valid::Validator::new(valid::ValidationFlags::all(), valid::Capabilities::all())
        .validate(&module)
        .map_err(|e| e.emit_to_string(wgsl))?;
    let resources = || module.global_variables.iter().filter_map(|(_, v)| Some((v, v.binding?)));
    let bindings = resources().map(|(variable, at)| {
        let ty = match (&module.types[variable.ty].inner, variable.space) {
            (TypeInner::Image { class: ImageClass::Storage { .. }, .. }, _) => vk::DescriptorType::STORAGE_IMAGE,
            (TypeInner::Image { .. }, _) => vk::DescriptorType::SAMPLED_IMAGE,
            (_, AddressSpace::Uniform) => vk::DescriptorType::UNIFORM_BUFFER,
            _ => vk::DescriptorType::STORAGE_BUFFER,
        };
        let binding = vk::DescriptorSetLayoutBinding::default().binding(at.binding).descriptor_type(ty);
        binding.descriptor_count(1).stage_flags(vk::ShaderStageFlags::COMPUTE)
    });
    let bindings = bindings.collect();
    let info_of = |at: naga::ResourceBinding| spv::BindingInfo {
        descriptor_set: at.group,
        binding: at.binding,
        binding_array_size: None,
    };
    let binding_map = resources().map(|(_, at)| (at, info_of(at))).collect();
    let constants = overrides.iter().map(|&(name, value)| (name.to_owned(), f64::from(value))).collect();
    let (module, info) = process_overrides(&module, &info, Some((ShaderStage::Compute, "main")), &constants)
        .map_err(|e| e.to_string())?;
    let options = spv::Options {
        lang_version: (1, 6),
        flags: spv::WriterFlags::LABEL_VARYINGS | spv::WriterFlags::FORCE_POINT_SIZE,
        binding_map,
        bounds_check_policies: BoundsCheckPolicies {
            index: Policy::Restrict,
            buffer: Policy::Unchecked,
            image_load: Policy::Unchecked,
            binding_array: Policy::Unchecked,
        },
        // The drop-in asks for zeros only where it counts.
        zero_initialize_workgroup_memory: spv::ZeroInitializeWorkgroupMemoryMode::None,
        force_loop_bounding: true,
        emit_int_div_checks: true,
        ..spv::Options::default()
    };
    let entry = spv::PipelineOptions { shader_stage: ShaderStage::Compute, entry_point: "main".into() };
    let words = spv::write_vec(&module, &info, &options, Some(&entry)).map_err(|e| e.to_string())?;
    Ok(Shader { words, bindings })
}
