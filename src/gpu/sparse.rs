//! Comparison of the samples of a sparse frame with history, before the pass of smr that reconstructs its pixels. CPU
//! twin: `src/cpu/sparse_pass/mod.rs`.

use super::buffer::filled;
use super::compute::{ComputeShader, float_texture, storage_texture, uint_texture, uniform};
use super::history::{Planes, array_view};
use super::method_pass::{PAST_FRAME_BINDING, Placeholders, input_overrides};
use super::stage::{Job, Passes};
use super::textures::{Batch, batches};
use super::uniforms::{LatticeUniforms, SparseUniforms, ViewLattices};
use super::{Frame, Textures, Variant};
use crate::frame::ContextDesc;
use crate::lattice::Lattices;
use crate::method::{HistoryLayout, Overrides, smr_sparse_antialiases, smr_sparse_relights};
use crate::shader::SHADERS;
use crate::uniforms::results_size;
use wgpu::{
    BindingResource, Buffer, BufferUsages, ComputePass, Device, Extent3d, Texture, TextureDescriptor, TextureDimension,
    TextureFormat, TextureUsages, TextureView,
};

/// Format of the results for samples.
const FORMAT: TextureFormat = TextureFormat::Rg32Uint;

/// Passes over the samples, and their results.
#[derive(Debug)]
pub(super) struct SamplePasses {
    observe: ComputeShader,
    light: ComputeShader,
    observed: TextureView,
    lights: TextureView,
    absent: Placeholders,
}

/// Lattices of a sparse frame, as the shaders read them.
pub(super) fn lattices(device: &Device, frame: &Frame<'_>, size_px: [u32; 2]) -> Buffer {
    let uniforms = SparseUniforms::new(frame, size_px);
    filled(device, "afterimage uniforms", bytemuck::bytes_of(&uniforms), BufferUsages::UNIFORM)
}

impl SamplePasses {
    /// The passes for contexts of `desc`.
    pub fn new(device: &Device, desc: &ContextDesc) -> Self {
        let sources = ["sparse_observe_pass", "sparse_light_pass"].map(|name| SHADERS.compose(name).source);
        Self::with_shaders(device, desc, sources)
    }

    /// The passes of the WGSL texts `observe` and `light`.
    pub fn with_shaders(device: &Device, desc: &ContextDesc, [observe, light]: [String; 2]) -> Self {
        // Numbers in `inputs`, `lattices` and the passes.
        let color_to_trust = (1..5).map(|number| (number, float_texture()));
        let own = [
            (7, float_texture()),
            (8, uint_texture()),
            (11, uint_texture()),
            (17, uniform()),
            (18, storage_texture(FORMAT)),
            (PAST_FRAME_BINDING, uniform()),
        ];
        let bindings: Vec<_> = std::iter::once((0, uniform())).chain(color_to_trust).chain(own).collect();
        let [observed, lights] = [(); 2].map(|()| array_view(&results(device, desc)));
        Self {
            observe: ComputeShader::with_bindings(device, "sparse_observe_pass", observe, &bindings),
            light: ComputeShader::with_bindings(device, "sparse_light_pass", light, &bindings),
            observed,
            lights,
            absent: Placeholders::new(device, HistoryLayout::Kept { noisy: false, means: false }),
        }
    }
}

impl Passes for SamplePasses {
    fn resize(&mut self, device: &Device, desc: &ContextDesc) {
        [self.observed, self.lights] = [(); 2].map(|()| array_view(&results(device, desc)));
    }

    fn prewarm(&self, device: &Device, desc: &ContextDesc, variant: Variant) {
        let [observe, light] = overrides(desc, variant);
        self.observe.pipeline(device, &observe);
        self.light.pipeline(device, &light);
    }

    fn pipelines(&self) -> Vec<(&'static str, Overrides)> {
        [&self.observe, &self.light].into_iter().flat_map(ComputeShader::pipelines).collect()
    }

