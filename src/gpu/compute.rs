//! Builder of compute pipelines: a shader, the bindings that its text declares, and a pipeline for each set of override
//! values.

use super::binding::used_by;
use super::dump::dump;
use super::output::format_of;
use crate::method::Overrides;
use crate::settings::Settings;
use crate::shader::{Module, SHADERS};
use std::borrow::Cow;
use std::collections::HashMap;
use std::fmt::Debug;
use std::sync::{Arc, Mutex, PoisonError};
use wgpu::{
    BindGroup, BindGroupDescriptor, BindGroupEntry, BindGroupLayout, BindGroupLayoutDescriptor, BindGroupLayoutEntry,
    BindingResource, BindingType, BufferBindingType, ComputePass, ComputePipeline, ComputePipelineDescriptor, Device,
    PipelineCompilationOptions, PipelineLayout, PipelineLayoutDescriptor, ShaderModule, ShaderModuleDescriptor,
    ShaderSource, ShaderStages, StorageTextureAccess, TextureSampleType, TextureViewDimension,
};

/// Width of a workgroup in invocations; its height is 1. Equal to `@workgroup_size` in the shaders.
pub const WORKGROUP_WIDTH: u32 = 64;

/// A compute shader with the entry point `main` and one bind group.
#[derive(Debug)]
pub struct ComputeShader {
    compiled: Arc<Compiled>,
    pipelines: Mutex<Pipelines>,
}

/// What a device has made of a text. Shaders of one text share it.
#[derive(Debug)]
struct Compiled {
    name: &'static str,
    /// Label of the objects, for captures of a frame.
    label: String,
    /// Numbers and types of the bindings that the pass uses, by number.
    bindings: Vec<(u32, BindingType)>,
    group_layout: BindGroupLayout,
    layout: PipelineLayout,
    module: ShaderModule,
    /// Names of the overrides that the shader has.
    overrides: Vec<String>,
    pipelines: Mutex<Vec<(Overrides, ComputePipeline)>>,
}

/// Pipelines of a shader.
#[derive(Debug, Default)]
struct Pipelines {
    /// Override values that the shader was asked for.
    list: Vec<Overrides>,
    /// Pipelines of keys, as long as the settings are those of `generation`.
    by_key: HashMap<u64, ComputePipeline>,
    generation: u64,
}

/// Function from the name of a pass's module to its WGSL text; also of one that draws a debug view beside its output.
type Text = dyn Fn(&str, WithView) -> Cow<'static, str> + Send + Sync;

/// Whether a pass draws a debug view beside its output.
type WithView = bool;

/// A device, a text, and what the device has made of it.
type Known = (Device, String, Arc<Compiled>);

/// WGSL texts of the passes, by the names of their modules. Clones share what devices have compiled: a pass that comes
/// back with other settings, or in another context, compiles nothing that was compiled before.
#[derive(Clone)]
pub struct Sources {
    text: Arc<Text>,
    known: Arc<Mutex<Vec<Known>>>,
}

impl Sources {
    /// Texts that `text` gives: for tests that plant errors, and for benchmarks. Passes with a debug view are built in.
    pub fn new(text: impl Fn(&str) -> Cow<'static, str> + Send + Sync + 'static) -> Self {
        let texts = move |name: &str, with_view| if with_view { built_in(name, true) } else { text(name) };
        Self { text: Arc::new(texts), known: Arc::default() }
    }

    /// Texts of modules that `text` gives in place of the built-in ones, for shaders that change while a program runs.
    /// [`compose_edited`](crate::shader::Composer::compose_edited) must have composed each pass of them without an
    /// error; otherwise the pass is built in.
    pub fn edited(text: impl Fn(&'static Module) -> Cow<'static, str> + Send + Sync + 'static) -> Self {
        let texts = move |name: &str, with_view: WithView| {
            let composed = SHADERS.compose_edited(name, with_view.then_some(VIEW_BESIDE), &text);
            composed.map_or_else(|_| built_in(name, with_view), |composed| composed.source.into())
        };
        Self { text: Arc::new(texts), known: Arc::default() }
    }

    /// These texts with `text` for one pass.
    #[must_use]
    pub fn with(self, name: &'static str, text: &str) -> Self {
        let (text, texts) = (text.to_owned(), self.text);
        let texts = move |other: &str, with_view: WithView| {
            if other == name && !with_view { text.clone().into() } else { texts(other, with_view) }
        };
        Self { text: Arc::new(texts), known: self.known }
    }

    /// The text of a pass.
    pub fn text(&self, name: &str) -> Cow<'static, str> {
        (self.text)(name, false)
    }

