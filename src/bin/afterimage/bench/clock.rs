//! What times a pass: the device's clock by timestamp queries, or the CPU time of the process.

use afterimage::gpu::Timestamps;
use afterimage::pipeline::Headless;
use afterimage::report::clock::Stopwatch;

/// The device's clock, or the process's.
pub enum Clock {
    Device { queries: wgpu::QuerySet, resolved: wgpu::Buffer, readback: wgpu::Buffer, period_ns: f64 },
    Process,
}

impl Clock {
    pub fn new(gpu: &Headless) -> Self {
        if gpu.is_software() || !gpu.device.features().contains(wgpu::Features::TIMESTAMP_QUERY) {
            return Self::Process;
        }
        let buffer = |usage| {
            gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("timestamps"),
                size: 16,
                usage,
                mapped_at_creation: false,
            })
        };
        Self::Device {
            queries: gpu.device.create_query_set(&wgpu::QuerySetDescriptor {
                label: Some("timestamps"),
                ty: wgpu::QueryType::Timestamp,
                count: 2,
            }),
            resolved: buffer(wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC),
            readback: buffer(wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ),
            period_ns: f64::from(gpu.queue.get_timestamp_period()),
        }
    }

    pub fn name(&self) -> &'static str {
        match self {
            Self::Device { .. } => "the device's, by timestamp queries",
            Self::Process => "CPU time of the process, recording and waiting included",
        }
    }

    pub fn timestamps(&self) -> Option<Timestamps<'_>> {
        match self {
            Self::Device { queries, .. } => Some(Timestamps { queries, begin: 0, end: 1 }),
            Self::Process => None,
        }
    }

    pub fn resolve(&self, encoder: &mut wgpu::CommandEncoder) {
        if let Self::Device { queries, resolved, readback, .. } = self {
            encoder.resolve_query_set(queries, 0..2, resolved, 0);
            encoder.copy_buffer_to_buffer(resolved, 0, readback, 0, 16);
        }
    }

    pub fn read_ms(&self, gpu: &Headless, watch: &Stopwatch) -> f64 {
        let Self::Device { readback, period_ns, .. } = self else {
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
