//! The coarser levels of a frame on the device.

use super::texture;
use crate::frame::ContextDesc;
use crate::gpu::compute::{ComputeShader, float_texture, storage_texture, uniform};
use crate::gpu::filled;
use crate::kernel::foveate::level_len;
use wgpu::{
    BindingResource, Buffer, ComputePass, Device, TextureFormat, TextureUsages, TextureView, TextureViewDescriptor,
    TextureViewDimension,
};

/// Full floats: level l is a mean of means, l roundings deep, and the CPU keeps as many bits.
const FORMAT: TextureFormat = TextureFormat::Rgba32Float;

/// Levels 1 and up, as mips 0 and up of one texture. Mips of a texture round sizes down, levels round them up, so the texture is as
/// large as a frame whose sides the coarsest level divides.
#[derive(Debug)]
pub(super) struct MipChain {
    /// All mips, for reading.
    pub levels: TextureView,
    mips: Vec<TextureView>,
    /// Sizes of the levels that each is made of, in pixels or texels, and the buffers that tell the shader.
    fine: Vec<([u32; 2], Buffer)>,
    view_count: u32,
    shader: ComputeShader,
}

impl MipChain {
    /// Levels 1 to `coarsest`; with none, a texture that is bound and not read.
    pub fn new(device: &Device, desc: &ContextDesc, coarsest: u32, source: String) -> Self {
        let mip_count = coarsest.max(1);
        let base = desc.size_px.map(|s| s.next_multiple_of(1 << mip_count) / 2);
        let usage = TextureUsages::TEXTURE_BINDING | TextureUsages::STORAGE_BINDING;
        let texture = texture(device, base, desc.view_count, mip_count, FORMAT, usage);
        let view = |base_mip_level, mip_level_count| {
            texture.create_view(&TextureViewDescriptor {
                label: Some("afterimage mip level"),
                dimension: Some(TextureViewDimension::D2Array),
                base_mip_level,
                mip_level_count: Some(mip_level_count),
                ..TextureViewDescriptor::default()
            })
        };
        let fine = (0..coarsest).map(|level| {
            let size = desc.size_px.map(|s| level_len(s, level));
            let buffer = filled(device, "afterimage mip level", bytemuck::bytes_of(&size), wgpu::BufferUsages::UNIFORM);
            (size, buffer)
        });
        let types = [uniform(), float_texture(), storage_texture(FORMAT)];
        Self {
            levels: view(0, mip_count),
            mips: (0..coarsest).map(|mip| view(mip, 1)).collect(),
            fine: fine.collect(),
            view_count: desc.view_count,
            shader: ComputeShader::new(device, "afterimage mip level", source, &types),
        }
    }

    /// Makes all levels of `full`, each from the one before.
    pub fn record(&self, device: &Device, pass: &mut ComputePass<'_>, full: &TextureView) {
        let mut finer = full;
        for (mip, (fine_size, buffer)) in self.mips.iter().zip(&self.fine) {
            let resources =
                [buffer.as_entire_binding(), BindingResource::TextureView(finer), BindingResource::TextureView(mip)];
            let group = self.shader.group(device, resources);
            self.shader.dispatch(device, pass, &[], &group, fine_size.map(|s| level_len(s, 1)), self.view_count);
            finer = mip;
        }
    }
}
