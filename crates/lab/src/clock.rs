//! Wall and CPU time of a piece of work.

use std::time::Instant;

/// Started before the work, read after it.
pub struct Stopwatch {
    wall: Instant,
    cpu_ms: Option<f64>,
}

impl Stopwatch {
    /// Starts now.
    pub fn start() -> Self {
        Self { wall: Instant::now(), cpu_ms: process_cpu_ms() }
    }

    /// Milliseconds that have passed.
    pub fn wall_ms(&self) -> f64 {
        self.wall.elapsed().as_secs_f64() * 1e3
    }

    /// Milliseconds that the process's threads have worked, all together; `None` where the system does not tell.
    pub fn cpu_ms(&self) -> Option<f64> {
        Some(process_cpu_ms()? - self.cpu_ms?)
    }
}

#[cfg(unix)]
fn process_cpu_ms() -> Option<f64> {
    let t = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
    Some(t.tv_sec as f64 * 1e3 + t.tv_nsec as f64 * 1e-6)
}

#[cfg(not(unix))]
fn process_cpu_ms() -> Option<f64> {
    None
}

/// Median and quartiles of a sample; `None` of an empty one.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Quartiles {
    /// Half lie below.
    pub median: f64,
    /// A quarter lies below.
    pub p25: f64,
    /// Three quarters lie below.
    pub p75: f64,
}

impl Quartiles {
    /// Of `values`, in any order, interpolated between neighbours.
    pub fn of(values: &[f64]) -> Option<Self> {
        let mut sorted = values.to_vec();
        sorted.sort_by(f64::total_cmp);
        let at = |q: f64| {
            let position = q * (sorted.len() - 1) as f64;
            let (low, high) = (sorted[position.floor() as usize], sorted[position.ceil() as usize]);
            low + (high - low) * position.fract()
        };
        (!sorted.is_empty()).then(|| Self { median: at(0.5), p25: at(0.25), p75: at(0.75) })
    }
}
