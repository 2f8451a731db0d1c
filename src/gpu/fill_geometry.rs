//! Fills depth and motion of every pixel of a sparse frame that has them at its samples only. CPU twin:
//! `src/cpu/fill_geometry.rs`.

use super::compute::{ComputeShader, float_texture, storage_texture, uint_texture, uniform};
use super::history::array_view;
use super::method_pass::{PAST_FRAME_BINDING, Placeholders, input_overrides};
use super::stage::{Job, Passes};
use super::textures::batches;
use super::{Textures, Variant};
use crate::convention::DepthConvention;
use crate::frame::ContextDesc;
use crate::method::{HistoryLayout, Overrides};
use crate::shader::SHADERS;
use std::sync::OnceLock;
use wgpu::{
    BindingResource, ComputePass, Device, Extent3d, Texture, TextureDescriptor, TextureDimension, TextureFormat,
    TextureUsages,
};

/// Formats of filled distances and motion vectors.
const FORMATS: [TextureFormat; 2] = [TextureFormat::R32Float, TextureFormat::Rg32Float];

/// The stage. Its pass is made at the first frame with geometry at samples.
#[derive(Debug)]
pub(super) struct GeometryFill(OnceLock<GeometryPass>);

/// The pass, and the filled geometry of the current frame.
#[derive(Debug)]
struct GeometryPass {
    shader: ComputeShader,
    absent: Placeholders,
    textures: [Texture; 2],
}

impl GeometryFill {
    pub fn new() -> Self {
        Self(OnceLock::new())
    }

    /// The pass of the WGSL text `source`.
    pub fn with_shader(device: &Device, desc: &ContextDesc, source: String) -> Self {
        Self(GeometryPass::new(device, desc, source).into())
    }

    fn pass(&self, device: &Device, desc: &ContextDesc) -> &GeometryPass {
        self.0.get_or_init(|| GeometryPass::new(device, desc, SHADERS.compose("fill_geometry_pass").source))
    }
}

impl Passes for GeometryFill {
    fn resize(&mut self, device: &Device, desc: &ContextDesc) {
        if let Some(pass) = self.0.get_mut() {
            pass.textures = textures(device, desc);
        }
    }

    fn prewarm(&self, device: &Device, desc: &ContextDesc, variant: Variant) {
        if variant.geometry_at_samples {
            self.pass(device, desc).shader.pipeline(device, &overrides(desc, variant));
        }
    }

    fn pipelines(&self) -> Vec<(&'static str, Overrides)> {
        self.0.get().map_or_else(Vec::new, |pass| pass.shader.pipelines())
    }

    fn added_bytes(&self) -> u64 {
        self.0.get().map_or(0, GeometryPass::memory_bytes)
    }

    fn filled_depth(&self) -> Option<&Texture> {
        self.0.get().map(|pass| &pass.textures[0])
    }

    fn record<'a>(&'a self, device: &Device, pass: &mut ComputePass<'_>, job: &mut Job<'a>) {
        if job.variant.geometry_at_samples {
            let own = self.pass(device, job.desc);
            own.record(device, pass, job);
            own.replace(job);
        }
    }
}

impl GeometryPass {
    fn new(device: &Device, desc: &ContextDesc, source: String) -> Self {
        // Numbers in `inputs`, `kept_history`, `lattices` and `fill_geometry_pass`.
        let [depth, motion] = FORMATS.map(storage_texture);
        let bindings = [
            (0, uniform()),
            (2, float_texture()),
            (3, float_texture()),
            (8, uint_texture()),
            (17, uniform()),
            (18, depth),
            (19, motion),
            (PAST_FRAME_BINDING, uniform()),
        ];
        Self {
            shader: ComputeShader::with_bindings(device, "fill_geometry_pass", source, &bindings),
            absent: Placeholders::new(device, HistoryLayout::Kept { noisy: false, means: false }),
            textures: textures(device, desc),
        }
    }

