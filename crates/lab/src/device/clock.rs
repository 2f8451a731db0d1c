//! What times a pass: the device's clock by timestamp queries, or the CPU time of the process.

use super::Headless;
use crate::clock::Stopwatch;
use afterimage::gpu::Timestamps;

/// The device's clock, or the process's.
#[derive(Debug)]
pub struct PassClock(Kind);

#[derive(Debug)]
enum Kind {
    Device { queries: wgpu::QuerySet, resolved: wgpu::Buffer, readback: wgpu::Buffer, period_ns: f64 },
    Process,
}

impl PassClock {
    /// Timestamps where the device is real and has them.
    pub fn new(gpu: &Headless) -> Self {
        if gpu.is_software() || !gpu.device.features().contains(wgpu::Features::TIMESTAMP_QUERY) {
            return Self(Kind::Process);
        }
        let buffer = |usage| {
            gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("timestamps"),
                size: 16,
                usage,
                mapped_at_creation: false,
            })
        };
        Self(Kind::Device {
            queries: gpu.device.create_query_set(&wgpu::QuerySetDescriptor {
                label: Some("timestamps"),
                ty: wgpu::QueryType::Timestamp,
                count: 2,
            }),
            resolved: buffer(wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC),
            readback: buffer(wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ),
            period_ns: f64::from(gpu.queue.get_timestamp_period()),
        })
    }

    /// Whether times are the device's own.
    pub fn is_device(&self) -> bool {
        matches!(self.0, Kind::Device { .. })
    }

    /// What its times are, in words.
    pub fn name(&self) -> &'static str {
        match &self.0 {
            Kind::Device { .. } => "the device's, by timestamp queries",
            Kind::Process => "CPU time of the process, recording and waiting included",
        }
    }

    /// For the frame whose pass is timed.
    pub fn timestamps(&self) -> Option<Timestamps<'_>> {
        match &self.0 {
            Kind::Device { queries, .. } => Some(Timestamps { queries, begin: 0, end: 1 }),
            Kind::Process => None,
        }
    }

    /// To be recorded after the pass.
    pub fn resolve(&self, encoder: &mut wgpu::CommandEncoder) {
        if let Kind::Device { queries, resolved, readback, .. } = &self.0 {
            encoder.resolve_query_set(queries, 0..2, resolved, 0);
            encoder.copy_buffer_to_buffer(resolved, 0, readback, 0, 16);
        }
    }

    /// Milliseconds of a pass that is done: since `watch` was started, where the device does not tell.
    pub fn read_ms(&self, gpu: &Headless, watch: &Stopwatch) -> f64 {
        let Kind::Device { readback, period_ns, .. } = &self.0 else {
            return watch.cpu_ms().unwrap_or_else(|| watch.wall_ms());
        };
        readback.map_async(wgpu::MapMode::Read, .., |_| ());
        gpu.wait();
        let ticks = {
            let mapped = readback.slice(..).get_mapped_range().expect("the readback was mapped and waited for");
            let at = |i: usize| u64::from_le_bytes(mapped[i * 8..(i + 1) * 8].try_into().expect("eight bytes"));
            at(1).saturating_sub(at(0))
        };
        readback.unmap();
        ticks as f64 * period_ns * 1e-6
    }
}
