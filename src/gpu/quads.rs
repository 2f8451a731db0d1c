//! Quads of the views of a frame on the device: which are shaded, the shaded quads around each, and lists of them.

use super::buffer::filled;
use super::plane::{Plane, PlaneDesc};
use crate::context::ContextDesc;
use crate::kernel::quads::{KEYS, RUN_QUADS};
use wgpu::{Buffer, BufferUsages, Device, TextureFormat, TextureUsages};

/// Bytes of a list before its quads.
const LIST_HEADER_BYTES: u64 = 32;
/// Words of `QuadState` in `shaders/planned/quad_state.wgsl` before its arguments of dispatches.
const ARGUMENTS: u64 = 2 * KEYS as u64 + 3;
const STATE_BYTES: u64 = 4 * (ARGUMENTS + 6);
/// Place in the state of the arguments of a dispatch with an invocation for each pixel of shaded quads.
pub(super) const PIXEL_GROUPS: u64 = 4 * ARGUMENTS;
/// The same with an invocation for each quad.
pub(super) const QUAD_GROUPS: u64 = PIXEL_GROUPS + 12;

/// Textures and buffers for the quads of a frame of one size.
#[derive(Debug)]
pub(super) struct Quads {
    /// [`budget`], which each plan uploads.
    pub budget: Buffer,
    pub keys: Plane,
    /// Bits 0 to 3: the pixels of a quad that are shaded; bits 4 and 5: its region; bits 8 to 12: paths of each pixel.
    pub mask: Plane,
    /// Shaded quads of the runs of each row.
    pub runs: Plane,
    /// Codes of the shaded quads around each.
    pub around: Plane,
    pub views: Vec<ViewQuads>,
}

#[derive(Debug)]
pub(super) struct ViewQuads {
    /// `QuadSize` in `shaders/planned/quad_mask_pass.wgsl`.
    pub uniforms: Buffer,
    pub state: Buffer,
    pub list: Buffer,
}

impl Quads {
    pub fn new(device: &Device, desc: &ContextDesc) -> Self {
        let size = size_quads(desc);
        let uniforms =
            |words: [u32; 4]| filled(device, "afterimage uniforms", bytemuck::bytes_of(&words), BufferUsages::UNIFORM);
        let buffer = |size, usage| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("afterimage quads"),
                size,
                usage: BufferUsages::STORAGE | BufferUsages::INDIRECT | usage,
                mapped_at_creation: false,
            })
        };
        let view = |view| ViewQuads {
            uniforms: uniforms([size[0], size[1], view, 0]),
            state: buffer(STATE_BYTES, BufferUsages::COPY_DST),
            list: buffer(list_bytes(desc), BufferUsages::COPY_SRC),
        };
        let [keys, mask, runs, around] = planes(desc);
        Self {
            budget: filled(
                device,
                "afterimage budget",
                bytemuck::bytes_of(&budget(desc)),
                BufferUsages::UNIFORM | BufferUsages::COPY_DST,
            ),
            keys: keys.create(device),
            mask: mask.create(device),
            runs: runs.create(device),
            around: around.create(device),
            views: (0..desc.view_count).map(view).collect(),
        }
    }
}

/// The budget in quads or in paths, and whether it is in paths; two words are unused.
pub(super) fn budget(desc: &ContextDesc) -> [u32; 4] {
    let settings = &desc.settings;
    [settings.foveation.budget_quads(size_quads(desc)), settings.noisy.into(), 0, 0]
}

/// Number of quads of a view along x and y.
pub(super) fn size_quads(desc: &ContextDesc) -> [u32; 2] {
    desc.size_px.map(|side| side.div_ceil(2))
}

pub(super) fn list_bytes(desc: &ContextDesc) -> u64 {
    let [columns, rows] = size_quads(desc).map(u64::from);
    // A binding holds the header and a whole vec4 of the array.
    LIST_HEADER_BYTES + 4 * (columns * rows).max(4)
}

/// Bytes of the textures and buffers of a plan.
pub(super) fn memory_bytes(desc: &ContextDesc) -> u64 {
    let planes: u64 = planes(desc).iter().map(PlaneDesc::bytes).sum();
    planes + u64::from(desc.view_count) * (STATE_BYTES + list_bytes(desc))
}

/// Keys, mask, runs, and the shaded quads around each.
fn planes(desc: &ContextDesc) -> [PlaneDesc; 4] {
    use TextureFormat::{R32Uint, Rg32Uint};
    let size = size_quads(desc);
    let plane = |format, size| PlaneDesc::new("afterimage quads", format, size, desc.view_count);
    [
        plane(R32Uint, size),
        PlaneDesc { usage: TextureUsages::COPY_SRC, ..plane(R32Uint, size) },
        plane(R32Uint, [size[0].div_ceil(RUN_QUADS), size[1]]),
        plane(Rg32Uint, size),
    ]
}
