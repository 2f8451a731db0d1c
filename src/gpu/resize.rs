//! Passes that resample history to another size.

use super::buffer::filled;
use super::compute::{ComputeShader, storage_texture, uint_texture, uniform};
use super::history::Planes;
use super::method_pass::{Placeholders, written};
use crate::method::{HistoryLayout, Overrides};
use crate::resize::Resize;
use crate::shader::SHADERS;
use bytemuck::{Pod, Zeroable};
use wgpu::{BindingResource, BufferUsages, CommandEncoder, ComputePassDescriptor, Device};

/// `ResizeUniforms` in `shaders/pass/resize_uniforms.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct ResizeUniforms {
    /// Width and height of the new views in pixels.
    pub size: [u32; 2],
    /// Width and height of the old views in pixels.
    pub old_size: [u32; 2],
    /// Old size over new size, for each axis.
    pub ratio: [f32; 2],
    /// Change of levels of detail.
    pub lod_shift: f32,
    /// Padding to a multiple of 8 bytes.
    pub unused: u32,
}

/// Pass for histories of one layout.
#[derive(Debug)]
pub(super) struct ResizePass {
    shader: ComputeShader,
    overrides: Overrides,
    /// Edge in pixels of the block that an invocation processes.
    block_px: u32,
    layout: HistoryLayout,
    absent: Placeholders,
}

impl ResizePass {
    /// The pass for a layout; `None` for a layout without history.
    pub fn new(device: &Device, layout: HistoryLayout) -> Option<Self> {
        let [first, second, third] = written(layout).map(storage_texture);
        let (name, types, block_px, overrides) = match layout {
            HistoryLayout::Nothing => return None,
            HistoryLayout::Kept { noisy, means } => (
                "resize_kept_pass",
                vec![uniform(), uint_texture(), uint_texture(), first, third],
                1,
                vec![("NOISY", u32::from(noisy)), ("MEANS", u32::from(means))],
            ),
            HistoryLayout::Reservoirs { keys, references } => (
                "resize_reservoirs_pass",
                vec![uniform(), uint_texture(), uint_texture(), uint_texture(), first, second, third],
                1,
                vec![("HAS_EXTRAS", u32::from(keys || references))],
            ),
            HistoryLayout::Surfaces { levels, noisy } => (
                "resize_surfaces_pass",
                vec![uniform(), uint_texture(), uint_texture(), first, second, third],
                2,
                vec![("NOISY", u32::from(noisy)), ("HAS_MIPS", u32::from(levels > 0))],
            ),
        };
        let shader = ComputeShader::new(device, name, SHADERS.compose(name).source, &types);
        Some(Self { shader, overrides, block_px, layout, absent: Placeholders::new(device, layout) })
    }

    /// Layout of the histories.
    pub fn layout(&self) -> HistoryLayout {
        self.layout
    }

    /// Shader and override values of each compiled pipeline.
    pub fn pipelines(&self) -> Vec<(&'static str, Overrides)> {
        self.shader.pipelines()
    }

    /// Records the pass that fills `next`, of the new size, from `past`. It does not fill the mip chain's second level
    /// and those after it.
    pub fn record(
        &self,
        device: &Device,
        encoder: &mut CommandEncoder,
        resize: &Resize,
        view_count: u32,
        [past, next]: [&Planes; 2],
    ) {
        let uniforms = ResizeUniforms {
            size: resize.size_px,
            old_size: resize.old_size_px,
            ratio: resize.ratio,
            lod_shift: resize.lod_shift,
            unused: 0,
        };
        let uniforms = filled(device, "afterimage uniforms", bytemuck::bytes_of(&uniforms), BufferUsages::UNIFORM);
        let (past, next) = (&past.views, &next.targets);
        let next_or = |i: usize| next.get(i).unwrap_or(&self.absent.out[i]);
        let read = match self.layout {
            HistoryLayout::Surfaces { .. } => vec![&past[0], past.get(2).unwrap_or(&self.absent.word)],
            HistoryLayout::Kept { .. } => vec![&past[0], past.get(1).unwrap_or(&self.absent.word)],
            _ => vec![&past[0], &past[1], past.get(2).unwrap_or(&self.absent.word)],
        };
        let written = match self.layout {
            HistoryLayout::Kept { .. } => vec![next_or(0), next.get(1).unwrap_or(&self.absent.out[2])],
            _ => vec![next_or(0), next_or(1), next_or(2)],
        };
        let views = read.into_iter().chain(written).map(BindingResource::TextureView);
        let group = self.shader.group(device, std::iter::once(uniforms.as_entire_binding()).chain(views));
        let label = Some("afterimage resize");
        let mut pass = encoder.begin_compute_pass(&ComputePassDescriptor { label, ..Default::default() });
        let blocks = resize.size_px.map(|s| s.div_ceil(self.block_px));
        self.shader.dispatch(device, &mut pass, &self.overrides, &group, blocks, view_count);
    }
}
