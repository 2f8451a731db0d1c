//! Methods: name, history layout and passes of each.
//!
//! To add one, write a variant of [`Method`] and of [`MethodKind`], its arms and a file with its [`Entry`] here, its
//! passes in `cpu/levels/` and in `shaders/levels/`, and tests.

#![cfg_attr(not(all(feature = "cpu", feature = "gpu")), allow(dead_code, reason = "each executor reads its part"))]

mod none;
pub(crate) mod planned;
mod smr;
mod taa;
mod taau;
mod wrs;

pub(crate) use smr::smr_params;
#[cfg(feature = "cpu")]
pub(crate) use wrs::has_references;
pub(crate) use wrs::{inv_density_at_fovea, wrs_params};

use crate::foveation::FoveationKind;
use crate::settings::{Method, MethodKind, Settings, Smr, Wrs};

impl MethodKind {
    /// All methods.
    pub const ALL: [Self; 5] = [Self::None, Self::Taa, Self::Wrs, Self::Smr, Self::Taau];

    /// Short name in lower case, such as `smr`.
    pub fn name(self) -> &'static str {
        self.entry().name
    }

    /// Description in one line.
    pub fn summary(self) -> &'static str {
        self.entry().summary
    }

    /// Method of a short name; `None` for unknown names.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|method| method.name() == name)
    }

    fn entry(self) -> &'static Entry {
        match self {
            Self::None => &none::ENTRY,
            Self::Taa => &taa::ENTRY,
            Self::Smr => &smr::ENTRY,
            Self::Wrs => &wrs::ENTRY,
            Self::Taau => &taau::ENTRY,
        }
    }
}

impl Method {
    /// The method without its settings.
    pub fn kind(&self) -> MethodKind {
        match self {
            Self::None => MethodKind::None,
            Self::Taa => MethodKind::Taa,
            Self::Taau => MethodKind::Taau,
            Self::Smr(_) => MethodKind::Smr,
            Self::Wrs(_) => MethodKind::Wrs,
        }
    }

    /// Short name in lower case, such as `smr`.
    pub fn name(&self) -> &'static str {
        self.kind().name()
    }

    /// Settings of smr; of another method, the defaults, which its passes do not read.
    pub(crate) fn smr(&self) -> Smr {
        if let Self::Smr(smr) = *self { smr } else { Smr::default() }
    }

    /// Settings of wrs; of another method, the defaults, which its passes do not read.
    pub(crate) fn wrs(&self) -> Wrs {
        if let Self::Wrs(wrs) = *self { wrs } else { Wrs::default() }
    }
}

/// A method with its default settings.
impl From<MethodKind> for Method {
    fn from(kind: MethodKind) -> Self {
        match kind {
            MethodKind::None => Self::None,
            MethodKind::Taa => Self::Taa,
            MethodKind::Taau => Self::Taau,
            MethodKind::Smr => Self::Smr(Smr::default()),
            MethodKind::Wrs => Self::Wrs(Wrs::default()),
        }
    }
}

/// Algorithm that processes a frame. Each has an entry in the table of methods, and its own passes on either executor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Algorithm {
    None,
    Taa,
    Taau,
    Smr,
    Reconstruction,
    Wrs,
}

/// A step of a frame: some passes of an executor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Stage {
    /// Fills a mip chain of noisy candidates.
    Candidates,
    /// Fills the colors of a planned frame between its samples, for an algorithm that reads whole frames.
    Fill,
    /// Compares the samples of shaded quads with history.
    Quads,
    /// The pass that writes the output and the history.
    Method,
    /// Fills the mip chain of the written history.
    MipChain,
}

/// Stages of an algorithm that reads whole frames and keeps no mip chain.
fn whole_frames(settings: &Settings) -> Vec<Stage> {
    match settings.foveation.kind {
        FoveationKind::Quads => vec![Stage::Fill, Stage::Method],
        _ => vec![Stage::Method],
    }
}

/// Entry in the table of methods.
#[derive(Debug)]
pub(crate) struct Entry {
    pub name: &'static str,
    pub summary: &'static str,
    pub algorithm: Algorithm,
    /// Stages of a frame, in their order.
    pub stages: fn(&Settings) -> Vec<Stage>,
    /// Layout of its history.
    pub history: fn(&Settings) -> HistoryLayout,
    /// Memory traffic of history and noise, in bytes a pixel.
    pub history_traffic_bytes: fn(&Settings) -> u32,
    pub shader: fn(&Settings) -> PassShader,
    /// Values of the shaders' own overrides, in addition to those of `shaders/shared/inputs.wgsl`.
    pub overrides: fn(&Settings) -> Overrides,
}