    /// Gives the filled geometry to the following stages.
    fn replace<'a>(&'a self, job: &mut Job<'a>) {
        let map = DepthConvention::Linear.disparity_map();
        job.uniforms.motion_scale = [1.0; 2];
        for view in &mut job.uniforms.views {
            (view.disparity_a, view.disparity_b) = (map.a, map.b);
            view.disparity_flags = map.flags();
            view.motion_offset = [0.0; 2];
            // Each layer of the filled textures is one view, which begins at texel (0, 0).
            (view.depth_origin, view.motion_origin) = (0, 0);
        }
        let [depth, motion] = &self.textures;
        job.frame.depth = job.frame.depth.map(|_| Textures::Layers(depth));
        let has_motion = job.frame.motion.is_some() || job.desc.motion.lacks_camera();
        job.frame.motion = has_motion.then_some(Textures::Layers(motion));
    }

    fn record(&self, device: &Device, pass: &mut ComputePass<'_>, job: &Job<'_>) {
        let Job { desc, frame, variant, history, .. } = job;
        let Some(lattices) = &job.lattices else { return };
        let past = history.split().0.views.first().filter(|_| is_kept(desc)).unwrap_or(&self.absent.word);
        let [depth_out, motion_out] = self.textures.each_ref().map(array_view);
        for batch in batches(frame.views.len(), variant.regions) {
            let optional = |textures: Option<Textures<'_>>| {
                textures.map_or_else(|| self.absent.float.clone(), |textures| textures.bind(&batch))
            };
            let uniforms = job.uniforms.buffer(device, batch.views.start, 0);
            let (depth, motion) = (optional(frame.depth), optional(frame.motion));
            let group = self.shader.group(
                device,
                [
                    uniforms.as_entire_binding(),
                    BindingResource::TextureView(&depth),
                    BindingResource::TextureView(&motion),
                    BindingResource::TextureView(past),
                    lattices.as_entire_binding(),
                    BindingResource::TextureView(&depth_out),
                    BindingResource::TextureView(&motion_out),
                    history.split().0.frame.as_entire_binding(),
                ],
            );
            let count = batch.views.len() as u32;
            self.shader.dispatch(device, pass, &overrides(desc, *variant), &group, desc.size_px, count);
        }
    }

    /// Bytes of the filled geometry.
    fn memory_bytes(&self) -> u64 {
        let bytes = |texture: &Texture| {
            let size = texture.size();
            let texels = u64::from(size.width) * u64::from(size.height) * u64::from(size.depth_or_array_layers);
            texels * u64::from(texture.format().block_copy_size(None).unwrap_or(0))
        };
        self.textures.iter().map(bytes).sum()
    }
}

/// Override values. The pass reads no trust mask.
fn overrides(desc: &ContextDesc, variant: Variant) -> Overrides {
    let mut list = input_overrides(desc, Variant { trust: false, geometry_at_samples: false, ..variant });
    list.push(("HAS_KEPT", u32::from(is_kept(desc))));
    list
}

/// Whether the history layout is that of kept samples, with their sub-pixel places.
fn is_kept(desc: &ContextDesc) -> bool {
    matches!(desc.settings.history_layout(), HistoryLayout::Kept { .. })
}

fn textures(device: &Device, desc: &ContextDesc) -> [Texture; 2] {
    let [width, height] = desc.size_px;
    FORMATS.map(|format| {
        device.create_texture(&TextureDescriptor {
            label: Some("afterimage filled geometry"),
            size: Extent3d { width, height, depth_or_array_layers: desc.view_count },
            mip_level_count: 1,
            sample_count: 1,
            dimension: TextureDimension::D2,
            format,
            usage: TextureUsages::TEXTURE_BINDING | TextureUsages::STORAGE_BINDING | TextureUsages::COPY_SRC,
            view_formats: &[],
        })
    })
}
