//! Memory of this process, for tests that run alone in it, since other tests would change it.

/// Resident memory of this process in MiB, if the system reports it.
pub fn resident_mib() -> Option<f64> {
    let pages: f64 = std::fs::read_to_string("/proc/self/statm").ok()?.split(' ').nth(1)?.parse().ok()?;
    Some(pages * 4096.0 / f64::from(1 << 20))
}

/// Smallest growth from one reading to the next. A leak grows in every interval, a late allocation of the driver only
/// once.
pub fn least_growth_mib(resident: &[f64]) -> f64 {
    resident.windows(2).map(|w| w[1] - w[0]).fold(f64::INFINITY, f64::min)
}
