//! Backends: the CPU, or a device without a window.

mod bandwidth;
mod clock;
mod headless;
mod make;
mod mapped;
mod timestamps;

pub use bandwidth::copy_ms_per_byte;
pub use clock::{PassClock, SpanClock};
pub use headless::Headless;
pub use make::{bind_group, empty_buffer, texture_desc};
pub use mapped::mapped;
pub(crate) use mapped::wait_mapped;
pub use timestamps::DeviceClock;

use std::sync::Arc;

/// Message if the machine has no adapter.
pub const NO_ADAPTER: &str = "there is no adapter, or none that AFTERIMAGE_ADAPTER names; install a Vulkan driver \
    (software: mesa-vulkan-drivers)";

/// Executor of the post-process.
#[derive(Clone, Debug, Default)]
pub enum Backend {
    /// The CPU executor.
    #[default]
    Cpu,
    /// The wgpu executor on this device. Frames are uploaded and read back; reported times exclude these transfers.
    Gpu(Arc<Headless>),
}

impl Backend {
    /// The device; `None` for the CPU.
    pub fn device(&self) -> Option<&Arc<Headless>> {
        match self {
            Self::Cpu => None,
            Self::Gpu(device) => Some(device),
        }
    }

    /// Whether the backend is a hardware GPU, whose work does not show in CPU time.
    pub fn is_real_gpu(&self) -> bool {
        self.device().is_some_and(|device| !device.is_software())
    }
}
