//! Backends: the CPU, or a device without a window.

#[cfg(feature = "full")]
mod bandwidth;
#[cfg(feature = "full")]
mod clock;
#[cfg(feature = "full")]
mod headless;
#[cfg(feature = "full")]
mod mapped;
#[cfg(feature = "full")]
mod timestamps;

#[cfg(feature = "full")]
pub use bandwidth::copy_ms_per_byte;
#[cfg(feature = "full")]
pub use clock::{PassClock, SpanClock};
#[cfg(feature = "full")]
pub use headless::Headless;
#[cfg(feature = "full")]
pub use mapped::mapped;
#[cfg(feature = "full")]
pub(crate) use mapped::wait_mapped;
#[cfg(feature = "full")]
pub use timestamps::DeviceClock;

#[cfg(feature = "full")]
use std::sync::Arc;

/// Executor of the post-process.
#[derive(Clone, Debug, Default)]
pub enum Backend {
    /// The CPU executor.
    #[default]
    Cpu,
    /// The wgpu executor on this device. Frames are uploaded and read back; reported times exclude these transfers.
    #[cfg(feature = "full")]
    Gpu(Arc<Headless>),
}

#[cfg(feature = "full")]
impl Backend {
    /// The device, if it is one.
    pub fn device(&self) -> Option<&Arc<Headless>> {
        match self {
            Self::Cpu => None,
            Self::Gpu(device) => Some(device),
        }
    }
}
