//! The pipeline on a device. A frame is uploaded or rendered once; foveation and all methods then run on the device.
//! `run`, `view` and `bench` share this code.

mod executor;
mod inputs;
mod run;

pub(super) use executor::DeviceExecutor;
pub use inputs::DeviceInputs;
pub use run::DeviceRun;

use wgpu::{TextureFormat, TextureUsages};

/// Formats of a pipeline's textures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DeviceFormats {
    /// Format of the full-rate frame, the foveated frame and outputs: `Rgba32Float` or `Rgba16Float`.
    pub color: TextureFormat,
    /// Format of motion vectors: `Rg32Float` or `Rg16Float`.
    pub motion: TextureFormat,
}

impl DeviceFormats {
    /// 32-bit floats: exactly the values of frames in memory.
    pub const EXACT: Self = Self { color: TextureFormat::Rgba32Float, motion: TextureFormat::Rg32Float };
    /// 16-bit floats, as engines use.
    pub const ENGINE: Self = Self { color: TextureFormat::Rgba16Float, motion: TextureFormat::Rg16Float };
}

const WRITTEN: TextureUsages =
    TextureUsages::TEXTURE_BINDING.union(TextureUsages::STORAGE_BINDING).union(TextureUsages::COPY_SRC);
