//! Dispatches of a frame, and what recording keeps from frame to frame: bind groups, uniforms on the device and
//! placeholders.
//!
//! The uniforms of a frame lie in one buffer, which stays. Their values travel in another, mapped when it is created,
//! which the caller's encoder copies from before the passes: several frames in one submission see their own, and a
//! dropped encoder changes nothing.

use super::binding::Binding;
use super::buffer::filled_if_alive;
use super::compute::ComputeShader;
use super::groups::{Groups, Resource};
use super::plane::{Plane, PlaneDesc};
use super::uniforms::FrameUniforms;
use crate::context::ContextDesc;
use crate::error::FrameError;
use crate::stats::FrameStats;
use std::num::NonZeroU64;
use wgpu::{
    BindGroup, BindingType, Buffer, BufferDescriptor, BufferUsages, CommandEncoder, ComputePass, ComputePipeline,
    Device, TextureFormat, TextureSampleType,
};

/// Formats of history, which the device must be able to store.
pub const STORED: [TextureFormat; 3] = [TextureFormat::Rg32Uint, TextureFormat::R32Uint, TextureFormat::Rgba16Float];

/// Multiple of the offsets of uniforms: at most 256 on every device.
const ALIGNMENT: usize = 256;
/// First byte of the uniforms of dispatches. The frame's number lies at byte 0.
const DISPATCHES: usize = ALIGNMENT;
/// Place in an [`upload`](Recorder::upload) of the words of a [`budget`](Recorder::budget).
pub const BUDGET: u64 = 16;
/// Bytes from the uniforms of one dispatch to those of the next.
const STRIDE: usize = size_of::<FrameUniforms>().next_multiple_of(ALIGNMENT);
/// Different uniforms for each view: before and after colors are filled.
const DISPATCHES_PER_VIEW: usize = 2;

/// Size of a dispatch: numbers of workgroups, or the place of these numbers in a buffer.
#[derive(Debug)]
pub enum Workgroups {
    Direct([u32; 3]),
    Indirect(Buffer, u64),
}

impl From<[u32; 3]> for Workgroups {
    fn from(numbers: [u32; 3]) -> Self {
        Self::Direct(numbers)
    }
}

#[derive(Debug)]
struct Dispatch {
    pipeline: ComputePipeline,
    group: BindGroup,
    /// Offset of the frame's uniforms, if the shader reads them.
    uniforms: Option<u32>,
    workgroups: Workgroups,
}

#[derive(Debug)]
pub struct Recorder {
    groups: Groups,
    uniforms: Buffer,
    absent: Absent,
    bytes: Vec<u8>,
    dispatches: Vec<Dispatch>,
}

/// Placeholders for what a frame does not have: 1x1 textures, and a buffer for counters.
#[derive(Debug)]
struct Absent {
    float: Plane,
    uint: Plane,
    /// Two of each format, for bindings of even and of odd numbers: WebGPU refuses passes that write one texture by two
    /// bindings.
    stored: [[Plane; 2]; STORED.len()],
    counters: Buffer,
}

impl Absent {
    fn new(device: &Device) -> Self {
        let plane = |format| PlaneDesc::new("afterimage absent input", format, [1, 1], 1).create(device);
        let counters = device.create_buffer(&BufferDescriptor {
            label: Some("afterimage absent counters"),
            size: FrameStats::COUNTERS_BYTES,
            usage: BufferUsages::STORAGE,
            mapped_at_creation: false,
        });
        let (float, uint) = (plane(TextureFormat::R32Float), plane(TextureFormat::R32Uint));
        Self { float, uint, stored: STORED.map(|format| [plane(format), plane(format)]), counters }
    }

    fn of(&self, number: u32, ty: BindingType) -> Resource {
        match ty {
            BindingType::StorageTexture { format, .. } => {
                let i = STORED.iter().position(|&stored| stored == format).unwrap_or(0);
                (&self.stored[i][number as usize % 2].whole).into()
            }
            BindingType::Texture { sample_type: TextureSampleType::Uint, .. } => (&self.uint.whole).into(),
            BindingType::Texture { .. } => (&self.float.whole).into(),
            _ => (&self.counters).into(),
        }
    }
}

