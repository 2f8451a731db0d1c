//! Passes that resample history to another size.

use super::buffer::filled;
use super::compute::{ComputeShader, Sources, WORKGROUP_WIDTH};
use super::history::{Planes, bound};
use super::recorder::Recorder;
use crate::method::{HistoryLayout, Overrides};
use crate::resize::Resize;
use wgpu::{BufferUsages, Device};

/// Pass for histories of one layout.
#[derive(Debug)]
pub(super) struct ResizePass {
    shader: ComputeShader,
    overrides: Overrides,
    /// Edge in pixels of the block that an invocation processes.
    block_px: u32,
    layout: HistoryLayout,
}

impl ResizePass {
    /// The pass for a layout, with alphas or albedos if it has them; `None` for a layout without history.
    pub fn new(device: &Device, layout: HistoryLayout, has_extra: bool, sources: &Sources) -> Option<Self> {
        let (name, block_px, overrides) = match layout {
            HistoryLayout::Nothing => return None,
            HistoryLayout::Sparse { noisy, means } => {
                let overrides = [("NOISY", noisy), ("MEANS", means), ("HAS_EXTRA", has_extra)];
                ("resize_sparse_pass", 1, overrides.map(|(name, is_on)| (name, u32::from(is_on))).into())
            }
            HistoryLayout::Reservoirs { keys, references } => {
                ("resize_reservoirs_pass", 1, vec![("HAS_EXTRAS", u32::from(keys || references))])
            }
            HistoryLayout::Surfaces { levels, noisy } => {
                ("resize_surfaces_pass", 2, vec![("NOISY", u32::from(noisy)), ("HAS_MIPS", u32::from(levels > 0))])
            }
        };
        Some(Self { shader: sources.shader(device, name), overrides, block_px, layout })
    }

    pub fn layout(&self) -> HistoryLayout {
        self.layout
    }

    pub fn pipelines(&self) -> Vec<(&'static str, Overrides)> {
        self.shader.pipelines()
    }

    /// Adds the dispatch that fills `next`, of the new size, from `past`. It does not fill the mip chain's second level
    /// and those after it.
    pub fn record(
        &self,
        device: &Device,
        recorder: &mut Recorder,
        resize: &Resize,
        view_count: u32,
        [past, next]: [&Planes; 2],
    ) {
        let uniforms = filled(device, "afterimage uniforms", bytemuck::bytes_of(resize), BufferUsages::UNIFORM);
        let resource = |number| if number == 0 { Some((&uniforms).into()) } else { bound(past, next, number) };
        let [width, height] = resize.size_px.map(|s| s.div_ceil(self.block_px));
        let workgroups = [width.div_ceil(WORKGROUP_WIDTH), height, view_count];
        let pipeline = self.shader.pipeline(device, &self.overrides);
        recorder.add(device, (&self.shader, pipeline), None, resource, workgroups);
    }
}
