//! Time of a pass: timestamp queries of the device, or CPU time of the process.

use super::{Backend, DeviceClock, Headless};
use crate::clock::{Elapsed, Stopwatch};
use afterimage::gpu::Timestamps;
use std::sync::Arc;
use wgpu::CommandEncoder;

/// Clock that times one pass, or one span of passes, at a time.
#[derive(Debug)]
pub struct PassClock(Option<DeviceClock>);

impl PassClock {
    /// Timestamp queries on hardware devices that have them, otherwise CPU time of the process.
    pub fn new(gpu: &Headless) -> Self {
        Self(if gpu.is_software() { None } else { DeviceClock::new(gpu, 1) })
    }

    /// Whether times come from timestamp queries.
    pub fn is_device(&self) -> bool {
        self.0.is_some()
    }

    /// Description of the clock, for reports.
    pub fn name(&self) -> &'static str {
        match &self.0 {
            Some(_) => "the device's, by timestamp queries",
            None => "CPU time of the process, recording and waiting included",
        }
    }

    /// Timestamp queries for the timed pass; `None` for CPU time.
    pub fn timestamps(&self) -> Option<Timestamps<'_>> {
        self.0.as_ref().map(|clock| clock.timestamps(0))
    }

    /// Records the begin of a span of passes, for work without [`timestamps`](Self::timestamps) of its own.
    pub fn begin(&self, encoder: &mut CommandEncoder) {
        if let Some(clock) = &self.0 {
            clock.mark(encoder, 0, false);
        }
    }

    /// Records the end of the span, and resolves its queries. The encoder may differ from that of
    /// [`begin`](Self::begin).
    pub fn end(&self, encoder: &mut CommandEncoder) {
        if let Some(clock) = &self.0 {
            clock.mark(encoder, 0, true);
        }
        self.resolve(encoder);
    }

    /// Waits for submitted work, and returns the time since `watch` was started and the time of the span on the device.
    /// The device must be idle when the watch is started; otherwise the times include earlier work.
    pub fn elapsed(&self, gpu: &Headless, watch: &Stopwatch) -> Elapsed {
        gpu.wait();
        let elapsed = watch.elapsed();
        Elapsed { device_ms: self.is_device().then(|| self.read_ms(gpu, watch)), ..elapsed }
    }

    /// Resolves the timestamp queries. Record it after the pass.
    pub fn resolve(&self, encoder: &mut CommandEncoder) {
        if let Some(clock) = &self.0 {
            clock.resolve(encoder, 0..1);
        }
    }

    /// Time of the completed pass in milliseconds; without timestamp queries, the CPU time since `watch` was started.
    pub fn read_ms(&self, gpu: &Headless, watch: &Stopwatch) -> f64 {
        match &self.0 {
            Some(clock) => clock.wait_ms(gpu).first().copied().unwrap_or_default(),
            None => watch.cpu_ms().unwrap_or_else(|| watch.wall_ms()),
        }
    }
}

/// Clock of work that submits to a device by itself, or runs on the CPU.
#[derive(Debug)]
pub struct SpanClock(Option<(Arc<Headless>, PassClock)>);

impl SpanClock {
    /// A clock for work on `backend`.
    pub fn new(backend: &Backend) -> Self {
        Self(match backend {
            Backend::Cpu => None,
            Backend::Gpu(gpu) => Some((gpu.clone(), PassClock::new(gpu))),
        })
    }

    /// Runs `work`, waits for the work that it submitted, and returns its result and the time. The device's time lasts
    /// from the first submission to the last, and includes waiting for the host between them.
    pub fn time<T>(&self, work: impl FnOnce() -> T) -> (T, Elapsed) {
        let Some((gpu, clock)) = &self.0 else {
            let watch = Stopwatch::start();
            return (work(), watch.elapsed());
        };
        let submit = |record: &dyn Fn(&mut CommandEncoder)| {
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            record(&mut encoder);
            gpu.queue.submit([encoder.finish()]);
        };
        gpu.wait();
        let watch = Stopwatch::start();
        submit(&|encoder| clock.begin(encoder));
        let result = work();
        submit(&|encoder| clock.end(encoder));
        (result, clock.elapsed(gpu, &watch))
    }
}
