//! Time of each pass: timestamp queries where the device supports them, else wall time of submitting one pass and waiting for it.

use afterimage::gpu::Timestamps;
use afterimage_lab::device::Headless;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;
use wgpu::{Buffer, BufferUsages, CommandEncoder, QuerySet};

/// Passes that are timed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pass {
    Foveation,
    Left,
    Right,
    Screen,
}

impl Pass {
    /// All passes, in the order of a frame.
    pub const ALL: [Self; 4] = [Self::Foveation, Self::Left, Self::Right, Self::Screen];
}

/// Size of the query buffers: two 64-bit timestamps per pass.
const BYTES: u64 = 16 * Pass::ALL.len() as u64;

/// Times of the passes.
pub struct PassTimes {
    /// Milliseconds of each pass, of the last frame whose times have been read back.
    ms: [Option<f64>; Pass::ALL.len()],
    clock: Option<Clock>,
}

struct Clock {
    queries: QuerySet,
    resolved: Buffer,
    readback: Buffer,
    period_ms: f64,
    /// Passes timed in this frame; `None` while an earlier frame's timestamps are in flight.
    written: Option<Vec<Pass>>,
    /// Passes whose timestamps are being read back, and whether the readback has finished.
    in_flight: Option<(Vec<Pass>, Arc<AtomicBool>)>,
}

impl PassTimes {
    pub fn new(gpu: &Headless) -> Self {
        let has_clock = !gpu.is_software() && gpu.device.features().contains(wgpu::Features::TIMESTAMP_QUERY);
        let buffer = |usage| {
            let label = Some("pass times");
            gpu.device.create_buffer(&wgpu::BufferDescriptor { label, size: BYTES, usage, mapped_at_creation: false })
        };
        let clock = has_clock.then(|| Clock {
            queries: gpu.device.create_query_set(&wgpu::QuerySetDescriptor {
                label: Some("pass times"),
                ty: wgpu::QueryType::Timestamp,
                count: 2 * Pass::ALL.len() as u32,
            }),
            resolved: buffer(BufferUsages::QUERY_RESOLVE | BufferUsages::COPY_SRC),
            readback: buffer(BufferUsages::COPY_DST | BufferUsages::MAP_READ),
            period_ms: f64::from(gpu.queue.get_timestamp_period()) * 1e-6,
            written: None,
            in_flight: None,
        });
        Self { ms: [None; 4], clock }
    }

    /// Milliseconds of a pass, of the last frame whose times have been read back; `None` if that frame did not run the pass.
    pub fn ms(&self, pass: Pass) -> Option<f64> {
        self.ms[pass as usize]
    }

    /// Starts a frame: takes times that have been read back.
    pub fn begin(&mut self, gpu: &Headless) {
        let Some(clock) = &mut self.clock else {
            self.ms = [None; 4];
            return;
        };
        // `Viewer::frame` handles a lost device.
        let _ = gpu.device.poll(wgpu::PollType::Poll);
        if clock.in_flight.as_ref().is_some_and(|(_, done)| done.load(Ordering::Acquire))
            && let Some((passes, _)) = clock.in_flight.take()
        {
            if let Ok(mapped) = clock.readback.slice(..).get_mapped_range() {
                let ticks: Vec<u64> = mapped.chunks_exact(8).map(bytemuck::pod_read_unaligned).collect();
                self.ms = [None; 4];
                for pass in passes {
                    let at = 2 * pass as usize;
                    self.ms[pass as usize] = Some(ticks[at + 1].saturating_sub(ticks[at]) as f64 * clock.period_ms);
                }
            }
            clock.readback.unmap();
        }
        clock.written = clock.in_flight.is_none().then(Vec::new);
    }

    /// Records, submits and times a pass.
    pub fn pass<E>(
        &mut self,
        gpu: &Headless,
        pass: Pass,
        record: impl FnOnce(&mut CommandEncoder, Option<Timestamps<'_>>) -> Result<(), E>,
    ) -> Result<(), E> {
        let begun = Instant::now();
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let stamps = self.clock.as_mut().and_then(|clock| {
            clock.written.as_mut()?.push(pass);
            let begin = 2 * pass as u32;
            Some(Timestamps { queries: &clock.queries, begin, end: begin + 1 })
        });
        record(&mut encoder, stamps)?;
        gpu.queue.submit([encoder.finish()]);
        if self.clock.is_none() {
            gpu.wait();
            self.ms[pass as usize] = Some(begun.elapsed().as_secs_f64() * 1e3);
        }
        Ok(())
    }

    /// Ends a frame: starts to read its timestamps back.
    pub fn end(&mut self, gpu: &Headless) {
        let Some(clock) = &mut self.clock else { return };
        let Some(written) = clock.written.take().filter(|w| !w.is_empty()) else { return };
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        for &pass in &written {
            let first = 2 * pass as u32;
            encoder.resolve_query_set(&clock.queries, first..first + 2, &clock.resolved, 0);
            encoder.copy_buffer_to_buffer(&clock.resolved, 0, &clock.readback, 8 * u64::from(first), 16);
        }
        gpu.queue.submit([encoder.finish()]);
        let done = Arc::new(AtomicBool::new(false));
        let mapped = done.clone();
        clock
            .readback
            .map_async(wgpu::MapMode::Read, .., move |result| mapped.store(result.is_ok(), Ordering::Release));
        clock.in_flight = Some((written, done));
    }
}