impl Recorder {
    pub fn new(device: &Device, desc: &ContextDesc) -> Self {
        let dispatches = DISPATCHES_PER_VIEW * desc.view_count as usize;
        let uniforms = device.create_buffer(&BufferDescriptor {
            label: Some("afterimage uniforms"),
            size: (DISPATCHES + STRIDE * dispatches) as u64,
            usage: BufferUsages::UNIFORM | BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        Self { groups: Groups::default(), uniforms, absent: Absent::new(device), bytes: vec![], dispatches: vec![] }
    }

    pub fn clear(&mut self) {
        self.groups.clear();
    }

    /// Begins a frame with this number.
    pub fn begin(&mut self, number: u32) {
        self.groups.begin_frame();
        self.dispatches.clear();
        self.bytes.clear();
        self.bytes.extend_from_slice(&number.to_ne_bytes());
        self.bytes.resize(DISPATCHES, 0);
    }

    /// Adds the budget of a plan to the upload.
    pub fn budget(&mut self, words: [u32; 4]) {
        let at = BUDGET as usize;
        self.bytes[at..at + size_of_val(&words)].copy_from_slice(bytemuck::bytes_of(&words));
    }

    /// Offset of uniforms of a dispatch.
    fn place(&mut self, uniforms: &FrameUniforms) -> u32 {
        let new = bytemuck::bytes_of(uniforms);
        let taken = (DISPATCHES..self.bytes.len()).step_by(STRIDE);
        let at = taken.clone().find(|&at| self.bytes[at..at + new.len()] == *new).unwrap_or_else(|| {
            let at = self.bytes.len();
            self.bytes.extend_from_slice(new);
            self.bytes.resize(at + STRIDE, 0);
            at
        });
        debug_assert!(at as u64 + STRIDE as u64 <= self.uniforms.size());
        at as u32
    }

    /// Adds a dispatch of `workgroups`. `uniforms`: those of the frame, if the pass reads them; `resource`: what to
    /// bind by a number, if there is anything.
    pub fn add(
        &mut self,
        device: &Device,
        (shader, pipeline): (&ComputeShader, ComputePipeline),
        uniforms: Option<&FrameUniforms>,
        resource: impl Fn(u32) -> Option<Resource>,
        workgroups: impl Into<Workgroups>,
    ) {
        let uniforms = uniforms.map(|uniforms| self.place(uniforms));
        let bytes = |bytes: usize| Some(Resource::Buffer(self.uniforms.clone(), 0, NonZeroU64::new(bytes as u64)));
        let bound = |&(number, ty): &(u32, BindingType)| {
            let given = match number {
                _ if number == Binding::Uniforms as u32 && uniforms.is_some() => bytes(size_of::<FrameUniforms>()),
                _ => resource(number),
            };
            given.unwrap_or_else(|| self.absent.of(number, ty))
        };
        let resources = shader.bindings().iter().map(bound).collect();
        let group = self.groups.get(device, shader, resources);
        self.dispatches.push(Dispatch { pipeline, group, uniforms, workgroups: workgroups.into() });
    }

    /// The values of the uniforms on the device; an error if wgpu knows that the device is lost.
    pub fn upload(&self, device: &Device) -> Result<Buffer, FrameError> {
        let usage = BufferUsages::MAP_WRITE | BufferUsages::COPY_SRC;
        let (buffer, is_alive) = filled_if_alive(device, "afterimage uniforms", &self.bytes, usage);
        if is_alive { Ok(buffer) } else { Err(FrameError::DeviceLost) }
    }

    /// Records the copy of an [`upload`](Self::upload), before the dispatches.
    pub fn copy(&self, encoder: &mut CommandEncoder, upload: &Buffer) {
        encoder.copy_buffer_to_buffer(upload, 0, &self.uniforms, 0, self.bytes.len() as u64);
    }

    pub fn record(&self, pass: &mut ComputePass<'_>) {
        let mut last = None;
        for dispatch in &self.dispatches {
            if last != Some(&dispatch.pipeline) {
                pass.set_pipeline(&dispatch.pipeline);
            }
            last = Some(&dispatch.pipeline);
            pass.set_bind_group(0, &dispatch.group, dispatch.uniforms.as_slice());
            match &dispatch.workgroups {
                &Workgroups::Direct([x, y, z]) => pass.dispatch_workgroups(x, y, z),
                Workgroups::Indirect(buffer, offset) => pass.dispatch_workgroups_indirect(buffer, *offset),
            }
        }
    }
}
