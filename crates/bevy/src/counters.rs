//! What is counted of a camera: the component, and the buffer on the device.

use afterimage::{FrameStats, Verdict, wgpu};
use bevy::prelude::*;
use std::ops::Range;
use std::sync::Arc;
use std::sync::atomic::{AtomicU8, Ordering};

/// Counts what a camera with [`Afterimage`](crate::Afterimage) shaded, and its pixels by what became of their history,
/// a few frames ago. Add it to the camera; without it nothing is counted, at no cost.
///
/// With it the log says, once, if foveation does not pay because the device waits for most of each frame.
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
    /// Pixels that are shaded: four a quad, even where one of them is shown, as in the first frame and after a cut.
    pub shaded: u64,
    /// Time that the device works on a frame of all cameras, in microseconds. 0 if it has no timestamps.
    pub device_us: u64,
    /// Time from the last frame of the application to this one, in microseconds.
    pub frame_us: u64,
}

impl AfterimageStats {
    /// Of what the device has counted.
    fn new(stats: &FrameStats, quads: u32, device_us: u64) -> Self {
        Self {
            pixels: stats.pixels,
            kept: stats.valid().saturating_sub(stats.replaced),
            replaced: stats.replaced,
            disoccluded: stats.verdicts[Verdict::Disoccluded as usize],
            rejected: stats.rejected(),
            nonfinite: stats.nonfinite,
            shaded: 4 * u64::from(quads),
            device_us,
            frame_us: 0,
        }
    }
}

/// Place of the number of quads in their list, and its size.
const QUADS: Range<u64> = 28..32;

/// Bytes of the timestamps at the start and at the end of a frame.
const STAMPS_BYTES: u64 = 16;

/// Counters of a camera, and a copy of them that is on its way back: with the number of quads, and timestamps.
#[derive(Debug)]
pub(crate) struct Counters {
    pub buffer: wgpu::Buffer,
    stamps: Option<(wgpu::QuerySet, wgpu::Buffer)>,
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
        let usage = wgpu::BufferUsages::COPY_SRC;
        let stamps = device.features().contains(wgpu::Features::TIMESTAMP_QUERY).then(|| {
            let label = Some("afterimage timestamps");
            let queries = wgpu::QuerySetDescriptor { label, ty: wgpu::QueryType::Timestamp, count: 2 };
            (device.create_query_set(&queries), buffer(wgpu::BufferUsages::QUERY_RESOLVE | usage, STAMPS_BYTES))
        });
        let copied_bytes = FrameStats::COUNTERS_BYTES + (QUADS.end - QUADS.start) + STAMPS_BYTES;
        Self {
            buffer: buffer(wgpu::BufferUsages::STORAGE | usage, FrameStats::COUNTERS_BYTES),
            stamps,
            copy: buffer(wgpu::BufferUsages::MAP_READ, copied_bytes),
            state: Arc::default(),
        }
    }

    /// Before what the device does in a frame (0), or after it (1).
    pub fn stamp(&mut self, encoder: &mut wgpu::CommandEncoder, index: u32) {
        let Some((query_set, resolved)) = &self.stamps else { return };
        // Of a pass without work, because not all devices write timestamps between passes.
        drop(encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some("afterimage timestamp"),
            timestamp_writes: Some(wgpu::ComputePassTimestampWrites {
                query_set,
                beginning_of_pass_write_index: Some(index),
                end_of_pass_write_index: None,
            }),
        }));
        if index == 1 && self.state.load(Ordering::Acquire) == RECORDED {
            encoder.resolve_query_set(query_set, 0..2, resolved, 0);
            let at = self.copy.size() - STAMPS_BYTES;
            encoder.copy_buffer_to_buffer(resolved, 0, &self.copy, at, STAMPS_BYTES);
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

    /// After submission: requests the copy, or returns it if it has arrived. A unit of timestamps is `tick_ns` long.
    pub fn poll(&mut self, tick_ns: f32) -> Option<AfterimageStats> {
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
                let (rest, end) = bytes.split_last_chunk()?;
                let (rest, start) = rest.split_last_chunk()?;
                let ticks = u64::from_le_bytes(*end).saturating_sub(u64::from_le_bytes(*start));
                let device_us = (1e-3 * f64::from(tick_ns) * ticks as f64) as u64;
                let quads = u32::from_le_bytes(*rest.last_chunk()?);
                let counts =
                    FrameStats::from_counters(rest).map(|stats| AfterimageStats::new(&stats, quads, device_us));
                drop(bytes);
                self.copy.unmap();
                self.state.store(FREE, Ordering::Release);
                counts
            }
            _ => None,
        }
    }
}