/// Shader of a method's pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct PassShader {
    /// Name of a module of `shaders/planned/` or `shaders/levels/`.
    pub name: &'static str,
    /// Edge in pixels of the block that an invocation processes.
    pub block_px: u32,
}

/// Names and values of a shader's overrides.
pub(crate) type Overrides = Vec<(&'static str, u32)>;

/// Layout of history.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum HistoryLayout {
    /// No history.
    Nothing,
    /// Packed reservoirs ([`stored_reservoir`](crate::kernel::stored_reservoir)), and keys for A-ES.
    Reservoirs {
        /// Whether there are keys.
        keys: bool,
        /// Whether there are references of the gate ([`pack_reference`](crate::kernel::wrs::pack_reference)).
        references: bool,
    },
    /// Packed samples that keep their places ([`stored_sample`](crate::kernel::stored_sample)).
    Sparse {
        /// Whether there is packed noise ([`noise`](crate::kernel::noise)).
        noisy: bool,
        /// Whether they are means of samples ([`antialias`](crate::kernel::antialias)).
        means: bool,
    },
    /// Packed surfaces ([`surface`](crate::kernel::surface)), and their mip chain.
    Surfaces {
        /// Number of mip levels above the full-rate one.
        levels: u32,
        /// Whether there are packed noise ([`noise`](crate::kernel::noise)) and a mip chain of the candidates.
        noisy: bool,
    },
}

impl Settings {
    /// The entry of these settings. On planned frames, smr stands for their reconstruction.
    fn entry(&self) -> &'static Entry {
        match self.method {
            Method::Smr(_) if self.foveation.kind == FoveationKind::Quads => &planned::ENTRY,
            method => method.kind().entry(),
        }
    }

    pub(crate) fn algorithm(&self) -> Algorithm {
        self.entry().algorithm
    }

    /// Stages of a frame, in their order.
    pub(crate) fn stages(&self) -> Vec<Stage> {
        (self.entry().stages)(self)
    }

    pub(crate) fn pass_shader(&self) -> PassShader {
        (self.entry().shader)(self)
    }

    /// Values of the method's own overrides.
    pub(crate) fn overrides(&self) -> Overrides {
        (self.entry().overrides)(self)
    }

    /// Whether history of other settings is history of these.
    pub(crate) fn keeps_history_of(&self, other: &Self) -> bool {
        self.history_layout() == other.history_layout() && self.pass_shader() == other.pass_shader()
    }

    /// Whether planned frames of these settings differ from those of `other` at most in rates, regions and budget.
    #[cfg(feature = "gpu")]
    pub(crate) fn differs_in_uniforms(&self, other: &Self) -> bool {
        let is_planned = |settings: &Self| settings.foveation.kind == FoveationKind::Quads;
        is_planned(self) && is_planned(other) && Self { foveation: other.foveation, ..*self } == *other
    }

    pub(crate) fn history_layout(&self) -> HistoryLayout {
        (self.entry().history)(self)
    }

    /// Memory traffic of a frame in bytes a pixel, read and written. `given`: whether the frame has depth, motion and
    /// trust inputs. Assumes common formats: color and output as halves (8 bytes each), motion as halves (4), depth
    /// (4), trust (1). Taps that neighbouring pixels share are counted once. History of alpha is not counted
    /// ([`ContextDesc::keep_alpha`](crate::internal::ContextDesc::keep_alpha)).
    pub fn traffic_bytes_per_pixel(&self, given: [bool; 3]) -> u32 {
        // The filling stage reads the samples (8 bytes), and writes colors as floats (16), which the pass reads (16).
        let (color, output) = (if self.stages().contains(&Stage::Fill) { 8 + 16 + 16 } else { 8 }, 8);
        if self.method == Method::None {
            return color + output;
        }
        let inputs: u32 = given.iter().zip([4, 4, 1]).map(|(&given, bytes)| if given { bytes } else { 0 }).sum();
        color + inputs + (self.entry().history_traffic_bytes)(self) + output
    }
}
