//! Every pixel of a sparse frame, for methods that read whole frames. CPU twin: `src/cpu/fill.rs`.

use super::compute::{ComputeShader, float_texture, storage_texture, uniform};
use super::history::array_view;
use super::textures::batches;
use super::uniforms::FrameUniforms;
use super::{Frame, Textures, sparse};
use crate::frame::ContextDesc;
use crate::method::Overrides;
use crate::shader::SHADERS;
use wgpu::{
    BindingResource, ComputePass, Device, Extent3d, Texture, TextureDescriptor, TextureDimension, TextureFormat,
    TextureUsages,
};

/// Format of filled colors: samples keep their bits in it.
const FORMAT: TextureFormat = TextureFormat::Rgba32Float;

/// Pass that fills sparse frames, and the filled color of the current one.
#[derive(Debug)]
pub(super) struct Fill {
    shader: ComputeShader,
    color: Texture,
}

impl Fill {
    /// The pass for contexts of `desc`; `None` if their frames are not filled.
    pub fn new(device: &Device, desc: &ContextDesc) -> Option<Self> {
        is_needed(desc).then(|| Self::with_shader(device, desc, SHADERS.compose("fill_pass").source))
    }

    /// The pass of the WGSL text `source`.
    pub fn with_shader(device: &Device, desc: &ContextDesc, source: String) -> Self {
        // Numbers in `inputs`, `lattices` and `fill_pass`.
        let bindings = [(0, uniform()), (1, float_texture()), (17, uniform()), (18, storage_texture(FORMAT))];
        Self {
            shader: ComputeShader::with_bindings(device, "fill_pass", source, &bindings),
            color: color_texture(device, desc),
        }
    }

    /// Follows a change of the context's size.
    pub fn resize(&mut self, device: &Device, desc: &ContextDesc) {
        self.color = color_texture(device, desc);
    }

    /// Compiles the pipeline.
    pub fn prewarm(&self, device: &Device, regions: bool) {
        self.shader.pipeline(device, &overrides(regions));
    }

    /// Shader and override values of each compiled pipeline.
    pub fn pipelines(&self) -> Vec<(&'static str, Overrides)> {
        self.shader.pipelines()
    }

    /// The filled color.
    pub fn color(&self) -> Textures<'_> {
        Textures::Layers(&self.color)
    }

    /// Records the pass for a sparse frame. `uniforms`: of this frame, before it is filled. `regions`: as of its
    /// [`Variant`](super::Variant), so that prewarmed pipelines suffice.
    pub fn record(
        &self,
        device: &Device,
        pass: &mut ComputePass<'_>,
        frame: &Frame<'_>,
        uniforms: FrameUniforms,
        regions: bool,
    ) {
        let lattices = sparse::lattices(device, frame, uniforms.size);
        let target = array_view(&self.color);
        for batch in batches(frame.views.len(), regions) {
            let uniforms = uniforms.buffer(device, batch.views.start, 0);
            let color = frame.color.bind(&batch);
            let resources = [
                uniforms.as_entire_binding(),
                BindingResource::TextureView(&color),
                lattices.as_entire_binding(),
                BindingResource::TextureView(&target),
            ];
            let group = self.shader.group(device, resources);
            let count = batch.views.len() as u32;
            self.shader.dispatch(device, pass, &overrides(regions), &group, frame.views[0].geometry.size_px(), count);
        }
    }
}

/// Whether the frames of a context are filled.
pub(super) fn is_needed(desc: &ContextDesc) -> bool {
    desc.settings.fills_sparse_frames()
}

/// Bytes of the filled color, if the context has one.
pub(super) fn memory_bytes(desc: &ContextDesc) -> u64 {
    let texels = desc.size_px.map(u64::from).iter().product::<u64>() * u64::from(desc.view_count);
    let bytes = u64::from(FORMAT.block_copy_size(None).unwrap_or(0));
    if is_needed(desc) { bytes * texels } else { 0 }
}

fn overrides(regions: bool) -> [(&'static str, u32); 1] {
    [("REGIONS", u32::from(regions))]
}

fn color_texture(device: &Device, desc: &ContextDesc) -> Texture {
    let [width, height] = desc.size_px;
    device.create_texture(&TextureDescriptor {
        label: Some("afterimage filled color"),
        size: Extent3d { width, height, depth_or_array_layers: desc.view_count },
        mip_level_count: 1,
        sample_count: 1,
        dimension: TextureDimension::D2,
        format: FORMAT,
        usage: TextureUsages::TEXTURE_BINDING | TextureUsages::STORAGE_BINDING,
        view_formats: &[],
    })
}
