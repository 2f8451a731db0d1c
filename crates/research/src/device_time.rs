//! Time that a device takes for recorded work.

use crate::error::AnyError;
use afterimage::FrameError;
use afterimage::wgpu::CommandEncoder;
use afterimage_lab::clock::Stopwatch;
use afterimage_lab::device::Headless;

/// Milliseconds until the device has done what `record` records: CPU time on a software device, else wall time.
pub fn timed_ms(
    gpu: &Headless,
    record: impl FnOnce(&mut CommandEncoder) -> Result<(), FrameError>,
) -> Result<f64, AnyError> {
    let watch = Stopwatch::start();
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    record(&mut encoder)?;
    gpu.queue.submit([encoder.finish()]);
    gpu.wait();
    Ok(watch.cpu_ms().filter(|_| gpu.is_software()).unwrap_or_else(|| watch.wall_ms()))
}
