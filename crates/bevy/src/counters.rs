//! What is counted of a camera: the component, and the buffer on the device.

use afterimage::{FrameStats, Verdict, wgpu};
use bevy::prelude::*;
use std::ops::Range;
use std::sync::Arc;
use std::sync::atomic::{AtomicU8, Ordering};

/// Counts what a camera with [`Afterimage`](crate::Afterimage) shaded, and its pixels by what became of their history,
/// a few frames ago. Add it to the camera; without it nothing is counted, at no cost.
///
/// The shares are also Bevy diagnostics, `afterimage/kept` and `afterimage/disoccluded`, in percent. The times of the
/// post-process are the diagnostics `render/afterimage_plan/elapsed_gpu` and `render/afterimage/elapsed_gpu` (and
/// `elapsed_cpu`), if the application has Bevy's `RenderDiagnosticsPlugin`.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Component, Default)]
pub struct AfterimageStats {
    /// All pixels. 0 before the first counts arrive.
    pub pixels: u64,
    /// Pixels whose history is valid and was kept.
    pub kept: u64,
    /// Pixels whose history is valid and was replaced.
    pub replaced: u64,
    /// Pixels where another surface came into sight.
    pub disoccluded: u64,
    /// Pixels whose history was rejected, disoccluded ones among them.
    pub rejected: u64,
    /// Pixels whose color was NaN or infinite.
    pub nonfinite: u64,
    /// Pixels that are shaded: four a quad.
    pub shaded: u64,
}

impl AfterimageStats {
    /// Copies the device's counts.
    pub(crate) fn count(&mut self, (stats, quads): Counts) {
        self.pixels = stats.pixels;
        self.kept = stats.valid().saturating_sub(stats.replaced);
        self.replaced = stats.replaced;
        self.disoccluded = stats.verdicts[Verdict::Disoccluded as usize];
        self.rejected = stats.rejected();
        self.nonfinite = stats.nonfinite;
        self.shaded = 4 * quads;
    }
}

/// Counts of a frame, and the number of its quads.
pub(crate) type Counts = (FrameStats, u64);

/// Place of that number in the list of quads, and its size.
const QUADS: Range<u64> = 28..32;

/// Counters of a camera, and a copy of them that is on its way back.
#[derive(Debug)]
pub(crate) struct Counters {
    pub buffer: wgpu::Buffer,
    copy: wgpu::Buffer,
    state: Arc<AtomicU8>,
}

/// States of the copy.
const FREE: u8 = 0;
/// Recorded in this frame.
const RECORDED: u8 = 1;
/// Requested from the device.
const REQUESTED: u8 = 2;
const MAPPED: u8 = 3;

impl Counters {
    pub fn new(device: &wgpu::Device) -> Self {
        let buffer = |usage, size| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("afterimage counters"),
                size,
                usage: usage | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            })
        };
        Self {
            buffer: buffer(wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC, FrameStats::COUNTERS_BYTES),
            copy: buffer(wgpu::BufferUsages::MAP_READ, FrameStats::COUNTERS_BYTES + (QUADS.end - QUADS.start)),
            state: Arc::default(),
        }
    }

    /// Copies the counts of this frame, unless those of an earlier one are still on their way.
    pub fn record(&mut self, encoder: &mut wgpu::CommandEncoder, quads: &wgpu::Buffer) {
        if self.state.load(Ordering::Acquire) == FREE {
            let bytes = FrameStats::COUNTERS_BYTES;
            encoder.copy_buffer_to_buffer(&self.buffer, 0, &self.copy, 0, bytes);
            encoder.copy_buffer_to_buffer(quads, QUADS.start, &self.copy, bytes, QUADS.end - QUADS.start);
            self.state.store(RECORDED, Ordering::Release);
        }
    }

    /// After submission: requests the copy, or returns it if it has arrived.
    pub fn poll(&mut self) -> Option<Counts> {
        match self.state.load(Ordering::Acquire) {
            RECORDED => {
                self.state.store(REQUESTED, Ordering::Release);
                let state = self.state.clone();
                self.copy.map_async(wgpu::MapMode::Read, .., move |result| {
                    state.store(if result.is_ok() { MAPPED } else { FREE }, Ordering::Release);
                });
                None
            }
            MAPPED => {
                let bytes = self.copy.get_mapped_range(..).ok()?;
                let quads = bytes.last_chunk().map_or(0, |bytes| u32::from_le_bytes(*bytes));
                let counts = FrameStats::from_counters(&bytes).map(|stats| (stats, quads.into()));
                drop(bytes);
                self.copy.unmap();
                self.state.store(FREE, Ordering::Release);
                counts
            }
            _ => None,
        }
    }
}
