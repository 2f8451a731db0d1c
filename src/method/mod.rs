//! The methods: what each is called, keeps between frames, reads, and runs on either executor.
//!
//! To add one: a variant of [`Method`], a file here with its [`Entry`], its pass in `cpu/` and in `shaders/pass/`, its tests.

mod none;
mod smr;
mod taa;
mod wrs;

pub(crate) use smr::smr_params;
pub(crate) use wrs::{inv_density_at_fovea, wrs_params};

use crate::settings::{Method, Settings};

impl Method {
    /// All methods.
    pub const ALL: [Self; 4] = [Self::None, Self::Taa, Self::Wrs, Self::Smr];

    /// Short name, in lower case: `smr`.
    pub fn name(self) -> &'static str {
        self.entry().name
    }

    /// One line that says what it does.
    pub fn summary(self) -> &'static str {
        self.entry().summary
    }

    /// The method of a short name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|method| method.name() == name)
    }

    pub(crate) fn entry(self) -> &'static Entry {
        match self {
            Self::None => &none::ENTRY,
            Self::Taa => &taa::ENTRY,
            Self::Smr => &smr::ENTRY,
            Self::Wrs => &wrs::ENTRY,
        }
    }
}

/// A row of the table of methods.
#[derive(Debug)]
pub(crate) struct Entry {
    pub name: &'static str,
    pub summary: &'static str,
    /// What it keeps between frames.
    pub history: fn(&Settings) -> HistoryLayout,
    /// Bytes of history and noise that its pass reads and writes a pixel.
    pub history_traffic_bytes: fn(&Settings) -> u32,
    /// Shader of its pass: a module of `shaders/pass/`.
    #[cfg(feature = "gpu")]
    pub shader: &'static str,
    /// Side of the square of pixels that an invocation of the shader takes.
    #[cfg(feature = "gpu")]
    pub block_px: u32,
    /// Values of the shader's own overrides, besides those of `shaders/pass/inputs.wgsl`; `true` if the frame brings levels of detail.
    #[cfg(feature = "gpu")]
    pub overrides: fn(&Settings, bool) -> Overrides,
}

/// Names and values of a shader's overrides.
#[cfg(feature = "gpu")]
pub(crate) type Overrides = Vec<(&'static str, u32)>;

/// What is kept between frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum HistoryLayout {
    /// Nothing.
    Nothing,
    /// Packed reservoirs ([`pack`](crate::kernel::pack)), and keys for A-ES.
    Reservoirs {
        /// Whether there are keys.
        keys: bool,
    },
    /// Packed surfaces ([`surface`](crate::kernel::surface)), and a mip chain of them.
    Surfaces {
        /// Mip levels beyond the full-rate one.
        levels: u32,
        /// Whether there is noise ([`noise`](crate::kernel::noise)), and a mip chain of the candidates.
        noisy: bool,
    },
}

impl Settings {
    /// What the method keeps between frames.
    pub(crate) fn history_layout(&self) -> HistoryLayout {
        (self.method.entry().history)(self)
    }

    /// Bytes that the pass reads and writes a pixel, for which of depth, motion and trust are given, stored as engines store them:
    /// color and output as halves (8 each), motion as halves (4), depth (4), trust (1). The depth test's extra taps are not counted:
    /// they are neighbours', and few.
    pub fn traffic_bytes_per_pixel(&self, given: [bool; 3]) -> u32 {
        let (color, output) = (8, 8);
        if self.method == Method::None {
            return color + output;
        }
        let inputs: u32 = given.iter().zip([4, 4, 1]).map(|(&given, bytes)| if given { bytes } else { 0 }).sum();
        color + inputs + (self.method.entry().history_traffic_bytes)(self) + output
    }
}
