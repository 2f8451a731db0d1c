//! Memory bandwidth of the backend: a lower bound for the time of a pass that moves a given number of bytes.

use super::Backend;
use crate::clock::{Quartiles, Stopwatch};
use rayon::prelude::*;
use wgpu::BufferUsages;

/// Bytes that a copy reads; it writes as many. More than the last-level cache of most machines holds.
const BYTES: usize = 1 << 26;
/// Copies whose median time is taken.
const COPIES: usize = 7;

/// Milliseconds per byte that a copy reads or writes. CPU time of the process on CPUs and software devices, as in
/// [`Elapsed::cost_ms`](crate::clock::Elapsed::cost_ms); wall time on hardware GPUs, where a copy of 64
/// MiB takes much longer than its submission.
pub fn copy_ms_per_byte(backend: &Backend) -> f64 {
    let mut times = vec![];
    match backend {
        Backend::Cpu => {
            let from = vec![1_u64; BYTES / 8];
            let mut to = vec![0_u64; BYTES / 8];
            for _ in 0..=COPIES {
                let watch = Stopwatch::start();
                to.par_chunks_mut(1 << 16)
                    .zip(from.par_chunks(1 << 16))
                    .for_each(|(to, from)| to.copy_from_slice(from));
                times.push(watch.cpu_ms().unwrap_or_else(|| watch.wall_ms()));
                std::hint::black_box(&to);
            }
        }
        Backend::Gpu(gpu) => {
            let buffer = || gpu.buffer(BYTES as u64, BufferUsages::COPY_SRC | BufferUsages::COPY_DST);
            let (from, to) = (buffer(), buffer());
            for _ in 0..=COPIES {
                let watch = Stopwatch::start();
                let mut encoder = gpu.device.create_command_encoder(&Default::default());
                encoder.copy_buffer_to_buffer(&from, 0, &to, 0, BYTES as u64);
                gpu.queue.submit([encoder.finish()]);
                gpu.wait();
                let cpu_ms = watch.cpu_ms().filter(|_| gpu.is_software());
                times.push(cpu_ms.unwrap_or_else(|| watch.wall_ms()));
            }
        }
    }
    // The first copy is a warm-up: it also pays for page faults.
    Quartiles::of(&times[1..]).map_or(0.0, |q| q.median) / (2 * BYTES) as f64
}
