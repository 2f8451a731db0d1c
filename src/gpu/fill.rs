//! Fills every pixel of a sparse frame, for methods that read whole frames. CPU twin: `src/cpu/fill.rs`.

use super::compute::{ComputeShader, float_texture, storage_texture, uniform};
use super::history::array_view;
use super::stage::{Job, Passes};
use super::textures::batches;
use super::{Textures, Variant};
use crate::frame::ContextDesc;
use crate::method::Overrides;
use crate::shader::SHADERS;
use wgpu::{
    BindingResource, ComputePass, Device, Extent3d, Texture, TextureDescriptor, TextureDimension, TextureFormat,
    TextureUsages,
};

/// Format of filled colors. It stores samples bit for bit.
const FORMAT: TextureFormat = TextureFormat::Rgba32Float;

/// Pass that fills sparse frames, and the filled color of the current one.
#[derive(Debug)]
pub(super) struct Fill {
    shader: ComputeShader,
    color: Texture,
}

impl Fill {
    /// The pass for contexts of `desc`.
    pub fn new(device: &Device, desc: &ContextDesc) -> Self {
        Self::with_shader(device, desc, SHADERS.compose("fill_pass").source)
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
}

impl Passes for Fill {
    fn resize(&mut self, device: &Device, desc: &ContextDesc) {
        self.color = color_texture(device, desc);
    }

    fn prewarm(&self, device: &Device, _: &ContextDesc, variant: Variant) {
        self.shader.pipeline(device, &overrides(variant.regions));
    }

    fn pipelines(&self) -> Vec<(&'static str, Overrides)> {
        self.shader.pipelines()
    }

    fn record<'a>(&'a self, device: &Device, pass: &mut ComputePass<'_>, job: &mut Job<'a>) {
        let Some(lattices) = &job.lattices else { return };
        let (frame, regions) = (&job.frame, job.variant.regions);
        let target = array_view(&self.color);
        for batch in batches(frame.views.len(), regions) {
            let uniforms = job.uniforms.buffer(device, batch.views.start, 0);
            let color = frame.color.bind(&batch);
            let resources = [
                uniforms.as_entire_binding(),
                BindingResource::TextureView(&color),
                lattices.as_entire_binding(),
                BindingResource::TextureView(&target),
            ];
            let group = self.shader.group(device, resources);
            let count = batch.views.len() as u32;
            self.shader.dispatch(device, pass, &overrides(regions), &group, job.desc.size_px, count);
        }
        job.frame = job.frame.with_color(Textures::Layers(&self.color));
        // Each layer of the filled texture is one view, which begins at texel (0, 0).
        job.uniforms.views.iter_mut().for_each(|view| view.color_origin = 0);
    }
}

/// Bytes of the filled color.
pub(super) fn memory_bytes(desc: &ContextDesc) -> u64 {
    let texels = desc.size_px.map(u64::from).iter().product::<u64>() * u64::from(desc.view_count);
    u64::from(FORMAT.block_copy_size(None).unwrap_or(0)) * texels
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