    /// The text of a pass that draws a debug view beside its output.
    pub fn text_with_view(&self, name: &str) -> Cow<'static, str> {
        (self.text)(name, true)
    }

    /// The shader of a pass.
    pub fn shader(&self, device: &Device, name: &'static str) -> ComputeShader {
        self.shader_of(device, name, &self.text(name))
    }

    /// The shader of a pass with the text `source`.
    pub fn shader_of(&self, device: &Device, name: &'static str, source: &str) -> ComputeShader {
        let mut known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        let is_same = |(on, text, compiled): &&Known| on == device && text == source && compiled.name == name;
        if let Some((.., compiled)) = known.iter().find(is_same) {
            return Arc::clone(compiled).into();
        }
        let compiled = Arc::new(Compiled::new(device, name, source));
        known.push((device.clone(), source.to_owned(), Arc::clone(&compiled)));
        compiled.into()
    }
}

impl Default for Sources {
    fn default() -> Self {
        Self { text: Arc::new(built_in), known: Arc::default() }
    }
}

/// Modules of outputs without and with a debug view beside them.
const VIEW_BESIDE: (&str, &str) = ("output", "output_and_view");

fn built_in(name: &str, with_view: WithView) -> Cow<'static, str> {
    match with_view {
        true => SHADERS.compose_replacing(name, VIEW_BESIDE).source.into(),
        false => SHADERS.compose(name).source.into(),
    }
}

impl Debug for Sources {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("Sources")
    }
}

/// Module of the method's pass.
pub fn method_pass(settings: &Settings) -> &'static str {
    settings.pass_shader().name
}

/// Key of a pipeline among those of a shader.
#[derive(Clone, Copy, Debug)]
pub struct PipelineKey {
    pub bits: u64,
    /// Number of the settings, which increases with each change.
    pub generation: u64,
}

impl From<Arc<Compiled>> for ComputeShader {
    fn from(compiled: Arc<Compiled>) -> Self {
        Self { compiled, pipelines: Mutex::default() }
    }
}

impl ComputeShader {
    /// A shader with the bindings of its text, or with those of them that its pass uses.
    pub fn new(device: &Device, name: &'static str, source: &str) -> Self {
        Arc::new(Compiled::new(device, name, source)).into()
    }