    fn record<'a>(&'a self, device: &Device, pass: &mut ComputePass<'_>, job: &mut Job<'a>) {
        let Job { desc, frame, history, variant, uniforms, .. } = &*job;
        let Some(lattices) = &job.lattices else { return };
        let (desc, variant) = (*desc, *variant);
        let overrides = overrides(desc, variant);
        let Planes { views: past, frame: past_frame, .. } = history.split().0;
        let past_noise = past.get(1).unwrap_or(&self.absent.word);
        for batch in batches(frame.views.len(), variant.regions) {
            let optional = |textures: Option<Textures<'_>>| {
                textures.map_or_else(|| self.absent.float.clone(), |textures| textures.bind(&batch))
            };
            let inputs = [
                frame.color.bind(&batch),
                optional(frame.depth),
                optional(frame.motion),
                optional(frame.trust),
                optional(frame.noise),
            ];
            let first_view = batch.views.start;
            let samples: Vec<_> = samples(frame, &batch, uniforms.size)
                .map(|(lattice, points)| (uniforms.buffer(device, first_view, lattice), points))
                .collect();
            let shaders = [&self.observe, &self.light];
            let images = [[&past[0], &self.observed], [&self.observed, &self.lights]];
            for ((shader, overrides), [read, written]) in shaders.into_iter().zip(&overrides).zip(images) {
                for (uniforms, points) in &samples {
                    let resources = std::iter::once(uniforms.as_entire_binding())
                        .chain(inputs.iter().map(BindingResource::TextureView))
                        .chain([
                            BindingResource::TextureView(read),
                            BindingResource::TextureView(past_noise),
                            lattices.as_entire_binding(),
                            BindingResource::TextureView(written),
                            past_frame.as_entire_binding(),
                        ]);
                    let group = shader.group(device, resources);
                    shader.dispatch(device, pass, overrides, &group, *points, batch.views.len() as u32);
                }
            }
        }
        job.lights = Some(self.lights.clone());
    }
}

/// Lattices of a batch of views whose samples are compared, and the largest number of their samples along x and y.
fn samples(frame: &Frame<'_>, batch: &Batch, size_px: [u32; 2]) -> impl Iterator<Item = (u32, [u32; 2])> {
    let mut most = [[0; 2]; Lattices::MAX];
    for view in &frame.views[batch.views.start as usize..batch.views.end as usize] {
        let lattices =
            view.lattices.as_ref().map_or_else(ViewLattices::default, |l| LatticeUniforms::of_view(l, size_px));
        for (most, lattice) in most.iter_mut().zip(lattices).filter(|(_, lattice)| lattice.level > 0) {
            *most = [0, 1].map(|i| most[i].max(lattice.points[i]));
        }
    }
    (0..).zip(most).filter(|(_, points)| points.iter().all(|&n| n > 0))
}

/// Override values of the two passes.
fn overrides(desc: &ContextDesc, variant: Variant) -> [Overrides; 2] {
    let mut observe = input_overrides(desc, variant);
    observe.push(("NOISY", u32::from(desc.settings.noisy)));
    observe.push(("ANTIALIAS", u32::from(smr_sparse_antialiases(&desc.settings))));
    let relight = [("RELIGHT_ON", u32::from(smr_sparse_relights(&desc.settings)))];
    let light = observe.iter().copied().chain(relight).collect();
    [observe, light]
}

/// Texture for the results of the samples of all views.
fn results(device: &Device, desc: &ContextDesc) -> Texture {
    let [width, height] = results_size(desc.size_px);
    device.create_texture(&TextureDescriptor {
        label: Some("afterimage samples"),
        size: Extent3d { width, height, depth_or_array_layers: desc.view_count },
        mip_level_count: 1,
        sample_count: 1,
        dimension: TextureDimension::D2,
        format: FORMAT,
        usage: TextureUsages::TEXTURE_BINDING | TextureUsages::STORAGE_BINDING,
        view_formats: &[],
    })
}

/// Bytes of the results for samples.
pub(super) fn memory_bytes(desc: &ContextDesc) -> u64 {
    let texels = results_size(desc.size_px).map(u64::from).iter().product::<u64>() * u64::from(desc.view_count);
    2 * u64::from(FORMAT.block_copy_size(None).unwrap_or(0)) * texels
}
