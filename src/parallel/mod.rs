//! Loops over rows and pixels, on all cores and with the widest vector instructions of the processor. On WebAssembly
//! one core computes the same results.

#[cfg(not(target_family = "wasm"))]
mod all_cores;
#[cfg(target_family = "wasm")]
mod one_core;

#[cfg(not(target_family = "wasm"))]
pub(crate) use all_cores::{collect, for_rows, process_rows};
#[cfg(target_family = "wasm")]
pub(crate) use one_core::{collect, for_rows, process_rows};

use crate::stats::FrameStats;

/// A pass over the rows of an image.
pub(crate) trait ProcessRow<R>: Sync {
    /// Processes row `y`. Implementations are inlined, so that they are compiled for each instruction set.
    fn process(&self, y: u32, row: &mut R) -> FrameStats;
}
