//! Backend in reports.

use afterimage_lab::device::Backend;
use serde::Serialize;

/// The device that ran the methods.
#[derive(Serialize)]
pub struct BackendReport {
    /// `cpu` or `gpu`.
    pub kind: &'static str,
    /// Name of the adapter, or number of threads.
    pub name: String,
    /// Driver and version; `none` on the CPU.
    pub driver: String,
}

impl BackendReport {
    /// Describes a backend.
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
