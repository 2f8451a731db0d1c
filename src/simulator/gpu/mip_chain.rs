//! Mip levels of a full-rate frame on the GPU.

use crate::frame::ContextDesc;
use crate::gpu::compute::{ComputeShader, float_texture, storage_texture, uniform};
use crate::gpu::filled;
use crate::kernel::foveate::level_len;
use wgpu::{
    BindingResource, Buffer, ComputePass, Device, Texture, TextureFormat, TextureUsages, TextureView,
    TextureViewDescriptor, TextureViewDimension,
};

/// 32-bit floats, as on the CPU, because level l is rounded l times.
const FORMAT: TextureFormat = TextureFormat::Rgba32Float;

/// Levels from 1 on, as mips from 0 on of one texture. Mip sizes of a texture round down, levels round up; the texture
/// is padded to sides that the coarsest level divides, so that they agree.
#[derive(Debug)]
pub(super) struct MipChain {
    /// View of all mips, to read.
    pub levels: TextureView,
    mips: Vec<TextureView>,
    /// For each mip the size of the next finer level, and a uniform buffer that contains it.
    fine: Vec<([u32; 2], Buffer)>,
    view_count: u32,
    shader: ComputeShader,
}

impl MipChain {
    /// A mip chain of levels 1 to `coarsest`. For a `coarsest` of 0 its texture is a placeholder, which is bound but
    /// not read.
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
            shader: ComputeShader::new(device, "mip_level", source, &types),
        }
    }

    /// Records the dispatches that fill all levels from the full-rate frame `full`.
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

/// A texture of the simulators.
pub(super) fn texture(
    device: &Device,
    size: [u32; 2],
    view_count: u32,
    mip_level_count: u32,
    format: TextureFormat,
    usage: TextureUsages,
) -> Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some("afterimage foveation"),
        size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: view_count },
        mip_level_count,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    })
}
