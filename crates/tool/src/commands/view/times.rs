//! Time of each pass: timestamp queries where the device supports them, else wall time of submitting one pass and
//! waiting for it.

use afterimage::gpu::Timestamps;
use afterimage::wgpu::{self, CommandEncoder};
use afterimage_lab::device::{DeviceClock, Headless};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

/// Passes that are timed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pass {
    /// Rendering of a scene.
    Render,
    Foveation,
    Left,
    Right,
    Screen,
}

impl Pass {
    /// All passes, in the order of a frame.
    pub const ALL: [Self; 5] = [Self::Render, Self::Foveation, Self::Left, Self::Right, Self::Screen];
}

/// Times of the passes.
pub struct PassTimes {
    /// Milliseconds of each pass, of the last frame whose times have been read back.
    ms: [Option<f64>; Pass::ALL.len()],
    clock: Option<Clock>,
}

struct Clock {
    device: DeviceClock,
    /// Passes timed in this frame; `None` while an earlier frame's timestamps are in flight.
    written: Option<Vec<Pass>>,
    /// Passes whose timestamps are being read back, and whether the readback has finished.
    in_flight: Option<(Vec<Pass>, Arc<AtomicBool>)>,
}

impl PassTimes {
    pub fn new(gpu: &Headless) -> Self {
        let device = if gpu.is_software() { None } else { DeviceClock::new(gpu, Pass::ALL.len() as u32) };
        Self {
            ms: [None; Pass::ALL.len()],
            clock: device.map(|device| Clock { device, written: None, in_flight: None }),
        }
    }

    /// Milliseconds of a pass, of the last frame whose times have been read back; `None` if that frame did not run the
    /// pass.
    pub fn ms(&self, pass: Pass) -> Option<f64> {
        self.ms[pass as usize]
    }

    /// Starts a frame: takes times that have been read back.
    pub fn begin(&mut self, gpu: &Headless) {
        let Some(clock) = &mut self.clock else {
            self.ms = [None; Pass::ALL.len()];
            return;
        };
        // `Viewer::frame` handles a lost device.
        let _ = gpu.device.poll(wgpu::PollType::Poll);
        if clock.in_flight.as_ref().is_some_and(|(_, done)| done.load(Ordering::Acquire))
            && let Some((passes, _)) = clock.in_flight.take()
        {
            let ms = clock.device.take_ms();
            self.ms = [None; Pass::ALL.len()];
            for pass in passes {
                self.ms[pass as usize] = ms.get(pass as usize).copied();
            }
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
            Some(clock.device.timestamps(pass as u32))
        });
        record(&mut encoder, stamps)?;
        gpu.queue.submit([encoder.finish()]);
        if self.clock.is_none() {
            gpu.wait();
            self.ms[pass as usize] = Some(begun.elapsed().as_secs_f64() * 1e3);
        }
        Ok(())
    }

    /// Records, submits and times passes that take no timestamps of their own: empty passes before and after take them.
    pub fn span<E>(
        &mut self,
        gpu: &Headless,
        pass: Pass,
        record: impl FnOnce(&mut CommandEncoder) -> Result<(), E>,
    ) -> Result<(), E> {
        self.pass(gpu, pass, |encoder, timestamps| {
            let mark = |encoder: &mut CommandEncoder, is_end: bool| {
                let Some(Timestamps { queries, begin, end }) = timestamps else { return };
                let timestamp_writes = Some(wgpu::ComputePassTimestampWrites {
                    query_set: queries,
                    beginning_of_pass_write_index: (!is_end).then_some(begin),
                    end_of_pass_write_index: is_end.then_some(end),
                });
                encoder.begin_compute_pass(&wgpu::ComputePassDescriptor { label: Some("time"), timestamp_writes });
            };
            mark(encoder, false);
            record(encoder)?;
            mark(encoder, true);
            Ok(())
        })
    }

    /// Ends a frame: starts to read its timestamps back.
    pub fn end(&mut self, gpu: &Headless) {
        let Some(clock) = &mut self.clock else { return };
        let Some(written) = clock.written.take().filter(|w| !w.is_empty()) else { return };
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        for &pass in &written {
            clock.device.resolve(&mut encoder, pass as u32..pass as u32 + 1);
        }
        gpu.queue.submit([encoder.finish()]);
        let done = clock.device.start_reading();
        clock.in_flight = Some((written, done));
    }
}
