//! Wall and CPU time measurement, and quartiles of a sample.

use std::time::Instant;

/// A timer of wall and CPU time since [`Stopwatch::start`].
pub struct Stopwatch {
    wall: Instant,
    cpu_ms: Option<f64>,
}

impl Stopwatch {
    /// A timer that starts now.
    pub fn start() -> Self {
        Self { wall: Instant::now(), cpu_ms: process_cpu_ms() }
    }

    /// Elapsed wall time in milliseconds.
    pub fn wall_ms(&self) -> f64 {
        self.wall.elapsed().as_secs_f64() * 1e3
    }

    /// CPU time in milliseconds, summed over all threads of the process; `None` where the system does not provide it.
    pub fn cpu_ms(&self) -> Option<f64> {
        Some(process_cpu_ms()? - self.cpu_ms?)
    }

    /// Wall and CPU time, for work on the CPU.
    pub fn elapsed(&self) -> Elapsed {
        Elapsed { wall_ms: self.wall_ms(), cpu_ms: self.cpu_ms(), device_ms: None }
    }
}

/// Time of a piece of work, by every available clock.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Elapsed {
    /// Wall time in milliseconds.
    pub wall_ms: f64,
    /// CPU time of the process in milliseconds; `None` if the system does not measure it.
    pub cpu_ms: Option<f64>,
    /// Time on the device by timestamp queries, in milliseconds; `None` on software devices and the CPU.
    pub device_ms: Option<f64>,
}

impl Elapsed {
    /// Time of this and of `other` work, by the clocks that measured both.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        let sum = |a: Option<f64>, b: Option<f64>| Some(a? + b?);
        Self {
            wall_ms: self.wall_ms + other.wall_ms,
            cpu_ms: sum(self.cpu_ms, other.cpu_ms),
            device_ms: sum(self.device_ms, other.device_ms),
        }
    }

    /// Cost of the work in milliseconds: timestamp queries if available, otherwise CPU time, which other processes
    /// disturb less than wall time.
    pub fn cost_ms(&self) -> f64 {
        self.device_ms.or(self.cpu_ms).unwrap_or(self.wall_ms)
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

/// Median and quartiles of a sample.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Quartiles {
    /// Median.
    pub median: f64,
    /// First quartile.
    pub p25: f64,
    /// Third quartile.
    pub p75: f64,
}

impl Quartiles {
    /// Quartiles of `values` in any order, linearly interpolated between neighbours; `None` for an empty slice.
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