    /// Name of the shader's module.
    pub fn name(&self) -> &'static str {
        self.compiled.name
    }

    /// Numbers and types of the bindings, by number.
    pub fn bindings(&self) -> &[(u32, BindingType)] {
        &self.compiled.bindings
    }

    /// Layout of the bind groups.
    pub fn group_layout(&self) -> &BindGroupLayout {
        &self.compiled.group_layout
    }

    /// A bind group of `resources`, by number.
    pub fn group<'a>(&self, device: &Device, resources: impl IntoIterator<Item = BindingResource<'a>>) -> BindGroup {
        let entry = |(&(binding, _), resource)| BindGroupEntry { binding, resource };
        let entries: Vec<_> = self.compiled.bindings.iter().zip(resources).map(entry).collect();
        device.create_bind_group(&BindGroupDescriptor {
            label: Some(&self.compiled.label),
            layout: &self.compiled.group_layout,
            entries: &entries,
        })
    }

    /// The pipeline for a set of override values, compiled at its first use.
    pub fn pipeline(&self, device: &Device, overrides: &[(&'static str, u32)]) -> ComputePipeline {
        // A poisoned lock is harmless: a thread that panicked here inserted nothing.
        let mut pipelines = self.pipelines.lock().unwrap_or_else(PoisonError::into_inner);
        self.find_or_compile(device, &mut pipelines, overrides)
    }

    /// The pipeline of a key, which says what `overrides` are. The shader need not have all of them.
    pub fn keyed_pipeline(
        &self,
        device: &Device,
        key: PipelineKey,
        overrides: impl FnOnce() -> Overrides,
    ) -> ComputePipeline {
        let mut pipelines = self.pipelines.lock().unwrap_or_else(PoisonError::into_inner);
        if pipelines.generation != key.generation {
            pipelines.by_key.clear();
            pipelines.generation = key.generation;
        }
        if let Some(pipeline) = pipelines.by_key.get(&key.bits) {
            return pipeline.clone();
        }
        let mut list = overrides();
        list.retain(|(name, _)| self.compiled.overrides.iter().any(|own| own == name));
        let pipeline = self.find_or_compile(device, &mut pipelines, &list);
        pipelines.by_key.insert(key.bits, pipeline.clone());
        pipeline
    }

    fn find_or_compile(
        &self,
        device: &Device,
        pipelines: &mut Pipelines,
        overrides: &[(&'static str, u32)],
    ) -> ComputePipeline {
        if !pipelines.list.iter().any(|list| list == overrides) {
            pipelines.list.push(overrides.to_vec());
        }
        self.compiled.pipeline(device, overrides)
    }

    /// Name of the shader, and override values, of each pipeline that it was asked for.
    pub fn pipelines(&self) -> Vec<(&'static str, Overrides)> {
        let pipelines = self.pipelines.lock().unwrap_or_else(PoisonError::into_inner);
        pipelines.list.iter().map(|overrides| (self.name(), overrides.clone())).collect()
    }

    /// Dispatches one invocation a texel, for `width` x `height` texels in each of `layers` layers.
    pub fn dispatch(
        &self,
        device: &Device,
        pass: &mut ComputePass<'_>,
        overrides: &[(&'static str, u32)],
        group: &BindGroup,
        [width, height]: [u32; 2],
        layers: u32,
    ) {
        pass.set_pipeline(&self.pipeline(device, overrides));
        pass.set_bind_group(0, group, &[]);
        pass.dispatch_workgroups(width.div_ceil(WORKGROUP_WIDTH), height, layers);
    }
}

impl Compiled {
    fn new(device: &Device, name: &'static str, source: &str) -> Self {
        dump(name, source);
        let mut bindings = declared(source);
        if let Some(used) = used_by(name) {
            bindings.retain(|(number, _)| used.iter().any(|&binding| binding as u32 == *number));
        }
        let label = format!("afterimage {name}");
        let module = device.create_shader_module(ShaderModuleDescriptor {
            label: Some(&label),
            source: ShaderSource::Wgsl(source.into()),
        });
        let entry =
            |&(binding, ty): &_| BindGroupLayoutEntry { binding, visibility: ShaderStages::COMPUTE, ty, count: None };
        let entries: Vec<_> = bindings.iter().map(entry).collect();
        let group_layout =
            device.create_bind_group_layout(&BindGroupLayoutDescriptor { label: Some(&label), entries: &entries });
        let layout = device.create_pipeline_layout(&PipelineLayoutDescriptor {
            label: Some(&label),
            bind_group_layouts: &[Some(&group_layout)],
            ..PipelineLayoutDescriptor::default()
        });
        let overrides = source.lines().filter_map(|line| line.strip_prefix("override ")?.split_once(':'));
        let overrides = overrides.map(|(name, _)| name.to_owned()).collect();
        Self { name, label, bindings, group_layout, layout, module, overrides, pipelines: Mutex::default() }
    }

    /// The pipeline for a set of override values, compiled at its first use.
    fn pipeline(&self, device: &Device, overrides: &[(&'static str, u32)]) -> ComputePipeline {
        let mut pipelines = self.pipelines.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, pipeline)) = pipelines.iter().find(|(list, _)| list == overrides) {
            return pipeline.clone();
        }
        let constants: Vec<_> = overrides.iter().map(|&(name, value)| (name, f64::from(value))).collect();
        let pipeline = device.create_compute_pipeline(&ComputePipelineDescriptor {
            label: Some(&self.label),
            layout: Some(&self.layout),
            module: &self.module,
            entry_point: Some("main"),
            compilation_options: PipelineCompilationOptions {
                constants: &constants,
                // Only counters use workgroup memory, and zeroing it costs a barrier.
                zero_initialize_workgroup_memory: !overrides.contains(&("COUNT", 0)),
            },
            cache: None,
        });
        pipelines.push((overrides.to_vec(), pipeline.clone()));
        pipeline
    }
}

/// Bindings of group 0 that a WGSL text declares, by number.
pub fn declared(source: &str) -> Vec<(u32, BindingType)> {
    let mut bindings: Vec<_> = source.lines().filter_map(declaration).collect();
    bindings.sort_by_key(|&(number, _)| number);
    bindings
}

/// Number and type of the binding that a line declares: `@group(0) @binding(1) var color_in: texture_2d_array<f32>;`.
fn declaration(line: &str) -> Option<(u32, BindingType)> {
    let (number, rest) = line.strip_prefix("@group(0) @binding(")?.split_once(") var")?;
    let (variable, ty) = rest.trim_end_matches(';').split_once(": ")?;
    let buffer = |ty, has_dynamic_offset| BindingType::Buffer { ty, has_dynamic_offset, min_binding_size: None };
    let view_dimension = TextureViewDimension::D2Array;
    let texture = |sample_type| BindingType::Texture { sample_type, view_dimension, multisampled: false };
    let ty = match ty {
        // A dispatch says where in the buffer its uniforms are.
        _ if variable.starts_with("<uniform>") => buffer(BufferBindingType::Uniform, ty == "FrameUniforms"),
        _ if variable.starts_with("<storage, read>") => buffer(BufferBindingType::Storage { read_only: true }, false),
        _ if variable.starts_with("<storage") => buffer(BufferBindingType::Storage { read_only: false }, false),
        "texture_2d_array<f32>" => texture(TextureSampleType::Float { filterable: false }),
        "texture_2d_array<u32>" => texture(TextureSampleType::Uint),
        _ => {
            let format = ty.strip_prefix("texture_storage_2d_array<")?.strip_suffix(", write>")?;
            BindingType::StorageTexture {
                access: StorageTextureAccess::WriteOnly,
                format: format_of(format)?,
                view_dimension,
            }
        }
    };
    Some((number.parse().ok()?, ty))
}
