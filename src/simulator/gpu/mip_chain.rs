//! Mip levels of a full-rate frame on the GPU.

use crate::context::ContextDesc;
use crate::gpu::buffer::filled;
use crate::gpu::compute::{ComputeShader, Sources};
use crate::gpu::plane::{Plane, PlaneDesc};
use crate::kernel::foveate::level_len;
use wgpu::{BindingResource, Buffer, BufferUsages, ComputePass, Device, TextureFormat, TextureView};

/// Levels from 1 on, as mips from 0 on of one texture. Mip sizes of a texture round down, levels round up; the texture
/// is padded to sides that the coarsest level divides, so that they agree.
#[derive(Debug)]
pub(super) struct MipChain {
    pub levels: Plane,
    /// For each level the size of the next finer one, and a uniform buffer that contains it.
    fine: Vec<([u32; 2], Buffer)>,
    shader: ComputeShader,
}

impl MipChain {
    /// A mip chain of levels 1 to `coarsest`. For a `coarsest` of 0 its texture is a placeholder, which is bound but
    /// not read.
    pub fn new(device: &Device, desc: &ContextDesc, coarsest: u32, sources: &Sources) -> Self {
        let levels = coarsest.max(1);
        let size_px = desc.size_px.map(|s| s.next_multiple_of(1 << levels) / 2);
        // 32-bit floats, as on the CPU, because level l is rounded l times.
        let plane = PlaneDesc::new("afterimage mip levels", TextureFormat::Rgba32Float, size_px, desc.view_count);
        let fine = (0..coarsest).map(|level| {
            let size = desc.size_px.map(|s| level_len(s, level));
            (size, filled(device, "afterimage mip level", bytemuck::bytes_of(&size), BufferUsages::UNIFORM))
        });
        Self {
            levels: PlaneDesc { levels, ..plane }.create(device),
            fine: fine.collect(),
            shader: sources.shader(device, "mip_level"),
        }
    }

    /// Records the dispatches that fill all levels from the full-rate frame `full`.
    pub fn record(&self, device: &Device, pass: &mut ComputePass<'_>, full: &TextureView) {
        let mut finer = full;
        for (level, (fine_size, buffer)) in self.levels.levels.iter().zip(&self.fine) {
            let resources =
                [buffer.as_entire_binding(), BindingResource::TextureView(finer), BindingResource::TextureView(level)];
            let group = self.shader.group(device, resources);
            let size = fine_size.map(|s| level_len(s, 1));
            self.shader.dispatch(device, pass, &[], &group, size, self.levels.desc.layers);
            finer = level;
        }
    }
}
