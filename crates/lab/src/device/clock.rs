//! Time of a pass: by the device's clock, or the CPU time of the process.

use super::{DeviceClock, Headless};
use crate::clock::Stopwatch;
use afterimage::gpu::Timestamps;
use wgpu::CommandEncoder;

/// Clock of one pass at a time.
#[derive(Debug)]
pub struct PassClock(Option<DeviceClock>);

impl PassClock {
    /// The device's clock where the device is no software and has one, else the process's.
    pub fn new(gpu: &Headless) -> Self {
        Self(if gpu.is_software() { None } else { DeviceClock::new(gpu, 1) })
    }

    /// Whether times are the device's own.
    pub fn is_device(&self) -> bool {
        self.0.is_some()
    }

    /// Description of its times, for reports.
    pub fn name(&self) -> &'static str {
        match &self.0 {
            Some(_) => "the device's, by timestamp queries",
            None => "CPU time of the process, recording and waiting included",
        }
    }

    /// Timestamps for the pass that is timed.
    pub fn timestamps(&self) -> Option<Timestamps<'_>> {
        self.0.as_ref().map(|clock| clock.timestamps(0))
    }

    /// To be recorded after the pass.
    pub fn resolve(&self, encoder: &mut CommandEncoder) {
        if let Some(clock) = &self.0 {
            clock.resolve(encoder, 0..1);
        }
    }

    /// Milliseconds of a pass that is done, or, without a device's clock, since `watch` was started.
    pub fn read_ms(&self, gpu: &Headless, watch: &Stopwatch) -> f64 {
        match &self.0 {
            Some(clock) => clock.wait_ms(gpu).first().copied().unwrap_or_default(),
            None => watch.cpu_ms().unwrap_or_else(|| watch.wall_ms()),
        }
    }
}
