//! Runs of a pipeline: kinds and outputs.

use crate::clock::Elapsed;
use afterimage::internal::Note;
use afterimage::internal::{FoveationKind, Settings};
use afterimage::{FrameError, FrameStats, FrameValue, Image, SettingsError};
use std::sync::Arc;

/// Kind of a run: how it processes the foveated frames.
#[derive(Clone, Debug, PartialEq)]
pub enum RunKind {
    /// The post-process with these settings. The pipeline's foveation replaces theirs.
    PostProcess(Settings),
    /// The same, of frames with the albedo of every pixel.
    WithAlbedo(Settings),
    /// The post-process on a device with this WGSL in place of the method's pass, for measurements of changed passes.
    WithShader(Settings, Arc<str>),
    /// Every pixel at its finest level of detail so far: the upper bound of temporal reuse. Defined for stills only.
    Oracle,
}

/// A run's output for one frame.
#[derive(Clone, Debug)]
pub struct MethodOutput {
    /// Displayed frame, linear.
    pub image: Image<[f32; 3]>,
    /// Time of the pass, and of choosing pixels.
    pub elapsed: Elapsed,
    /// Pixels that the method chose and got; `None` if it chooses none, or the source cannot shade any.
    pub chosen: Option<Chosen>,
    /// Counters of the pass; all 0 for the oracle.
    pub stats: FrameStats,
    /// Bytes per pixel that the pass reads and writes; `None` for the oracle.
    pub traffic_bytes_per_pixel: Option<u32>,
    /// Debug views, linear, in the order of the request; empty for the oracle.
    pub debug: Vec<Image<[f32; 3]>>,
    /// Notes about the pixel to explain; empty without one, on a device and for the oracle.
    pub notes: Vec<Note>,
}

/// Whether runs of these settings choose all pixels that are shaded: frames of [`FoveationKind::Quads`].
pub fn chooses(settings: &Settings) -> bool {
    settings.foveation.kind == FoveationKind::Quads
}

/// Error for a frame whose source shades no chosen pixels.
pub fn unshaded() -> FrameError {
    let found = "none: the source shades no chosen pixels".into();
    FrameError::Value { value: FrameValue::Color, view: 0, found, expected: "a source that shades quads" }
}

/// Pixels of a frame that a method chose before it was shaded: all that were shaded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chosen {
    /// Share of the pixels.
    pub share: f64,
    /// Time of shading the pixels; `None` if they came from a simulator's full-rate frame.
    pub shading: Option<Elapsed>,
}

impl RunKind {
    /// Settings of a method; `None` for the oracle.
    pub(super) fn settings(&self) -> Option<&Settings> {
        match self {
            Self::PostProcess(settings) | Self::WithAlbedo(settings) | Self::WithShader(settings, _) => Some(settings),
            Self::Oracle => None,
        }
    }

    /// Whether the method gets the albedo of every pixel.
    pub fn has_albedo(&self) -> bool {
        matches!(self, Self::WithAlbedo(_))
    }

    /// A shader runs on a device only.
    pub(super) fn check_on_cpu(&self) -> Result<(), SettingsError> {
        match self {
            Self::WithShader(..) => {
                let expected = "a device, which runs the shader".into();
                Err(SettingsError { setting: "backend", found: "the CPU".into(), expected })
            }
            Self::PostProcess(_) | Self::WithAlbedo(_) | Self::Oracle => Ok(()),
        }
    }
}
