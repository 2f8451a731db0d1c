//! What computed.

use afterimage_lab::device::Backend;
use serde::Serialize;

/// What computed, as reports say it.
#[derive(Serialize)]
pub struct BackendReport {
    /// `cpu` or `gpu`.
    pub kind: &'static str,
    /// The adapter, or how many threads.
    pub name: String,
    /// Its driver and version, or `none`.
    pub driver: String,
}

impl BackendReport {
    /// Of this backend.
    pub fn of(backend: &Backend) -> Self {
        match backend {
            Backend::Cpu => {
                Self { kind: "cpu", name: format!("{} threads", rayon::current_num_threads()), driver: "none".into() }
            }
            #[cfg(feature = "full")]
            Backend::Gpu(gpu) => Self {
                kind: "gpu",
                name: gpu.info.name.clone(),
                driver: format!("{} {}", gpu.info.driver, gpu.info.driver_info),
            },
        }
    }
}
