//! Depth and motion of every pixel of a sparse frame that has them at its samples only. CPU twin:
//! `src/cpu/fill_geometry.rs`.

use super::compute::{ComputeShader, float_texture, storage_texture, uint_texture, uniform};
use super::history::{History, array_view};
use super::method_pass::{Placeholders, input_overrides};
use super::textures::batches;
use super::uniforms::FrameUniforms;
use super::{Frame, Textures, Variant, sparse};
use crate::convention::DepthConvention;
use crate::frame::ContextDesc;
use crate::method::{HistoryLayout, Overrides};
use crate::shader::SHADERS;
use wgpu::{
    BindingResource, ComputePass, Device, Extent3d, Texture, TextureDescriptor, TextureDimension, TextureFormat,
    TextureUsages,
};

/// Formats of filled distances and motion vectors.
const FORMATS: [TextureFormat; 2] = [TextureFormat::R32Float, TextureFormat::Rg32Float];

/// The pass, and the filled geometry of the current frame.
#[derive(Debug)]
pub(super) struct GeometryFill {
    shader: ComputeShader,
    absent: Placeholders,
    textures: [Texture; 2],
}

impl GeometryFill {
    pub fn new(device: &Device, desc: &ContextDesc) -> Self {
        Self::with_shader(device, desc, SHADERS.compose("fill_geometry_pass").source)
    }

    /// The pass of the WGSL text `source`.
    pub fn with_shader(device: &Device, desc: &ContextDesc, source: String) -> Self {
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
        ];
        Self {
            shader: ComputeShader::with_bindings(device, "fill_geometry_pass", source, &bindings),
            absent: Placeholders::new(device, HistoryLayout::Kept { noisy: false }),
            textures: textures(device, desc),
        }
    }

    /// Follows a change of the context's size.
    pub fn resize(&mut self, device: &Device, desc: &ContextDesc) {
        self.textures = textures(device, desc);
    }

    /// Compiles the pipeline of a variant.
    pub fn prewarm(&self, device: &Device, desc: &ContextDesc, variant: Variant) {
        self.shader.pipeline(device, &overrides(desc, variant));
    }

    /// Shader and override values of each compiled pipeline.
    pub fn pipelines(&self) -> Vec<(&'static str, Overrides)> {
        self.shader.pipelines()
    }

    /// The frame with filled geometry in place of the given one, and its uniforms.
    pub fn filled<'a>(&'a self, frame: &Frame<'a>, mut uniforms: FrameUniforms) -> (Frame<'a>, FrameUniforms) {
        let map = DepthConvention::Linear.disparity_map();
        uniforms.motion_scale = [1.0; 2];
        for view in &mut uniforms.views {
            (view.disparity_a, view.disparity_b) = (map.a, map.b);
            view.disparity_flags = map.flags();
            view.motion_offset = [0.0; 2];
            // A layer is a whole view.
            (view.depth_origin, view.motion_origin) = (0, 0);
        }
        let [depth, motion] = &self.textures;
        let filled = Frame {
            depth: frame.depth.map(|_| Textures::Layers(depth)),
            motion: frame.motion.map(|_| Textures::Layers(motion)),
            ..*frame
        };
        (filled, uniforms)
    }

    /// Records the pass. `uniforms`: of the frame, before it is filled.
    pub fn record(
        &self,
        device: &Device,
        pass: &mut ComputePass<'_>,
        desc: &ContextDesc,
        (frame, variant): (&Frame<'_>, Variant),
        uniforms: FrameUniforms,
        history: &History,
    ) {
        let lattices = sparse::lattices(device, frame, uniforms.size);
        let past = history.split().0.views.first().filter(|_| sparse::is_needed(desc)).unwrap_or(&self.absent.word);
        let [depth_out, motion_out] = self.textures.each_ref().map(array_view);
        for batch in batches(frame.views.len(), variant.regions) {
            let optional = |textures: Option<Textures<'_>>| {
                textures.map_or_else(|| self.absent.float.clone(), |textures| textures.bind(&batch))
            };
            let uniforms = uniforms.buffer(device, batch.views.start, 0);
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
                ],
            );
            let count = batch.views.len() as u32;
            self.shader.dispatch(device, pass, &overrides(desc, variant), &group, desc.size_px, count);
        }
    }

    /// Bytes of the filled geometry.
    pub fn memory_bytes(&self) -> u64 {
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
    let mut list = input_overrides(desc, Variant { trust: false, ..variant });
    list.push(("HAS_KEPT", u32::from(sparse::is_needed(desc))));
    list
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
            usage: TextureUsages::TEXTURE_BINDING | TextureUsages::STORAGE_BINDING,
            view_formats: &[],
        })
    })
}
