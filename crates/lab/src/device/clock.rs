//! Time of a pass: timestamp queries of the device, or CPU time of the process.

use super::{DeviceClock, Headless};
use crate::clock::Stopwatch;
use afterimage::gpu::Timestamps;
use wgpu::CommandEncoder;

/// Clock that times one pass at a time.
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
