//! `--backend`: CPU or GPU.

use crate::failure::Failure;
use afterimage_lab::device::{Backend, Headless, NO_ADAPTER};
use afterimage_lab::source::is_scene;
use clap::ValueEnum;

/// Values of `--backend`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum BackendName {
    /// A GPU if there is one, else the CPU
    Auto,
    /// The CPU
    Cpu,
    /// Any adapter, including software ones
    Gpu,
}

impl BackendName {
    /// Name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Cpu => "cpu",
            Self::Gpu => "gpu",
        }
    }

    /// Opens the backend.
    pub fn open(self) -> Result<Backend, Failure> {
        let found = match self {
            Self::Cpu => None,
            Self::Auto => Headless::find(false),
            Self::Gpu => Some(Headless::find(true).ok_or_else(no_adapter)?),
        };
        Ok(found.map_or(Backend::Cpu, Backend::Gpu))
    }

    /// Opens the backend for an input: with room for a scene, if it is one.
    pub fn open_for(self, input: &str) -> Result<Backend, Failure> {
        if is_scene(input) { self.open_for_scenes() } else { self.open() }
    }

    /// Opens the backend with the adapter's own limits on textures and buffers, since scenes exceed wgpu's defaults.
    pub fn open_for_scenes(self) -> Result<Backend, Failure> {
        Ok(match self.open()? {
            Backend::Gpu(device) => Backend::Gpu(Headless::find_roomy(device.is_software()).unwrap_or(device)),
            Backend::Cpu => Backend::Cpu,
        })
    }
}

/// Values of `--backend` where several backends are timed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Traces {
    /// The CPU, and an adapter if there is one: a GPU, else software
    Auto,
    /// The CPU
    Cpu,
    /// An adapter: a GPU, else software
    Gpu,
}

impl Traces {
    /// Opens the backends to time, with room for scenes: the CPU, an adapter, or both.
    pub fn open(self) -> Result<Vec<Backend>, Failure> {
        let gpu = if self == Self::Cpu { None } else { Headless::find_roomy(true) };
        if gpu.is_none() && self == Self::Gpu {
            return Err(no_adapter());
        }
        Ok((self != Self::Gpu).then_some(Backend::Cpu).into_iter().chain(gpu.map(Backend::Gpu)).collect())
    }
}

fn no_adapter() -> Failure {
    Failure::Input(format!("--backend gpu: {NO_ADAPTER}, or use --backend cpu"))
}
