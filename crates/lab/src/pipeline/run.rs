//! Runs of a pipeline: what is run, and what comes out.

#[cfg(feature = "ablation")]
use super::ablation;
use crate::clock::Elapsed;
use afterimage::{FrameStats, Image, Settings, SettingsError};

/// Kind of a run: how it processes the foveated frames.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RunKind {
    /// The post-process with these settings. The pipeline's foveation replaces theirs.
    PostProcess(Settings),
    /// The post-process without a part of its pass, on a device only: measures the part's cost and benefit.
    #[cfg(feature = "ablation")]
    Without(Settings, &'static ablation::Part),
    /// Every pixel at its finest level of detail so far: the upper bound of temporal reuse. Defined for stills only.
    Oracle,
}

/// A run's output for one frame.
#[derive(Clone, Debug)]
pub struct MethodOutput {
    /// Displayed frame, linear.
    pub image: Image<[f32; 3]>,
    /// Wall time of the pass in milliseconds.
    pub wall_ms: f64,
    /// CPU time of the process during the pass in milliseconds; `None` if the system does not measure it.
    pub cpu_ms: Option<f64>,
    /// Time of the pass by timestamp queries, in milliseconds; `None` on software devices and the CPU.
    pub device_ms: Option<f64>,
    /// Counters of the pass; all 0 for the oracle.
    pub stats: FrameStats,
    /// Bytes per pixel that the pass reads and writes; `None` for the oracle.
    pub traffic_bytes_per_pixel: Option<u32>,
    /// Debug views, linear, in the order of the request; empty for the oracle.
    pub debug: Vec<Image<[f32; 3]>>,
}

impl MethodOutput {
    /// Time of the pass.
    pub fn elapsed(&self) -> Elapsed {
        Elapsed { wall_ms: self.wall_ms, cpu_ms: self.cpu_ms, device_ms: self.device_ms }
    }
}

impl RunKind {
    /// Settings of a method; `None` for the oracle.
    pub(super) fn settings(&self) -> Option<&Settings> {
        match self {
            Self::PostProcess(settings) => Some(settings),
            #[cfg(feature = "ablation")]
            Self::Without(settings, _) => Some(settings),
            Self::Oracle => None,
        }
    }

    /// Parts are removed from shaders.
    pub(super) fn check_on_cpu(&self) -> Result<(), SettingsError> {
        match self {
            #[cfg(feature = "ablation")]
            Self::Without(..) => {
                let expected = "a device: parts are removed from shaders".into();
                Err(SettingsError { setting: "backend", found: "the CPU".into(), expected })
            }
            _ => Ok(()),
        }
    }
}
