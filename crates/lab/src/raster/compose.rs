//! Composition of quad views into a frame, on the device.

use super::targets::Targets;
use crate::device::texture_desc;
use crate::quad_views::{QuadView, QuadViews};
use crate::shader::SHADERS;
use afterimage::internal::{ComputeShader, array_view, filled};
use bytemuck::{Pod, Zeroable};
use wgpu::{BindingResource, BufferUsages, CommandEncoder, Device, Texture, TextureFormat, TextureUsages};

/// Formats of color, distance, motion and level of detail.
const FORMATS: [TextureFormat; 4] =
    [TextureFormat::Rgba32Float, TextureFormat::R32Float, TextureFormat::Rg32Float, TextureFormat::R32Float];

/// Composes quad views. Twin of `Composition` in `shaders/pipeline/compose_pass.wgsl`.
#[derive(Debug)]
pub struct Composer {
    shader: ComputeShader,
    /// Color, distance, motion and level of detail of the frame.
    frame: [Texture; 4],
}

#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
struct QuadViewRecord {
    opaque_px: [[f32; 2]; 2],
    first: [f32; 2],
    points: [f32; 2],
    texel: [u32; 2],
    step: f32,
    lod: f32,
    blend_px: f32,
    unused: [f32; 3],
}

#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
struct Composition {
    views: [QuadViewRecord; QuadViews::MAX],
    count: u32,
    near: f32,
    unused: [f32; 2],
}

impl From<&QuadView> for QuadViewRecord {
    fn from(view: &QuadView) -> Self {
        Self {
            opaque_px: view.opaque_px.map(|px| px.map(|v| v as f32)),
            first: view.first.map(|v| v as f32),
            points: view.points.map(|v| v as f32),
            texel: view.atlas_texel,
            step: view.step,
            lod: view.lod(),
            blend_px: view.blend_px,
            unused: [0.0; 3],
        }
    }
}

impl Composer {
    /// A composer of frames of `size` pixels.
    pub fn new(device: &Device, size: [u32; 2]) -> Self {
        let usage = TextureUsages::TEXTURE_BINDING | TextureUsages::STORAGE_BINDING | TextureUsages::COPY_SRC;
        let texture = |format| device.create_texture(&texture_desc("composed frame", size, format, usage));
        Self {
            shader: ComputeShader::new(device, "compose", &SHADERS.compose("compose_pass").source),
            frame: FORMATS.map(texture),
        }
    }

    /// Records the composition of `views`, whose atlas is `from`. `near`: distance of the near plane in metres.
    pub fn record(&self, device: &Device, encoder: &mut CommandEncoder, views: &QuadViews, from: &Targets, near: f32) {
        let mut composition = Composition { near, ..Composition::zeroed() };
        for (record, view) in composition.views.iter_mut().zip(views.as_slice()) {
            *record = view.into();
            composition.count += 1;
        }
        let uniforms = filled(device, "composition", bytemuck::bytes_of(&composition), BufferUsages::STORAGE);
        let textures: Vec<_> =
            [&from.color, &from.depth, &from.motion].into_iter().chain(&self.frame).map(array_view).collect();
        let resources =
            std::iter::once(uniforms.as_entire_binding()).chain(textures.iter().map(BindingResource::TextureView));
        let group = self.shader.group(device, resources);
        let size = [self.frame[0].width(), self.frame[0].height()];
        let mut pass = encoder.begin_compute_pass(&Default::default());
        self.shader.dispatch(device, &mut pass, &[], &group, size, 1);
    }

    /// Color, distance, motion and level of detail of the last composed frame.
    pub fn frame(&self) -> &[Texture; 4] {
        &self.frame
    }
}
